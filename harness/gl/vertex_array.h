#pragma once

#include <cstddef>
#include <string_view>

#include "harness/gl/buffer.h"

namespace shadowbench::gl {

/// Owns a vertex layout: where the attributes of one interleaved vertex buffer lie, and the indices.
/// Requires: the buffers live as long as the array is drawn.
class VertexArray {
 public:
  explicit VertexArray(std::string_view label);

  /// Takes vertices from `buffer`, `stride` bytes apart.
  void set_vertices(const Buffer& buffer, int stride);

  /// Feeds attribute `location` with `components` floats found `offset` bytes into each vertex.
  void set_attribute(GLuint location, int components, std::size_t offset);

  /// Takes indices from `buffer`.
  void set_indices(const Buffer& buffer);

  /// Binds the array for the next draw.
  void bind() const;

  GLuint id() const { return handle_.id(); }

 private:
  Handle<GL_VERTEX_ARRAY> handle_;
};

}  // namespace shadowbench::gl
