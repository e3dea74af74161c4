#include "harness/gl/vertex_array.h"

namespace shadowbench::gl {

VertexArray::VertexArray(std::string_view label) : handle_(label) {}

void VertexArray::set_vertices(const Buffer& buffer, int stride) {
  glVertexArrayVertexBuffer(id(), 0, buffer.id(), 0, stride);
}

void VertexArray::set_attribute(GLuint location, int components, std::size_t offset) {
  glEnableVertexArrayAttrib(id(), location);
  glVertexArrayAttribFormat(id(), location, components, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(id(), location, 0);
}

void VertexArray::set_indices(const Buffer& buffer) { glVertexArrayElementBuffer(id(), buffer.id()); }

void VertexArray::bind() const { glBindVertexArray(id()); }

}  // namespace shadowbench::gl
