#include "harness/stress/case_tools.h"

#include <fmt/format.h>

#include <algorithm>

#include "filters/model.h"

namespace shadowbench::stress {
namespace {

/// What a case lacks; empty where it has everything.
std::string explain_absence(const AxisInputs& inputs, const filters::FilterRequest& request, Level level,
                            Reference reference) {
  const bool has_model = filters::make_model(request.spec) != nullptr;
  if (level == Level::kGl && !inputs.renderer) return "there is no GL";
  if (level == Level::kModel && !has_model) return "the filter has no scalar model";
  return reference == Reference::kModel && !has_model ? "the filter has no scalar model to be held against" : "";
}

}  // namespace

Case start_case(const AxisInputs& inputs, const filters::FilterRequest& request, std::string variant, Level level,
                Reference reference) {
  Case item{.filter = request.spec.id, .variant = std::move(variant), .level = level};
  item.not_available = explain_absence(inputs, request, level, reference);
  if (item.is_available()) item.params = request.values;
  return item;
}

Case make_absent_case(std::string reason) { return {.variant = "filters", .not_available = std::move(reason)}; }

void append(std::vector<Case>& cases, std::vector<Case> more) { std::ranges::move(more, std::back_inserter(cases)); }

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

bool is_ok_throughout(const records::StressCase& record) {
  return !record.degraded && !record.broken && !record.samples.empty();
}

std::string explain_broken_throughout(const Disagreement& missed) {
  const bool throughout = std::ranges::all_of(
      missed.record.samples, [](const records::StressSample& sample) { return sample.verdict == Verdict::kBroken; });
  if (!throughout || !missed.record.broken) return {};
  return fmt::format("with the chosen parameters it is broken at every value ({}), which is not this axis' doing",
                     missed.record.broken->why);
}

}  // namespace shadowbench::stress
