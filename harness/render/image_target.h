#pragma once

#include <string_view>

#include "harness/gl/objects.h"
#include "report/images/image.h"

namespace shadowbench::render {

/// One texture with the framebuffer that draws into it.
class ImageTarget {
 public:
  ImageTarget(std::string_view label, GLenum internal_format, int width, int height);

  void bind() { framebuffer_.bind(); }
  void clear(const glm::vec4& color) { framebuffer_.clear_color(0, color); }
  const gl::Texture& texture() const { return texture_; }

 private:
  gl::Texture texture_;
  gl::Framebuffer framebuffer_;
};

/// Reads a texture back as an image, rows top to bottom.
images::Image read_image(const gl::Texture& texture, int channels);

/// Makes an R32F texture of a one-channel image, rows top to bottom.
gl::Texture upload_image(const images::Image& image);

}  // namespace shadowbench::render
