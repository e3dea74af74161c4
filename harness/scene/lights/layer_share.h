#pragma once

#include <variant>

namespace shadowbench::scene {

/// The depths along the camera's axis that a cascade serves, metres. It fades in and out linearly, as its neighbours
/// fade out and in: the shares of all cascades add up to 1 everywhere.
struct ViewSlice {
  double fade_in_begin = 0.0;
  double fade_in_end = 0.0;
  double fade_out_begin = 0.0;
  double fade_out_end = 0.0;
  double end_m = 0.0;  ///< what it was fitted to; the last slice also serves what lies beyond

  bool operator==(const ViewSlice&) const = default;
};

/// The directions that a face of a cube serves: those that are longest along its axis. Of directions that are as long
/// along two axes, x goes before y, and y before z.
struct CubeFace {
  int index = 0;  ///< +x, -x, +y, -y, +z, -z

  bool operator==(const CubeFace&) const = default;
};

inline constexpr int kCubeFaces = 6;
inline constexpr int kHalfSpheres = 2;

/// The directions that one of two paraboloids serves. One that is level is the first's.
struct HalfSphere {
  bool is_upper = false;  ///< the second; the first is the lower

  bool operator==(const HalfSphere&) const = default;
};

/// What a layer of a light's map serves of the receivers: all of them, or a share.
using LayerShare = std::variant<std::monostate, ViewSlice, CubeFace, HalfSphere>;

}  // namespace shadowbench::scene
