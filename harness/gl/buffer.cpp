#include "harness/gl/buffer.h"

#include <fmt/format.h>

#include <stdexcept>

#include "harness/gl/gl_error.h"

namespace shadowbench::gl {
namespace {

GLuint create_buffer(std::string_view label, std::size_t size, const void* data) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  set_label(GL_BUFFER, id, label);
  // GL has no empty buffers: an empty one holds one byte that nobody reads.
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(size == 0 ? 1 : size), size == 0 ? nullptr : data,
                       GL_DYNAMIC_STORAGE_BIT);
  return id;
}

}  // namespace

Buffer::Buffer(std::string_view label, std::span<const std::byte> bytes)
    : handle_(create_buffer(label, bytes.size(), bytes.data())), size_(bytes.size()) {
  require_allocated(fmt::format("buffer '{}' of {} bytes", label, size_));
}

Buffer::Buffer(std::string_view label, std::size_t size) : handle_(create_buffer(label, size, nullptr)), size_(size) {
  require_allocated(fmt::format("buffer '{}' of {} bytes", label, size_));
  glClearNamedBufferData(id(), GL_R8, GL_RED, GL_UNSIGNED_BYTE, nullptr);
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
