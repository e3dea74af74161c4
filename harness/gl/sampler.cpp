#include "harness/gl/sampler.h"

namespace shadowbench::gl {

Sampler::Sampler(std::string_view label) : handle_(label) {
  set_filter(GL_NEAREST, GL_NEAREST);
  set_wrap(GL_CLAMP_TO_EDGE);
}

void Sampler::set_filter(GLenum minify, GLenum magnify) {
  glSamplerParameteri(id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glSamplerParameteri(id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
}

void Sampler::set_wrap(GLenum mode) {
  glSamplerParameteri(id(), GL_TEXTURE_WRAP_S, static_cast<GLint>(mode));
  glSamplerParameteri(id(), GL_TEXTURE_WRAP_T, static_cast<GLint>(mode));
}

void Sampler::set_border(const glm::vec4& color) { glSamplerParameterfv(id(), GL_TEXTURE_BORDER_COLOR, &color[0]); }

void Sampler::set_compare(GLenum function) {
  const bool on = function != GL_NONE;
  glSamplerParameteri(id(), GL_TEXTURE_COMPARE_MODE, on ? GL_COMPARE_REF_TO_TEXTURE : GL_NONE);
  if (on) glSamplerParameteri(id(), GL_TEXTURE_COMPARE_FUNC, static_cast<GLint>(function));
}

void Sampler::bind(GLuint unit) const { glBindSampler(unit, id()); }

void Sampler::unbind(GLuint unit) { glBindSampler(unit, 0); }

}  // namespace shadowbench::gl
