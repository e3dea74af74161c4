#pragma once

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <string_view>

#include "harness/gl/texture.h"

namespace shadowbench::gl {

/// Owns a set of textures to draw into. Requires: the textures live as long as it is drawn into.
class Framebuffer {
 public:
  static constexpr int kMaxColors = 8;

  explicit Framebuffer(std::string_view label);

  /// Draws fragment output `index` (0 to 7) into `texture`.
  void attach_color(int index, const Texture& texture, int level = 0);
  void attach_depth(const Texture& texture);

  /// Makes it the draw target and sets the viewport to the whole of it.
  /// Throws std::logic_error when it is incomplete, Error(kContext) when this GL cannot draw into such textures.
  void bind();

  /// Clears one colour texture. Requires: colour mask open, scissor test off.
  void clear_color(int index, const glm::vec4& color);
  /// Clears the depth texture. Requires: depth mask open, scissor test off.
  void clear_depth(float depth);

  int width() const { return width_; }
  int height() const { return height_; }
  GLuint id() const { return handle_.id(); }

 private:
  void adopt_size(int width, int height);
  void require_complete();

  Handle<GL_FRAMEBUFFER> handle_;
  std::string label_;
  std::array<GLenum, kMaxColors> draw_buffers_{};
  int width_ = 0;
  int height_ = 0;
  bool complete_ = false;
};

}  // namespace shadowbench::gl
