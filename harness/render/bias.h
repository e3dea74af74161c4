#pragma once

namespace shadowbench::render {

/// Says how far a receiver is moved towards the light before it is compared. The three parts add up.
struct Bias {
  double constant_depth = 0.0;        ///< in depth, [0,1] over the light's range
  double slope_texels = 0.0;          ///< the receiver plane's depth change over this many shadow-map texels
  double normal_offset_texels = 0.0;  ///< along the normal, texels times the sine of the angle to the light
  double max_tangent = 10.0;          ///< planes steeper than this towards the light are biased as this one
};

}  // namespace shadowbench::render
