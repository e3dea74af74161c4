#pragma once

#include <memory>
#include <optional>

#include "harness/stress/axis_inputs.h"

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
  virtual ~TiltedPlane() = default;
  /// Draws the plane's map.
  virtual void tilt(const PlaneTilt& tilt) = 0;
  /// Looks the receivers up, moved towards the light by a bias in metres. Call after tilt().
  virtual Acne find_acne(double bias_m) = 0;
  /// The error in metres that single precision leaves in a depth.
  virtual double rounding_m() const = 0;
};

/// Requires inputs.renderer, which outlives the plane. Throws Error as render::FilterPasses and render::ShadowMap, at
/// tilt().
std::unique_ptr<TiltedPlane> make_gl_plane(const AxisInputs& inputs, const filters::FilterRequest& request);

/// Computes the map's depths at the texels' centres, and looks them up by the filter's scalar model. Requires a filter
/// that has one.
std::unique_ptr<TiltedPlane> make_model_plane(const filters::FilterRequest& request);

/// Finds the least bias without acne, in metres, to a thousandth of `theory_m`; empty where twice that is not enough.
std::optional<double> find_needed_bias(TiltedPlane& plane, double theory_m);

}  // namespace shadowbench::stress
