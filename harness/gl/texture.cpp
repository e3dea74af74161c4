#include "harness/gl/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/error.h"

namespace shadowbench::gl {
namespace {

// Transfers depend on global state that other code may have changed.
void reset_transfer_state() {
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  for (const GLenum name : {GL_PACK_ALIGNMENT, GL_UNPACK_ALIGNMENT}) glPixelStorei(name, 1);
  for (const GLenum name : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_UNPACK_ROW_LENGTH,
                            GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS})
    glPixelStorei(name, 0);
}

}  // namespace

void require_texture_size(std::string_view label, int width, int height) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  if (width < 1 || height < 1) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: a size of {}x{} was asked for; both sides must be 1 or more", label, width, height));
  }
  if (width > limit || height > limit) {
    throw Error(ErrorKind::kUsage, fmt::format("{}: a size of {}x{} was asked for; this GL gives at most {}x{}", label,
                                               width, height, limit, limit));
  }
}

Texture::Texture(std::string_view label, GLenum internal_format, int width, int height, int levels, int samples)
    : format_(&pixel_format(internal_format)), width_(width), height_(height), levels_(levels), samples_(samples) {
  require_texture_size(label, width, height);
  handle_ = Handle<GL_TEXTURE>(label, samples > 0 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D);
  if (samples > 0)
    glTextureStorage2DMultisample(id(), samples, internal_format, width, height, GL_TRUE);
  else
    glTextureStorage2D(id(), levels, internal_format, width, height);
  require_allocated(fmt::format("texture '{}' of {}x{} {}", label, width, height, format_->name));
  if (samples > 0) return;
  set_filter(GL_NEAREST, GL_NEAREST);
  set_wrap(GL_CLAMP_TO_EDGE);
}

void Texture::set_filter(GLenum minify, GLenum magnify) {
  glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
}

void Texture::set_wrap(GLenum mode) {
  glTextureParameteri(id(), GL_TEXTURE_WRAP_S, static_cast<GLint>(mode));
  glTextureParameteri(id(), GL_TEXTURE_WRAP_T, static_cast<GLint>(mode));
}

void Texture::set_last_level(int level) { glTextureParameteri(id(), GL_TEXTURE_MAX_LEVEL, level); }

void Texture::set_compare(GLenum function) {
  const bool on = function != GL_NONE;
  glTextureParameteri(id(), GL_TEXTURE_COMPARE_MODE, on ? GL_COMPARE_REF_TO_TEXTURE : GL_NONE);
  if (on) glTextureParameteri(id(), GL_TEXTURE_COMPARE_FUNC, static_cast<GLint>(function));
}

void Texture::upload_floats(std::span<const float> texels, int channels) {
  upload(texels.size(), channels, GL_FLOAT, texels.data());
}

void Texture::upload_bytes(std::span<const std::uint8_t> texels, int channels) {
  upload(texels.size(), channels, GL_UNSIGNED_BYTE, texels.data());
}

void Texture::upload(std::size_t count, int channels, GLenum type, const void* texels) {
  if (count !=
      static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * static_cast<std::size_t>(channels))
    throw std::logic_error(fmt::format("{} values for a texture of {}x{}x{}", count, width_, height_, channels));
  reset_transfer_state();
  glTextureSubImage2D(id(), 0, 0, 0, width_, height_, format_->transfer_format(channels), type, texels);
}

void Texture::generate_mipmaps() { glGenerateTextureMipmap(id()); }

std::vector<float> Texture::read_floats(int channels) const {
  const GLenum transfer = format_->transfer_format(channels);
  std::vector<float> texels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
                            static_cast<std::size_t>(channels));
  reset_transfer_state();
  // glGetTextureImage takes its buffer's size as an int: rows are read in slabs that fit one.
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  const std::size_t row = texels.size() / static_cast<std::size_t>(height_);
  const auto slab = static_cast<int>(std::max<std::size_t>(1, kMostBytes / (row * sizeof(float))));
  for (int y = 0; y < height_; y += slab) {
    const int rows = std::min(slab, height_ - y);
    glGetTextureSubImage(id(), 0, 0, y, 0, width_, rows, 1, transfer, GL_FLOAT,
                         static_cast<GLsizei>(row * static_cast<std::size_t>(rows) * sizeof(float)),
                         texels.data() + row * static_cast<std::size_t>(y));
  }
  return texels;
}

std::vector<float> Texture::read_texel(int x, int y, int channels) const {
  std::vector<float> texel(static_cast<std::size_t>(channels));
  reset_transfer_state();
  glGetTextureSubImage(id(), 0, x, y, 0, 1, 1, 1, format_->transfer_format(channels), GL_FLOAT,
                       static_cast<GLsizei>(texel.size() * sizeof(float)), texel.data());
  return texel;
}

int Texture::depth_bits() const {
  GLint bits = 0;
  glGetTextureLevelParameteriv(id(), 0, GL_TEXTURE_DEPTH_SIZE, &bits);
  return bits;
}

void Texture::bind(GLuint unit) const { glBindTextureUnit(unit, id()); }

std::size_t Texture::bytes() const {
  std::size_t total = 0;
  for (int level = 0; level < levels_; ++level) {
    const auto width = static_cast<std::size_t>(std::max(1, width_ >> level));
    const auto height = static_cast<std::size_t>(std::max(1, height_ >> level));
    total += width * height * static_cast<std::size_t>(format_->bytes_per_texel);
  }
  return total * static_cast<std::size_t>(std::max(1, samples_));
}

}  // namespace shadowbench::gl
