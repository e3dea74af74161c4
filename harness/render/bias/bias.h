#pragma once

namespace shadowbench::render {

/// How far a receiver is moved towards the light before it is compared. Of the first two parts the larger one counts;
/// the others are added to it.
struct Bias {
  double constant_depth = 0.0;        ///< in depth, [0,1] over the light's range
  double slope_depth = 0.0;           ///< times 1 - n.l, in depth
  double plane_texels = 0.0;          ///< the receiver plane's depth change over this many shadow-map texels
  double plane_kernels = 0.0;         ///< the part of that per texel of a filter's reach
  double normal_offset_texels = 0.0;  ///< along the normal, texels times the sine of the angle to the light
  bool receiver_plane = false;        ///< every tap is compared with the receiver plane's depth there, not here
  double max_tangent = 10.0;          ///< planes steeper than this towards the light are biased as this one

  bool operator==(const Bias&) const = default;
};

/// What is drawn into the depth map instead of the surfaces that light meets first.
struct MapBias {
  bool cull_front = false;      ///< leave out faces that face the light, of meshes that allow it
  bool midpoint = false;        ///< half-way between the first and the second surface
  double polygon_factor = 0.0;  ///< glPolygonOffset: times the larger depth slope
  double polygon_units = 0.0;   ///< glPolygonOffset: times the format's smallest step

  bool operator==(const MapBias&) const = default;
};

}  // namespace shadowbench::render
