#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "harness/stress/explain.h"
#include "harness/stress/straight_edge.h"

namespace shadowbench::stress {
namespace taps {

constexpr double kBound = 0.02;  // of visibility: five steps of an 8-bit picture
constexpr Range kRange{1.0, 128.0};

/// A chosen filter that takes so many points of a disk.
struct TapsFilter {
  filters::FilterRequest request;
  const filters::ParamSpec& find_param() const { return *request.spec.find_param(request.spec.disks.front().count); }
};

std::vector<TapsFilter> find_taps_filters(const StressContext& context) {
  std::vector<TapsFilter> found;
  for (const filters::FilterRequest& request : context.filters)
    if (!request.spec.disks.empty()) found.push_back({request});
  return found;
}

/// Gives the largest count that a filter allows and that is not above `wanted`; its smallest where there is none.
double choose_count(const filters::ParamSpec& param, double wanted) {
  if (param.choices.empty()) return std::clamp(wanted, param.min.value_or(wanted), param.max.value_or(wanted));
  std::vector<double> counts;
  for (const filters::ParamValue& choice : param.choices) counts.push_back(std::get<double>(choice));
  std::ranges::sort(counts);
  const auto above = std::ranges::upper_bound(counts, wanted);
  return above == counts.begin() ? counts.front() : *(above - 1);
}

filters::FilterRequest with_count(const TapsFilter& filter, double wanted) {
  filters::FilterRequest request = filter.request;
  request.values[filter.find_param().name] = choose_count(filter.find_param(), wanted);
  return request;
}

ProbeScene make_scene(const filters::FilterRequest& request) {
  return make_straight_edge(
      std::clamp(filters::radius_texels(request.spec, request.values), 0.0, double{kWidestRadius}));
}

/// The number of taps is compiled in: every count is a program of its own.
Observation observe_taps(const StressContext& context, const TapsFilter& filter, double wanted, Level level) {
  const filters::FilterRequest request = with_count(filter, wanted);
  const ProbeScene scene = make_scene(request);
  const std::vector<double> expected =
      make_model_probe(context, request, filters::Precision::kExtended)->look(scene, request.values).visibility;
  return judge_edge(make_probe(context, request, level).probe->look(scene, request.values), expected, kBound,
                    request.spec.kind);
}

/// Gives how far the taps are from the kernel that they stand for, root mean square over an edge.
double find_noise(const StressContext& context, const filters::FilterRequest& request) {
  const ProbeScene scene = make_scene(request);
  const std::vector<double> seen =
      make_model_probe(context, request, filters::Precision::kDouble)->look(scene, request.values).visibility;
  const std::vector<double> whole =
      compare_whole_kernel(scene, filters::make_model(request.spec.id)->kernel(request.values));
  double sum = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) sum += (seen[i] - whole[i]) * (seen[i] - whole[i]);
  return std::sqrt(sum / static_cast<double>(seen.size()));
}

std::vector<std::string> remark_noise(const StressContext& context, const TapsFilter& filter,
                                      const records::StressCase& record) {
  std::vector<std::string> parts;
  double before = 0.0;
  for (const records::StressSample& sample : record.samples) {
    const double count = choose_count(filter.find_param(), sample.value);
    if (count == before) continue;
    parts.push_back(fmt::format("{:.2g} with {:g}", find_noise(context, with_count(filter, count)), count));
    before = count;
  }
  return {
      fmt::format("taps that it allows are off the whole kernel by, root mean square over the edge: {}; counts in "
                  "between stand for the next lower one",
                  fmt::join(parts, ", "))};
}

Case make_case(const StressContext& context, const TapsFilter& filter, Level level) {
  const filters::FilterRequest& request = filter.request;
  const std::string variant =
      fmt::format("{} at radius {:g}", filter.find_param().name, filters::radius_texels(request.spec, request.values));
  const auto [probe, reason] = make_probe(context, request, level);
  if (!probe || !filters::make_model(request.spec.id)) {
    return make_absent_case(request.spec.id, variant, level,
                            probe ? "the filter has no scalar model to be held against" : reason);
  }
  Case item = start_case(request, variant, level);
  item.params.erase(filter.find_param().name);
  item.theories = {{std::nullopt, TheoryKind::kRounding, "none: more taps add more numbers, none of them above 1",
                    "derived: a mean of n numbers is off by n unit round-offs of the largest at most",
                    Verdict::kDegraded}};
  item.explain = explain_broken_throughout;
  item.observe = [&context, filter, level](double taps) { return observe_taps(context, filter, taps, level); };
  if (level == Level::kModel)
    item.remark = [&context, filter](const records::StressCase& record) {
      return remark_noise(context, filter, record);
    };
  return item;
}

std::vector<Case> make_cases(const StressContext& context) {
  std::vector<Case> cases;
  for (const TapsFilter& filter : find_taps_filters(context))
    for (const Level level : {Level::kGl, Level::kModel}) cases.push_back(make_case(context, filter, level));
  if (cases.empty())
    cases.push_back(make_absent_case({}, "any", Level::kGl, "no chosen filter takes a number of taps"));
  return cases;
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
  axis.bound = kBound;
  axis.broken_when = "visibility is not finite, all lit or all dark where it should not be";
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
