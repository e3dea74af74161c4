#pragma once

#include <optional>
#include <vector>

#include "harness/render/shadow_map.h"
#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {

/// How an empty plane lies under the light.
struct PlaneTilt {
  double angle_deg = 0.0;  ///< between the light and the plane's normal, 0 <= angle < 90
  bool diagonal = false;   ///< the plane falls away along the texels' diagonal; otherwise along their rows
};

/// The side of the plane's map, in texels; it is a metre wide.
inline constexpr int kPlaneMapTexels = 64;
inline constexpr double kPlaneTexel_m = 1.0 / kPlaneMapTexels;

/// The depth in metres that the plane gains over a kernel which reaches so many texels on each axis, and which a
/// bias has to cover: s r tan(angle), and sqrt 2 times that on the diagonal.
double find_gain_m(const PlaneTilt& tilt, double reach_texels);

/// The acne on a plane that is lit.
struct Acne {
  double mean_shadow = 0.0;  ///< over all receivers, [0,1]
  double share = 0.0;        ///< of the receivers: darker than lit by a step of an 8-bit picture or more
};

/// An empty plane without end, with receivers all over it, between texels too. Every shadow on it is acne.
class TiltedPlane {
 public:
  /// Requires inputs.renderer, which outlives the plane.
  TiltedPlane(const AxisInputs& inputs, filters::FilterRequest request)
      : seed_(inputs.seed), bench_(inputs, std::move(request)) {}

  /// Draws the plane's map. Throws Error as render::FilterPasses and render::ShadowMap.
  void tilt(const PlaneTilt& tilt);

  /// Looks the receivers up, moved towards the light by a bias in metres. Call after tilt().
  Acne find_acne(double bias_m);

  /// Finds the least bias without acne, in metres, to a thousandth of `theory_m`; empty where twice that is not enough.
  /// Call after tilt().
  std::optional<double> find_needed_bias(double theory_m);

  /// The error in metres that single precision leaves in a depth.
  double rounding_m() const;

 private:
  std::uint32_t seed_;
  FilterBench bench_;
  PlaneTilt tilt_;
};

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
