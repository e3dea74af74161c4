#include "harness/gl/gl_error.h"

#include <fmt/format.h>

#include <stdexcept>

#include "filters/base/error.h"

namespace shadowbench::gl {

std::string gl_error_name(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM: return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE: return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION: return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION: return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY: return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST: return "GL_CONTEXT_LOST";
    default: return fmt::format("GL error 0x{:04x}", error);
  }
}

std::vector<GLenum> drain_gl_errors() {
  constexpr int kMost = 64;  // a lost context reports an error for ever
  std::vector<GLenum> errors;
  for (int i = 0; i < kMost; ++i) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) break;
    errors.push_back(error);
  }
  return errors;
}

void require_allocated(std::string_view what) {
  const auto errors = drain_gl_errors();
  for (const GLenum error : errors)
    if (error == GL_OUT_OF_MEMORY)
      throw Error(ErrorKind::kInput, fmt::format("{}: the GL has not enough memory; choose smaller sizes", what));
  if (!errors.empty())
    throw std::logic_error(fmt::format("{}: {} in making it, or before", what, gl_error_name(errors.front())));
}

}  // namespace shadowbench::gl
