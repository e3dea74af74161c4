#pragma once

#include <string_view>

#include "harness/gl/gl_api.h"

namespace shadowbench::gl {

/// A sized internal format.
struct PixelFormat {
  GLenum internal_format = 0;
  std::string_view name;  ///< as scenes and results write it: "r32f", "rg16f", "d24"
  int channels = 0;
  int bytes_per_texel = 0;  ///< as stored; D24 counts 4, which is what every GL takes for it
  bool depth = false;

  /// Returns GL's transfer format for `count` channels of this format: GL_RED ... GL_RGBA or GL_DEPTH_COMPONENT.
  /// Throws std::logic_error for a count that the format does not have.
  GLenum transfer_format(int count) const;
};

/// Looks a format up. Throws std::logic_error for one that Shadowbench does not use.
const PixelFormat& pixel_format(GLenum internal_format);

/// Looks a format up by its name. Throws Error(kUsage) with the names there are.
const PixelFormat& parse_pixel_format(std::string_view name);

/// Looks a depth format up by its name. Throws Error(kUsage) with the depth formats there are.
const PixelFormat& parse_depth_format(std::string_view name);

}  // namespace shadowbench::gl
