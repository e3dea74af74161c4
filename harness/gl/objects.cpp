#include "harness/gl/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/error.h"
#include "harness/gl/handle.h"

namespace shadowbench::gl {

Buffer::Buffer(std::string_view label, std::span<const std::byte> bytes) : handle_(label), size_(bytes.size()) {
  // GL has no empty buffers: an empty one holds one byte that nobody reads.
  const auto stored = static_cast<GLsizeiptr>(size_ == 0 ? 1 : size_);
  glNamedBufferStorage(id(), stored, size_ == 0 ? nullptr : bytes.data(), 0);
  require_allocated(fmt::format("buffer '{}' of {} bytes", label, size_));
}

Framebuffer::Framebuffer(std::string_view label) : handle_(label), label_(label) {
  draw_buffers_.fill(GL_NONE);
  glNamedFramebufferDrawBuffers(id(), kMaxColors, draw_buffers_.data());
  glNamedFramebufferReadBuffer(id(), GL_NONE);
}

void Framebuffer::attach_color(int index, const Texture& texture, int level) {
  if (index < 0 || index >= kMaxColors) throw std::logic_error(fmt::format("{}: colour {} of 8", label_, index));
  const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index);
  glNamedFramebufferTexture(id(), attachment, texture.id(), level);
  draw_buffers_[static_cast<std::size_t>(index)] = attachment;
  glNamedFramebufferDrawBuffers(id(), kMaxColors, draw_buffers_.data());
  adopt_size(std::max(1, texture.width() >> level), std::max(1, texture.height() >> level));
}

void Framebuffer::attach_depth(const Texture& texture) {
  glNamedFramebufferTexture(id(), GL_DEPTH_ATTACHMENT, texture.id(), 0);
  adopt_size(texture.width(), texture.height());
}

void Framebuffer::bind() {
  if (!complete_) require_complete();
  glBindFramebuffer(GL_FRAMEBUFFER, id());
  glViewport(0, 0, width_, height_);
}

void Framebuffer::clear_color(int index, const glm::vec4& color) {
  glClearNamedFramebufferfv(id(), GL_COLOR, index, &color[0]);
}

void Framebuffer::clear_depth(float depth) { glClearNamedFramebufferfv(id(), GL_DEPTH, 0, &depth); }

// GL draws to the intersection of unequal attachments; every pass here fills whole ones.
void Framebuffer::adopt_size(int width, int height) {
  if (width_ != 0 && (width != width_ || height != height_))
    throw std::logic_error(fmt::format("framebuffer '{}': {}x{} joins {}x{}", label_, width, height, width_, height_));
  width_ = width;
  height_ = height;
  complete_ = false;
}

void Framebuffer::require_complete() {
  const GLenum status = glCheckNamedFramebufferStatus(id(), GL_DRAW_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_UNSUPPORTED)
    throw Error(ErrorKind::kContext, fmt::format("framebuffer '{}': this GL cannot draw into its textures", label_));
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw std::logic_error(fmt::format("framebuffer '{}' is incomplete: 0x{:04x}", label_, status));
  complete_ = true;
}

Query::Query(std::string_view label, GLenum target) : handle_(label, target), target_(target) {}

void Query::begin() { glBeginQuery(target_, handle_.id()); }

void Query::end() { glEndQuery(target_); }

std::uint64_t Query::result() const {
  GLuint64 value = 0;
  glGetQueryObjectui64v(handle_.id(), GL_QUERY_RESULT, &value);
  return value;
}

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

VertexArray::VertexArray(std::string_view label) : handle_(label) {}

void VertexArray::set_vertices(const Buffer& buffer, int stride) {
  glVertexArrayVertexBuffer(id(), 0, buffer.id(), 0, stride);
}

void VertexArray::set_attribute(GLuint location, int components, std::size_t offset) {
  glEnableVertexArrayAttrib(id(), location);
  glVertexArrayAttribFormat(id(), location, components, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(id(), location, 0);
}

void VertexArray::bind() const { glBindVertexArray(id()); }

}  // namespace shadowbench::gl
