#include "harness/render/image_target.h"

#include <algorithm>

namespace shadowbench::render {

ImageTarget::ImageTarget(std::string_view label, GLenum internal_format, int width, int height)
    : texture_(label, internal_format, width, height), framebuffer_(label) {
  framebuffer_.attach_color(0, texture_);
}

report::Image read_image(const gl::Texture& texture, int channels) {
  const std::vector<float> rows = texture.read_floats(channels);
  report::Image image(texture.width(), texture.height(), channels);
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(texture.width()) * channels;
  for (int y = 0; y < texture.height(); ++y) {
    const auto row = rows.begin() + stride * (texture.height() - 1 - y);
    std::copy(row, row + stride, image.texels.begin() + stride * y);
  }
  return image;
}

}  // namespace shadowbench::render
