#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "harness/stress/axis.h"

namespace shadowbench::stress {

/// The bound of several axes on an error of visibility: five steps of an 8-bit picture.
inline constexpr double kVisibleError = 0.02;

/// Names the exponent of a filter that stores exponentials and no moments of them.
std::string find_exponent(const filters::FilterSpec& spec);

/// Lists the values of a filter's text parameter, such as `store`, that get a case each: the chosen value alone where
/// the user set it, all otherwise; none where the filter has no such parameter.
std::vector<std::string> list_choices(const filters::FilterRequest& request, const std::string& param);

/// Starts a case of a filter, which has nothing to observe yet. The case is not available where the filter has no
/// scalar model to be held against, and where its level needs a GL that is not there.
Case start_case(const AxisInputs& inputs, const filters::FilterRequest& request, std::string variant, Level level);

/// Makes cases of every chosen filter by the GL.
template <class MakeCase>
std::vector<Case> make_gl_cases(const AxisInputs& inputs, MakeCase make_case) {
  std::vector<Case> cases;
  for (const filters::FilterRequest& request : inputs.filters) cases.push_back(make_case(inputs, request));
  return cases;
}

/// Makes cases of every chosen filter at every level, for each setting that `list_settings(request)` gives. Where there
/// is no setting at all, a case says why: `none`.
template <class ListSettings, class MakeCase>
std::vector<Case> make_filter_cases(const AxisInputs& inputs, ListSettings list_settings, MakeCase make_case,
                                    const char* none,
                                    std::initializer_list<Level> levels = {Level::kGl, Level::kModel}) {
  std::vector<Case> cases;
  for (const filters::FilterRequest& request : inputs.filters)
    for (const auto& setting : list_settings(request))
      for (const Level level : levels) cases.push_back(make_case(inputs, request, setting, level));
  if (cases.empty()) cases.push_back({.variant = "filters", .not_available = none});
  return cases;
}

/// Judges a measured value: degraded over one bound, broken over another; `describe` says why, given that bound.
Observation judge_by_bounds(double measured, double degraded_over, double broken_over,
                            const std::function<std::string(double bound)>& describe);

/// The largest value that a case measured; 0 where it measured none.
double find_largest_measured(const records::StressCase& record);

/// Explains a theory that is not met because the case is broken over the whole range, whatever the axis' value: a map
/// that overflows with the chosen parameters, for instance. Empty where that is not so.
std::string explain_broken_throughout(const Disagreement& missed);

}  // namespace shadowbench::stress
