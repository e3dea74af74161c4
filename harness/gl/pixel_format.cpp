#include "harness/gl/pixel_format.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <vector>

#include "base/error.h"

namespace shadowbench::gl {
namespace {

constexpr std::array kFormats = {
    PixelFormat{GL_R8, "r8", 1, 1, false},
    PixelFormat{GL_RG8, "rg8", 2, 2, false},
    PixelFormat{GL_RGBA8, "rgba8", 4, 4, false},
    PixelFormat{GL_SRGB8_ALPHA8, "srgb8_alpha8", 4, 4, false},
    PixelFormat{GL_R16, "r16", 1, 2, false},
    PixelFormat{GL_RG16, "rg16", 2, 4, false},
    PixelFormat{GL_RGBA16, "rgba16", 4, 8, false},
    PixelFormat{GL_R16F, "r16f", 1, 2, false},
    PixelFormat{GL_RG16F, "rg16f", 2, 4, false},
    PixelFormat{GL_RGBA16F, "rgba16f", 4, 8, false},
    PixelFormat{GL_R32F, "r32f", 1, 4, false},
    PixelFormat{GL_RG32F, "rg32f", 2, 8, false},
    PixelFormat{GL_RGBA32F, "rgba32f", 4, 16, false},
    PixelFormat{GL_R32UI, "r32ui", 1, 4, false},
    PixelFormat{GL_RG32UI, "rg32ui", 2, 8, false},
    PixelFormat{GL_RGBA32UI, "rgba32ui", 4, 16, false},
    PixelFormat{GL_DEPTH_COMPONENT16, "d16", 1, 2, true},
    PixelFormat{GL_DEPTH_COMPONENT24, "d24", 1, 4, true},
    PixelFormat{GL_DEPTH_COMPONENT32F, "d32f", 1, 4, true},
};

const PixelFormat& find_by_name(std::string_view name, const char* kind, bool depth_only) {
  std::vector<std::string_view> known;
  for (const PixelFormat& format : kFormats) {
    if (depth_only && !format.depth) continue;
    if (format.name == name) return format;
    known.push_back(format.name);
  }
  throw Error(ErrorKind::kUsage,
              fmt::format("unknown {} format '{}'; there are {}", kind, name, fmt::join(known, ", ")));
}

}  // namespace

GLenum PixelFormat::transfer_format(int count) const {
  constexpr std::array<GLenum, 4> kColors = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
  if (count < 1 || count > channels)
    throw std::logic_error(fmt::format("{} channels asked of {}, which has {}", count, name, channels));
  return depth ? GL_DEPTH_COMPONENT : kColors[static_cast<std::size_t>(count - 1)];
}

const PixelFormat& pixel_format(GLenum internal_format) {
  const auto found = std::ranges::find(kFormats, internal_format, &PixelFormat::internal_format);
  if (found == kFormats.end())
    throw std::logic_error(fmt::format("internal format 0x{:04x} is not in the table of formats", internal_format));
  return *found;
}

const PixelFormat& parse_pixel_format(std::string_view name) { return find_by_name(name, "texture", false); }

const PixelFormat& parse_depth_format(std::string_view name) { return find_by_name(name, "depth", true); }

}  // namespace shadowbench::gl
