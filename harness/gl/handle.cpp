#include "harness/gl/handle.h"

#include <algorithm>

namespace shadowbench::gl {

void set_label(GLenum identifier, GLuint id, std::string_view label) {
  GLint limit = 256;
  glGetIntegerv(GL_MAX_LABEL_LENGTH, &limit);
  const auto length = std::min(static_cast<GLsizei>(label.size()), limit - 1);
  glObjectLabel(identifier, id, length, label.data());
}

}  // namespace shadowbench::gl
