#include "harness/stress/case_tools.h"

#include <fmt/format.h>

#include <algorithm>

#include "filters/model.h"

namespace shadowbench::stress {

std::string find_exponent(const filters::FilterSpec& spec) {
  return spec.holds_moments ? std::string() : spec.exponent;
}

std::vector<std::string> list_choices(const filters::FilterRequest& request, const std::string& param) {
  const filters::ParamSpec* spec = request.spec.find_param(param);
  if (!spec) return {};
  if (request.set_by_user.contains(param)) return {filters::to_string(request.values.at(param))};
  std::vector<std::string> choices;
  for (const filters::ParamValue& choice : spec->choices) choices.push_back(filters::to_string(choice));
  return choices;
}

Case start_case(const AxisInputs& inputs, const filters::FilterRequest& request, std::string variant, Level level) {
  Case item{.filter = request.spec.id, .variant = std::move(variant), .level = level};
  if (level == Level::kGl && !inputs.renderer)
    item.not_available = "there is no GL";
  else if (!filters::make_model(request.spec))
    item.not_available = filters::kNoModel;
  else
    item.params = request.values;
  return item;
}

Observation judge_by_bounds(double measured, double degraded_over, double broken_over,
                            const std::function<std::string(double bound)>& describe) {
  if (measured > broken_over) return {Verdict::kBroken, measured, describe(broken_over)};
  if (measured > degraded_over) return {Verdict::kDegraded, measured, describe(degraded_over)};
  return {Verdict::kOk, measured, {}};
}

double find_largest_measured(const records::StressCase& record) {
  double largest = 0.0;
  for (const records::StressSample& sample : record.samples) largest = std::max(largest, sample.measured.value_or(0.0));
  return largest;
}

std::string explain_broken_throughout(const Disagreement& missed) {
  const bool throughout = std::ranges::all_of(
      missed.record.samples, [](const records::StressSample& sample) { return sample.verdict == Verdict::kBroken; });
  if (!throughout || !missed.record.broken) return {};
  return fmt::format("with the chosen parameters it is broken at every value ({}), which is not this axis' doing",
                     missed.record.broken->why);
}

}  // namespace shadowbench::stress
