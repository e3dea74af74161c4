#include "harness/render/image_target.h"

#include <algorithm>

namespace shadowbench::render {

ImageTarget::ImageTarget(std::string_view label, GLenum internal_format, int width, int height)
    : texture_(label, internal_format, width, height), framebuffer_(label) {
  framebuffer_.attach_color(0, texture_);
}

namespace {

/// Turns rows that run bottom to top, as GL's do, into rows that run top to bottom, and back.
std::vector<float> flip_rows(const std::vector<float>& rows, std::ptrdiff_t stride) {
  std::vector<float> flipped(rows.size());
  const std::ptrdiff_t height = static_cast<std::ptrdiff_t>(rows.size()) / stride;
  for (std::ptrdiff_t y = 0; y < height; ++y) {
    const auto row = rows.begin() + stride * (height - 1 - y);
    std::copy(row, row + stride, flipped.begin() + stride * y);
  }
  return flipped;
}

}  // namespace

images::Image read_image(const gl::Texture& texture, int channels) {
  images::Image image(texture.width(), texture.height(), channels);
  image.texels = flip_rows(texture.read_floats(channels), static_cast<std::ptrdiff_t>(texture.width()) * channels);
  return image;
}

gl::Texture upload_image(const images::Image& image) {
  gl::Texture texture("uploaded image", GL_R32F, image.width, image.height);
  texture.upload_floats(flip_rows(image.texels, image.width), 1);
  return texture;
}

}  // namespace shadowbench::render
