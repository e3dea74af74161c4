#include "harness/gl/handle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <stdexcept>

#include "base/error.h"

namespace shadowbench::gl {

GLuint create_object(GLenum kind, std::string_view label, GLenum target) {
  GLuint id = 0;
  switch (kind) {
    case GL_BUFFER: glCreateBuffers(1, &id); break;
    case GL_FRAMEBUFFER: glCreateFramebuffers(1, &id); break;
    case GL_PROGRAM: id = glCreateProgram(); break;
    case GL_QUERY: glCreateQueries(target, 1, &id); break;
    case GL_SAMPLER: glCreateSamplers(1, &id); break;
    case GL_SHADER: id = glCreateShader(target); break;
    case GL_TEXTURE: glCreateTextures(target, 1, &id); break;
    case GL_VERTEX_ARRAY: glCreateVertexArrays(1, &id); break;
    default: assert(false);
  }
  GLint limit = 256;
  glGetIntegerv(GL_MAX_LABEL_LENGTH, &limit);
  glObjectLabel(kind, id, std::min(static_cast<GLsizei>(label.size()), limit - 1), label.data());
  return id;
}

void delete_object(GLenum kind, GLuint id) {
  switch (kind) {
    case GL_BUFFER: return glDeleteBuffers(1, &id);
    case GL_FRAMEBUFFER: return glDeleteFramebuffers(1, &id);
    case GL_PROGRAM: return glDeleteProgram(id);
    case GL_QUERY: return glDeleteQueries(1, &id);
    case GL_SAMPLER: return glDeleteSamplers(1, &id);
    case GL_SHADER: return glDeleteShader(id);
    case GL_TEXTURE: return glDeleteTextures(1, &id);
    case GL_VERTEX_ARRAY: return glDeleteVertexArrays(1, &id);
    default: assert(false);
  }
}

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
