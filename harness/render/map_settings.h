#pragma once

#include "harness/gl/gl_api.h"

namespace shadowbench::render {

/// How a depth map stores depth.
struct MapSettings {
  GLenum format = GL_DEPTH_COMPONENT32F;  ///< or GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24
  bool reversed = false;                  ///< holds 1 - depth: floats are finest near 0, perspective depth coarsest near 1
};

}  // namespace shadowbench::render
