#pragma once

#include <cstdint>
#include <string>

#include "harness/gl/pixel_format.h"
#include "harness/gl/program.h"

namespace shadowbench::render {

/// A full-screen pass of a filter, as it is drawn for one map.
struct DrawnPass {
  std::string name;  ///< "lookup", "encode", "blur", or that of a pass of the filter's own
  gl::ShaderSource fragment;
  gl::PixelFormat target;  ///< what it draws into
  int draws = 1;
  std::int64_t texels = 0;  ///< that it writes, all draws together
  int read_bytes = 0;       ///< of a texel of what it reads
};

}  // namespace shadowbench::render
