#pragma once

#include <optional>

#include "harness/stress/filter_bench.h"

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

}  // namespace shadowbench::stress
