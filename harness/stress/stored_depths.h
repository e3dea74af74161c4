#pragma once

#include <optional>
#include <vector>

#include "harness/render/shadow_map.h"

namespace shadowbench::stress {

/// How distances become depth. The near plane is one unit away.
struct DepthPlan {
  double far_over_near = 10.0;
  bool perspective = false;  ///< otherwise depth is linear in distance
  bool reversed = false;     ///< one less that
};

/// The depth in [0,1] of a distance, in units of the near plane's, and the distance of a depth.
double depth_of(const DepthPlan& plan, double distance);
double distance_of(const DepthPlan& plan, double depth);

/// What a depth may be off by once it is stored: half the format's quantum just below that depth.
double largest_rounding(GLenum format, double depth);

/// What a distance may be off by: largest_rounding() times the slope of distance over depth,
/// d^2 (f - n) / (n f) in perspective and f - n else. In units of the near plane's distance.
double find_distance_error(GLenum format, const DepthPlan& plan, double distance);

/// A distance that came back as another one.
struct DepthError {
  double relative = 0.0;  ///< of the distance
  double distance = 1.0;  ///< where, in units of the near plane's
};

/// A depth map that known distances are drawn into, as squares that face the light, and read back from.
class StoredDepths {
 public:
  /// Nothing is allocated before the first use, which throws Error as render::ShadowMap: where the GL lacks the format,
  /// or stores it in other bits. `shaders` must outlive this object.
  StoredDepths(render::ShaderLibrary& shaders, GLenum format) : shaders_(shaders), format_(format) {}

  /// Looks at distances between the planes, and densely at both planes, where a quantum of depth counts most.
  DepthError find_largest_error(const DepthPlan& plan);

  /// The largest error, in units of the near plane's distance, at distances whose depths lie within some quanta
  /// of one's.
  double find_error_around(const DepthPlan& plan, double distance);

 private:
  render::ShaderLibrary& shaders_;
  GLenum format_;
  std::optional<render::ShadowMap> map_;

  /// Stores depths and reads them back.
  std::vector<double> keep(const std::vector<double>& depths);
};

}  // namespace shadowbench::stress
