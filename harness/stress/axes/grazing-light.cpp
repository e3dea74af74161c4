#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "filters/model.h"
#include "harness/stress/axis.h"
#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace grazing_light {

constexpr double kBound = 10.0;     // texels
constexpr double kTolerance = 0.1;  // of what geometry says
constexpr const char* kSource = "derived: the depth that a plane gains over the kernel, s (r + 1) tan(angle)";

/// A kernel as theory sees it.
struct Reach {
  double shape = 0.0;    ///< r: half-width of the kernel's own shape, texels
  double between = 1.0;  ///< what reading between texels adds: 1 for the bilinear 2x2, half for the nearest texel

  double texels() const { return shape + between; }
};

Reach find_reach(const filters::FilterRequest& request) {
  const filters::Kernel kernel = *filters::find_kernel(request.spec, request.values);
  const bool nearest = kernel.reconstruction() == filters::Reconstruction::kNearest;
  const double texels = filters::bias_reach_texels(request.spec, request.values), between = nearest ? 0.5 : 1.0;
  return {texels - between, between};
}

std::string describe_theory(const Reach& reach, bool diagonal) {
  return fmt::format("s ({:g} + {:g}){} tan(angle)", reach.shape, reach.between, diagonal ? " sqrt(2)" : "");
}

/// The angle at which the bias reaches the bound, and the law that the bias follows at every angle.
std::vector<Theory> make_theories(const Reach& reach, bool diagonal) {
  const double gain = find_gain_m({45.0, diagonal}, reach.texels()) / kPlaneTexel_m;
  const std::string law = describe_theory(reach, diagonal);
  return {{std::atan(kBound / gain) * 180.0 / std::numbers::pi, TheoryKind::kSlope,
           fmt::format("{} = {:g} s", law, kBound), kSource, Verdict::kDegraded},
          {std::nullopt, TheoryKind::kSlope, fmt::format("none: the bias is {} at every angle", law), kSource,
           Verdict::kBroken}};
}

Observation observe_plane(TiltedPlane& plane, const PlaneTilt& tilt, const Reach& reach) {
  plane.tilt(tilt);
  const double theory = find_gain_m(tilt, reach.texels());
  const std::optional<double> needed = plane.find_needed_bias(theory);
  if (!needed)
    return {Verdict::kBroken, std::nullopt,
            fmt::format("acne under twice the bias that theory asks for, {:.3g} texels", theory / kPlaneTexel_m)};
  const double texels = *needed / kPlaneTexel_m;
  if (std::abs(*needed - theory) > kTolerance * theory + plane.rounding_m()) {
    return {Verdict::kBroken, texels,
            fmt::format("needs {:.3g} texels, where theory asks for {:.3g}", texels, theory / kPlaneTexel_m)};
  }
  if (texels > kBound)
    return {Verdict::kDegraded, texels, fmt::format("needs a bias of {:.3g} texels, over {:g}", texels, kBound)};
  return {Verdict::kOk, texels, {}};
}

/// Where hardware filters with weights of few bits: what weighs less is not read, and needs no bias.
std::string explain_by_weights(const Disagreement& missed, const Reach& reach, bool diagonal, double weight_bits) {
  if (weight_bits >= 23.0) return {};
  for (const records::StressSample& sample : missed.record.samples) {
    const double theory = find_gain_m({sample.value, diagonal}, reach.texels()) / kPlaneTexel_m;
    if (!sample.measured || *sample.measured > (1.0 + kTolerance) * theory) return {};
  }
  return fmt::format("this GL filters with weights of {:g} bits, which round the kernel's outermost texels to nothing",
                     weight_bits);
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request, bool diagonal, Level level) {
  const char* variant = diagonal ? "light along the diagonal" : "light along a row";
  Case item = start_case(inputs, request, variant, level);
  if (!item.is_available()) return item;
  const Reach reach = find_reach(request);
  item.theories = make_theories(reach, diagonal);
  const auto plane = std::make_shared<TiltedPlane>(inputs, request);
  item.observe = [plane, reach, diagonal](double angle) { return observe_plane(*plane, {angle, diagonal}, reach); };
  item.explain = [reach, diagonal, renderer = inputs.renderer](const Disagreement& missed) {
    return explain_by_weights(missed, reach, diagonal, measure::measure_accuracy(*renderer).weight_bits);
  };
  return item;
}

/// Lists how the light falls: along the diagonal or not.
std::vector<bool> list_ways(const filters::FilterRequest& request) {
  return request.spec.kind == filters::FilterKind::kComparison ? std::vector{false, true} : std::vector<bool>();
}

/// Models would draw the same lines beside the GL's.
std::vector<Case> make_cases(const AxisInputs& inputs) {
  return make_filter_cases(inputs, list_ways, make_case, "no chosen filter is of kind comparison", {Level::kGl});
}

}  // namespace grazing_light

Axis make_grazing_light_axis() {
  using namespace grazing_light;
  Axis axis;
  axis.title = "Grazing light: the bias that an empty plane takes";
  axis.quantity = "angle between the light and the plane's normal";
  axis.unit = "degrees";
  axis.log = false;
  axis.range = {0.0, 89.99};
  axis.limits = {0.0, 89.999};
  axis.coarse_samples = 37;
  axis.measured = "least bias without acne, along the light";
  axis.measured_unit = "texels";
  axis.bound = kBound;
  axis.broken_when = "the bias that is needed is more than 10 % off what the plane's depth gains over the kernel";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
