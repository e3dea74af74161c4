#include "harness/gl/handle.h"

#include <algorithm>
#include <cassert>

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

}  // namespace shadowbench::gl
