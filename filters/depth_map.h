#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace shadowbench::filters {

/// What a lookup reads outside the map.
enum class Border {
  kBorder,  ///< depth 1, or its encoding: lit. The right one
  kEdge,    ///< the nearest texel of the map: casters at its edge are smeared outwards
  kRepeat,  ///< the map over and over: its shadows are tiled
};
constexpr auto names_of(Border) { return std::array{"border", "edge", "repeat"}; }

/// What a lookup does with receivers that the map says nothing about. The defaults are right; each other choice shows
/// an artefact.
struct RangeRule {
  Border border = Border::kBorder;
  bool far_test = true;  ///< beyond the far plane is lit; without, it is compared with depths that cannot reach it
  bool behind_test =
      true;  ///< projective maps: behind the light is lit; without, the map is mirrored through the light
};

/// How a map stores depth. Filters see linear depth z in [0,1], 0 near; a map may instead hold the depth of a
/// perspective projection, R z / (1 + (R - 1) z), where R = `far_over_near` is the distance of its far plane divided by
/// that of its near plane. A reversed map holds 1 minus that. shaders/lib/depth_curve.glsl does the same.
struct DepthCurve {
  bool reversed = false;
  double far_over_near = 1.0;  ///< 1: linear

  bool is_linear() const { return far_over_near == 1.0; }
  bool operator==(const DepthCurve&) const = default;

  /// What a map stores for a depth. Depth before the near plane counts as on it where the curve is not linear.
  template <class T>
  T store(T z) const {
    if (is_linear()) return reversed ? T(1) - z : z;
    const T ratio = static_cast<T>(far_over_near);
    if (z < T(0)) z = T(0);
    return (reversed ? T(1) - z : ratio * z) / (T(1) + (ratio - T(1)) * z);
  }

  /// The depth that a stored value stands for; the inverse of store().
  template <class T>
  T linear(T stored) const {
    if (is_linear()) return reversed ? T(1) - stored : stored;
    const T ratio = static_cast<T>(far_over_near);
    const T away = reversed ? stored : T(1) - stored;
    return (T(1) - away) / (T(1) + (ratio - T(1)) * away);
  }

  /// What a cleared map holds: the far plane.
  float far_plane() const { return reversed ? 0.0f : 1.0f; }

  /// Whether a stored reference is lit by a stored depth; ties are.
  bool is_lit(float reference, float stored) const { return reversed ? reference >= stored : reference <= stored; }
};

/// How a format stores depth.
struct DepthFormat {
  int bits = 32;
  bool is_float = true;
};

/// The distance between neighbouring values of a format at a depth: 1 / (2^bits - 1), or the ULP of a float with 24
/// significant bits.
inline double depth_quantum(double depth, const DepthFormat& format) {
  if (!format.is_float) return 1.0 / (std::exp2(format.bits) - 1.0);
  // Depth below the smallest normal number is 0 on most GLs.
  const double size = std::max(std::abs(depth), double{std::numeric_limits<float>::min()});
  return std::exp2(std::floor(std::log2(size)) - 23.0);
}

/// By how much two depths must differ at a depth for a format to tell them apart: (1 + (R - 1) z)^2 / R times the
/// format's quantum at what is stored.
inline double depth_step(double depth, const DepthCurve& curve, const DepthFormat& format) {
  const double ratio = curve.far_over_near, distance = 1.0 + (ratio - 1.0) * depth;  // in units of the near plane's
  return distance * distance / ratio * depth_quantum(curve.store(depth), format);
}

/// A depth map as read back from the GL; row 0 is v = 0.
struct DepthMap {
  int size = 0;               ///< texels per side
  std::vector<float> stored;  ///< size * size, in [0,1]; what it means is the curve's
  DepthCurve curve{};
  /// Fixed-point formats clamp the reference of a comparison to [0,1], float formats do not (OpenGL 4.5, section 8.23).
  bool clamps_reference = false;
  Border border = Border::kBorder;  ///< what lookups read outside
  int texel_bytes = 4;              ///< of the map in the GL

  /// What a comparison with depth `z` compares with.
  float reference(float z) const {
    const float reference = curve.store(z);
    return clamps_reference ? std::clamp(reference, 0.0f, 1.0f) : reference;
  }

  /// What a lookup finds in a texel, or outside the map where there is none.
  float at(const std::optional<std::size_t>& texel) const { return texel ? stored[*texel] : curve.far_plane(); }

  /// Whether depth `z` is lit by a stored depth; ties are.
  bool is_lit(float z, float by) const { return curve.is_lit(reference(z), by); }

  /// Whether rounding may decide that comparison: `z` may be off by one ULP, and by some more if the curve divides.
  bool is_tie(float z, float by) const {
    const float ulp = std::nextafter(std::abs(z), 2.0f * std::abs(z) + 1.0f) - std::abs(z);
    const auto [least, most] = std::minmax({reference(z - ulp), reference(z + ulp)});
    const float rounding = curve.is_linear() ? 0.0f : kCurveRounding * std::abs(by);
    return least - rounding <= by && by <= most + rounding;
  }

 private:
  static constexpr float kCurveRounding = 4.0f * std::numeric_limits<float>::epsilon();
};

}  // namespace shadowbench::filters
