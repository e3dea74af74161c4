#include <fmt/format.h>

#include <algorithm>

#include "harness/stress/explain.h"
#include "harness/stress/straight_edge.h"

namespace shadowbench::stress {
namespace kernel_radius {

constexpr double kBound = 0.02;               // of visibility: five steps of an 8-bit picture
constexpr double kSamplerStep = 1.0 / 128.0;  // GPUs interpolate a comparison with 8 bits

/// A chosen filter whose kernel's radius is a parameter.
struct RadiusFilter {
  filters::FilterRequest request;
  std::string param;
};

std::vector<RadiusFilter> find_radius_filters(const StressContext& context) {
  std::vector<RadiusFilter> found;
  for (const filters::FilterRequest& request : context.filters)
    if (const auto* param = std::get_if<std::string>(&request.spec.radius_texels)) found.push_back({request, *param});
  return found;
}

bool averages_comparisons(const filters::FilterSpec& spec) {
  return !spec.has_encode && spec.kind != filters::FilterKind::kOther;
}

/// What a filter is without a kernel.
std::string name_base(const filters::FilterSpec& spec, const filters::Kernel& kernel) {
  const bool nearest = kernel.reconstruction() == filters::Reconstruction::kNearest;
  if (!averages_comparisons(spec))
    return nearest ? "its formula on one texel" : "its formula on one texel, read between texels";
  return nearest ? "one comparison with the nearest texel" : "one hardware 2x2 comparison";
}

/// The filter's own arithmetic, in extended precision; without a radius the base comparison, which is nobody's code.
std::vector<double> expect_visibility(const RadiusFilter& filter, const filters::ParamValues& values,
                                      const ProbeScene& scene, Probe& exact) {
  if (filters::number(values, filter.param) > 0.0 || !averages_comparisons(filter.request.spec))
    return exact.look(scene, values).visibility;
  return compare_whole_kernel(scene, filters::make_model(filter.request.spec.id)->kernel(values));
}

Observation observe_radius(const RadiusFilter& filter, double radius, Probe& probe, Probe& exact) {
  filters::ParamValues values = filter.request.values;
  values[filter.param] = radius;
  const ProbeScene scene = make_straight_edge(radius);
  Observation seen = judge_edge(probe.look(scene, values), expect_visibility(filter, values, scene, exact), kBound,
                                filter.request.spec.kind);
  if (radius > 0.0 || seen.verdict == Verdict::kBroken || seen.measured.value_or(1.0) <= kSamplerStep) return seen;
  return {
      Verdict::kBroken, seen.measured,
      fmt::format("radius 0 is off by {:.2g} from what the filter is without a kernel", seen.measured.value_or(1.0))};
}

std::vector<std::string> remark_base(const records::StressCase& record, const std::string& base) {
  if (record.samples.empty() || record.samples.front().value != 0.0 || !record.samples.front().measured) return {};
  return {fmt::format("radius 0 is {}, within {:.2g}", base, *record.samples.front().measured)};
}

Case make_case(const StressContext& context, const RadiusFilter& filter, Level level) {
  const filters::FilterRequest& request = filter.request;
  const std::string variant = request.spec.has_prefilter ? "blurred map" : "disk of comparisons";
  const auto [probe, reason] = make_probe(context, request, level);
  if (!probe || !filters::make_model(request.spec.id)) {
    return make_absent_case(request.spec.id, variant, level,
                            probe ? "the filter has no scalar model to be held against" : reason);
  }
  Case item = start_case(request, variant, level);
  item.params.erase(filter.param);
  item.theories = {
      {std::nullopt, TheoryKind::kRounding, "none: a wider kernel adds more numbers, none of them larger",
       "derived: a mean of n numbers with weights that sum to 1 is off by n unit round-offs of the largest at most",
       Verdict::kDegraded}};
  item.explain = explain_broken_throughout;
  const std::shared_ptr<Probe> exact = make_model_probe(context, request, filters::Precision::kExtended);
  item.observe = [filter, probe = probe, exact](double radius) {
    return observe_radius(filter, radius, *probe, *exact);
  };
  filters::ParamValues without = request.values;
  without[filter.param] = 0.0;
  const std::string base = name_base(request.spec, filters::make_model(request.spec.id)->kernel(without));
  item.remark = [base](const records::StressCase& record) { return remark_base(record, base); };
  return item;
}

std::vector<Case> make_cases(const StressContext& context) {
  std::vector<Case> cases;
  for (const RadiusFilter& filter : find_radius_filters(context))
    for (const Level level : {Level::kGl, Level::kModel}) cases.push_back(make_case(context, filter, level));
  if (cases.empty())
    cases.push_back(
        make_absent_case({}, "any", Level::kGl, "no chosen filter takes the radius of its kernel as a parameter"));
  return cases;
}

}  // namespace kernel_radius

Axis make_kernel_radius_axis() {
  using namespace kernel_radius;
  Axis axis;
  axis.title = "Kernel radius, from none to half the map";
  axis.quantity = "radius of the kernel";
  axis.unit = "texels";
  axis.scale = Scale::kLinear;
  axis.range = {0.0, kWidestRadius};
  axis.limits = axis.range;
  axis.coarse_samples = 17;
  axis.whole = true;
  axis.measured = "largest error of visibility across an edge";
  axis.bound = kBound;
  axis.broken_when =
      "texels of the map overflowed, or visibility is not finite, all lit or all dark where it should not be, or falls "
      "by more than 0.1 from dark to light "
      "(not asked of stochastic filters); at radius 0 also where the filter is more than 1/128 off what it is without "
      "a kernel";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
