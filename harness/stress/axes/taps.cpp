#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace taps {

constexpr records::StressRange kRange{1.0, 128.0};

/// Lists the parameter that counts the points of a filter's disk; nothing where it has no disk.
std::vector<filters::ParamSpec> list_count_params(const filters::FilterRequest& request) {
  if (request.spec.disks.empty()) return {};
  return {*request.spec.find_param(request.spec.disks.front().count)};
}

/// The largest count that a filter allows and that is not above `wanted`; its smallest where there is none.
double choose_count(const filters::ParamSpec& param, double wanted) {
  if (param.choices.empty()) return std::clamp(wanted, param.min.value_or(wanted), param.max.value_or(wanted));
  std::vector<double> counts;
  for (const filters::ParamValue& choice : param.choices) counts.push_back(std::get<double>(choice));
  std::ranges::sort(counts);
  const auto above = std::ranges::upper_bound(counts, wanted);
  return above == counts.begin() ? counts.front() : *(above - 1);
}

filters::FilterRequest with_count(filters::FilterRequest request, const filters::ParamSpec& param, double wanted) {
  request.values[param.name] = choose_count(param, wanted);
  return request;
}

SyntheticScene make_scene(const filters::FilterRequest& request) {
  return make_straight_edge(
      std::clamp(filters::radius_texels(request.spec, request.values), 0.0, double{kWidestRadius}));
}

/// The number of taps is compiled in: every count needs a lookup of its own.
Observation observe_taps(const AxisInputs& inputs, const filters::FilterRequest& request, Level level) {
  const SyntheticScene scene = make_scene(request);
  const std::vector<double> expected =
      make_model_lookup(inputs, request, filters::Precision::kExtended)(scene, request.values).visibility;
  return judge_edge(make_lookup(inputs, request, level)(scene, request.values), expected, request.spec.kind);
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request, const filters::ParamSpec& param,
               Level level) {
  const std::string variant =
      fmt::format("{} at radius {:g}", param.name, filters::radius_texels(request.spec, request.values));
  Case item = start_case(inputs, request, variant, level);
  if (!item.is_available()) return item;
  item.params.erase(param.name);
  item.theories = {{std::nullopt, TheoryKind::kRounding, "none: more taps add more numbers, none of them above 1",
                    "derived: a mean of n numbers is off by n unit round-offs of the largest at most",
                    Verdict::kDegraded}};
  item.explain = explain_broken_throughout;
  item.observe = [&inputs, request, param, level](double taps) {
    return observe_taps(inputs, with_count(request, param, taps), level);
  };
  return item;
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  return make_filter_cases(inputs, list_count_params, make_case, "no chosen filter takes a number of taps");
}

}  // namespace taps

Axis make_taps_axis() {
  using namespace taps;
  Axis axis;
  axis.title = "Number of taps, over what the filters allow";
  axis.quantity = "taps";
  axis.range = kRange;
  axis.limits = kRange;
  axis.coarse_samples = 8;
  axis.whole = true;
  axis.measured = "largest error of visibility across an edge";
  axis.bound = kVisibleError;
  axis.broken_when = "visibility is not finite, all lit or all dark where it should not be";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
