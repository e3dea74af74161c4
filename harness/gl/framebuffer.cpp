#include "harness/gl/framebuffer.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "filters/base/error.h"

namespace shadowbench::gl {

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

}  // namespace shadowbench::gl
