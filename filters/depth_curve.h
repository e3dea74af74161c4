#pragma once

namespace shadowbench::filters {

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
double depth_quantum(double depth, const DepthFormat& format);

/// By how much two depths must differ at a depth for a format to tell them apart: (1 + (R - 1) z)^2 / R times the
/// format's quantum at what is stored.
double depth_step(double depth, const DepthCurve& curve, const DepthFormat& format);

}  // namespace shadowbench::filters
