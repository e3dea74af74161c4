#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "harness/gl/handle.h"
#include "harness/gl/pixel_format.h"

namespace shadowbench::gl {

/// Throws Error(kUsage) for a size below 1 or above what this GL gives a texture; `label` says of what.
void require_texture_size(std::string_view label, int width, int height);

/// Owns a 2D texture of immutable size and format; new ones filter nearest and clamp to the edge.
/// Rows of all transfers run bottom to top, as GL's window coordinates do, and are not padded.
class Texture {
 public:
  /// Allocates `levels` mip levels of a sized format such as GL_R32F or GL_DEPTH_COMPONENT24. The texels are undefined.
  /// With `samples` above 0 it is a multisampled one of a single level, which shaders read by texelFetch alone.
  /// Throws Error(kUsage) for a size below 1 or above what this GL gives, Error(kContext) when memory runs out.
  Texture(std::string_view label, GLenum internal_format, int width, int height, int levels = 1, int samples = 0);

  void set_filter(GLenum minify, GLenum magnify);
  /// Sets the wrap mode of both axes, e.g. GL_CLAMP_TO_BORDER.
  void set_wrap(GLenum mode);
  /// Hides the mip levels above this one from reading.
  void set_last_level(int level);
  /// Compares on sampling, with GL_LEQUAL for instance; GL_NONE turns that off.
  void set_compare(GLenum function);

  /// Overwrites level 0. Requires: width * height * channels values.
  void upload_floats(std::span<const float> texels, int channels);
  /// Overwrites level 0 with normalised bytes. Requires: width * height * channels values.
  void upload_bytes(std::span<const std::uint8_t> texels, int channels);
  /// Fills the levels above 0 from level 0.
  void generate_mipmaps();

  /// Waits for the GL and returns level 0 as floats, whatever the storage; depth has one channel.
  std::vector<float> read_floats(int channels) const;

  /// The same for the one texel at (x, y).
  std::vector<float> read_texel(int x, int y, int channels) const;

  /// Binds to texture unit `unit`; a bound Sampler overrides this texture's own filter, wrap, border and compare.
  void bind(GLuint unit) const;

  int width() const { return width_; }
  int height() const { return height_; }
  GLenum internal_format() const { return format_->internal_format; }
  const PixelFormat& format() const { return *format_; }
  /// The bits of depth that the GL really stores; 0 for a colour format.
  int depth_bits() const;
  /// Returns the memory of all levels in bytes, as the format stores them.
  std::size_t bytes() const;
  GLuint id() const { return handle_.id(); }

 private:
  void upload(std::size_t count, int channels, GLenum type, const void* texels);

  Handle<GL_TEXTURE> handle_;
  const PixelFormat* format_;
  int width_;
  int height_;
  int levels_;
  int samples_;
};

}  // namespace shadowbench::gl
