#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "harness/gl/handle.h"

namespace shadowbench::gl {

/// Owns a buffer of fixed size in GL memory.
class Buffer {
 public:
  /// Makes a buffer that holds a copy of `bytes`, e.g. `std::as_bytes(std::span(vertices))`.
  /// Throws Error(kContext) when memory runs out.
  Buffer(std::string_view label, std::span<const std::byte> bytes);

  /// Makes a buffer of `size` zero bytes.
  Buffer(std::string_view label, std::size_t size);

  /// Overwrites the bytes from `offset` on. Throws std::logic_error when they do not fit.
  void upload(std::span<const std::byte> bytes, std::size_t offset = 0);

  /// Waits for the GL and returns a copy of the contents.
  std::vector<std::byte> read() const;

  /// Binds to an indexed target, e.g. GL_SHADER_STORAGE_BUFFER.
  void bind_base(GLenum target, GLuint index) const;

  std::size_t size() const { return size_; }
  GLuint id() const { return handle_.id(); }

 private:
  void allocate(std::string_view label, const void* data);

  Handle<GL_BUFFER> handle_;
  std::size_t size_ = 0;
};

}  // namespace shadowbench::gl
