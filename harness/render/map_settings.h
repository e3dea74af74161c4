#pragma once

#include "filters/depth_curve.h"
#include "harness/gl/gl_api.h"

namespace shadowbench::render {

/// How a depth map stores depth.
struct MapSettings {
  GLenum format = GL_DEPTH_COMPONENT32F;  ///< or GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24
  filters::DepthCurve curve{};            ///< floats are finest near 0, perspective depth is coarsest far away
};

}  // namespace shadowbench::render
