#include <fmt/format.h>

#include <algorithm>

#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace kernel_radius {

constexpr double kSamplerStep = 1.0 / 128.0;  // GPUs interpolate a comparison with 8 bits

/// Lists the parameter that is the radius of a filter's kernel; nothing where the radius is no parameter, or only
/// limits what each receiver chooses.
std::vector<std::string> list_radius_params(const filters::FilterRequest& request) {
  if (!filters::find_kernel(request.spec, request.values)) return {};
  const auto* param = std::get_if<std::string>(&request.spec.radius_texels);
  return param ? std::vector{*param} : std::vector<std::string>();
}

bool averages_comparisons(const filters::FilterSpec& spec) {
  return !spec.has_encode && spec.kind != filters::FilterKind::kOther;
}

/// The filter's own arithmetic in extended precision; without a radius the base comparison, which needs none of
/// the filter's code.
std::vector<double> expect_visibility(const filters::FilterRequest& request, double radius, const SyntheticScene& scene,
                                      const SyntheticLookup& exact) {
  if (radius > 0.0 || !averages_comparisons(request.spec)) return exact(scene, request.values).visibility;
  return compare_whole_kernel(scene, *filters::find_kernel(request.spec, request.values));
}

/// `request` has the radius among its values.
Observation observe_radius(const filters::FilterRequest& request, double radius, const SyntheticLookup& lookup,
                           const SyntheticLookup& exact) {
  const SyntheticScene scene = make_straight_edge(radius);
  Observation seen =
      judge_edge(lookup(scene, request.values), expect_visibility(request, radius, scene, exact), request.spec.kind);
  if (radius > 0.0 || seen.verdict == Verdict::kBroken || seen.measured.value_or(1.0) <= kSamplerStep) return seen;
  return {
      Verdict::kBroken, seen.measured,
      fmt::format("radius 0 is off by {:.2g} from what the filter is without a kernel", seen.measured.value_or(1.0))};
}

/// A radius of which the front matter lists the values takes no others; each of them is a shader of its own.
std::vector<double> list_radii(const filters::ParamSpec& param) {
  std::vector<double> radii;
  for (const filters::ParamValue& choice : param.choices) radii.push_back(std::get<double>(choice));
  std::ranges::sort(radii);
  return radii;
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request, const std::string& param, Level level) {
  Case item =
      start_case(inputs, request, averages_comparisons(request.spec) ? "disk of comparisons" : "blurred map", level);
  if (!item.is_available()) return item;
  item.params.erase(param);
  item.theories = {
      {std::nullopt, TheoryKind::kRounding, "none: a wider kernel adds more numbers, none of them larger",
       "derived: a mean of n numbers with weights that sum to 1 is off by n unit round-offs of the largest at most",
       Verdict::kDegraded}};
  item.explain = explain_broken_throughout;
  item.values = list_radii(*request.spec.find_param(param));
  item.observe = [&inputs, request = request, param, level, is_const = request.spec.find_param(param)->is_const,
                  lookup = make_lookup(inputs, request, level),
                  exact = make_model_lookup(inputs, request, filters::Precision::kExtended)](double radius) mutable {
    request.values[param] = radius;
    if (is_const) lookup = make_lookup(inputs, request, level);
    return observe_radius(request, radius, lookup, exact);
  };
  return item;
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  return make_filter_cases(inputs, list_radius_params, make_case,
                           "no chosen filter takes the radius of its kernel as a parameter");
}

}  // namespace kernel_radius

Axis make_kernel_radius_axis() {
  using namespace kernel_radius;
  Axis axis;
  axis.title = "Kernel radius, from none to half the map";
  axis.quantity = "radius of the kernel";
  axis.unit = "texels";
  axis.log = false;
  axis.range = {0.0, kWidestRadius};
  axis.limits = axis.range;
  axis.coarse_samples = 17;
  axis.whole = true;
  axis.measured = "largest error of visibility across an edge";
  axis.bound = kVisibleError;
  axis.broken_when =
      "texels of the map overflowed, or visibility is not finite, all lit or all dark where it should not be, or falls "
      "by more than 0.1 from dark to light "
      "(not asked of stochastic filters); at radius 0 also where the filter is more than 1/128 off what it is without "
      "a kernel";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
