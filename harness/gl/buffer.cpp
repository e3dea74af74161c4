#include "harness/gl/buffer.h"

#include <fmt/format.h>

#include <stdexcept>

#include "harness/gl/gl_error.h"

namespace shadowbench::gl {

Buffer::Buffer(std::string_view label, std::span<const std::byte> bytes) : handle_(label), size_(bytes.size()) {
  allocate(label, bytes.data());
}

Buffer::Buffer(std::string_view label, std::size_t size) : handle_(label), size_(size) {
  allocate(label, nullptr);
  glClearNamedBufferData(id(), GL_R8, GL_RED, GL_UNSIGNED_BYTE, nullptr);
}

void Buffer::allocate(std::string_view label, const void* data) {
  // GL has no empty buffers: an empty one holds one byte that nobody reads.
  const auto bytes = static_cast<GLsizeiptr>(size_ == 0 ? 1 : size_);
  glNamedBufferStorage(id(), bytes, size_ == 0 ? nullptr : data, GL_DYNAMIC_STORAGE_BIT);
  require_allocated(fmt::format("buffer '{}' of {} bytes", label, size_));
}

void Buffer::upload(std::span<const std::byte> bytes, std::size_t offset) {
  if (offset > size_ || bytes.size() > size_ - offset)
    throw std::logic_error(fmt::format("{} bytes at {} do not fit a buffer of {}", bytes.size(), offset, size_));
  glNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

std::vector<std::byte> Buffer::read() const {
  std::vector<std::byte> bytes(size_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (size_ > 0) glGetNamedBufferSubData(id(), 0, static_cast<GLsizeiptr>(size_), bytes.data());
  return bytes;
}

void Buffer::bind_base(GLenum target, GLuint index) const { glBindBufferBase(target, index, id()); }

}  // namespace shadowbench::gl
