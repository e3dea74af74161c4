#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// The bound of several axes on an error of visibility: five steps of an 8-bit picture.
inline constexpr double kVisibleError = 0.02;

/// What a case is held against.
enum class Reference {
  kNone,  ///< truth by construction
  kModel  ///< the filter's scalar model
};

/// Starts a case of a filter, which has nothing to observe yet. The case is not available where its level needs a GL
/// that is not there, or where level or reference need a scalar model that the filter does not have.
Case start_case(const AxisInputs& inputs, const filters::FilterRequest& request, std::string variant, Level level,
                Reference reference = Reference::kNone);

/// Makes the only case of an axis that none of the chosen filters suits.
Case make_absent_case(std::string reason);

/// Makes cases of every chosen filter by the GL.
template <class MakeCase>
std::vector<Case> make_gl_cases(const AxisInputs& inputs, MakeCase make_case) {
  std::vector<Case> cases;
  for (const filters::FilterRequest& request : inputs.filters) cases.push_back(make_case(inputs, request));
  return cases;
}

/// Makes cases of every chosen filter by the GL and by the model, for each setting that `list_settings(request)` gives.
/// Where there is no setting at all, a case says why: `none`.
template <class ListSettings, class MakeCase>
std::vector<Case> make_filter_cases(const AxisInputs& inputs, ListSettings list_settings, MakeCase make_case,
                                    const char* none) {
  std::vector<Case> cases;
  for (const filters::FilterRequest& request : inputs.filters)
    for (const auto& setting : list_settings(request))
      for (const Level level : {Level::kGl, Level::kModel}) cases.push_back(make_case(inputs, request, setting, level));
  if (cases.empty()) cases.push_back(make_absent_case(none));
  return cases;
}

/// Appends the cases of `more`.
void append(std::vector<Case>& cases, std::vector<Case> more);

/// Judges a measured value: degraded over one bound, broken over another; `describe` says why, given that bound.
Observation judge_by_bounds(double measured, double degraded_over, double broken_over,
                            const std::function<std::string(double bound)>& describe);

/// The largest value that a case measured; 0 where it measured none.
double find_largest_measured(const records::StressCase& record);

/// Whether a case was observed, and was ok at every value.
bool is_ok_throughout(const records::StressCase& record);

/// Explains a theory that is not met because the case is broken over the whole range, whatever the axis' value: a map
/// that overflows with the chosen parameters, for instance. Empty where that is not so.
std::string explain_broken_throughout(const Disagreement& missed);

}  // namespace shadowbench::stress
