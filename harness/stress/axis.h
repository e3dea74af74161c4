#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/gl/context/context.h"
#include "harness/measure/scene_assets.h"
#include "harness/options/options.h"
#include "report/records/stress_record.h"

namespace shadowbench::stress {

using Theory = records::StressTheory;
using TheoryKind = records::StressTheoryKind;
using Verdict = records::StressVerdict;

/// What axes make their cases from. It outlives all cases.
struct AxisInputs {
  measure::Renderer* renderer = nullptr;  ///< null: there is no GL, and cases that need one are not available
  options::Resources resources;
  std::vector<filters::FilterRequest> filters;  ///< the chosen ones, each with its parameter values
  std::uint32_t seed = 1;
};

/// Names the parameter of a filter that an axis drives, from what the front matter declares; empty: it has none.
using DrivenParam = std::string (*)(const filters::FilterSpec&);

/// From which end of the range the first change of a verdict is looked for.
enum class SearchFrom { kLow, kHigh };

/// What a case runs on.
enum class Level {
  kGl,         ///< the passes of harness/render
  kModel,      ///< the filter's scalar model
  kArithmetic  ///< the axis' own few lines, in the precision that is tested
};

/// What a case saw at one value of its axis.
struct Observation {
  Verdict verdict = Verdict::kOk;
  std::optional<double> measured;  ///< what the axis says it measures; empty where it is not finite
  std::string why;                 ///< what decided the verdict, in words with the number; empty for kOk
};

/// A theory, and the first value at which the verdict that it predicts was observed.
struct Disagreement {
  const Theory& theory;
  std::optional<double> measured;     ///< empty: nowhere in the range
  const records::StressCase& record;  ///< everything that was observed
};

/// One filter in one variant on an axis.
struct Case {
  std::string filter = {};   ///< id; empty: arithmetic that no filter has yet
  std::string variant = {};  ///< "r16f, linear"
  Level level = Level::kGl;
  filters::ParamValues params = {};
  std::vector<double> values = {};    ///< the only ones of the axis that it can take, ascending; empty: all
  std::vector<Theory> theories = {};  ///< none: no limit is known
  /// Explains from what was measured why a theory is not met; empty where no known reason applies. May be null.
  std::function<std::string(const Disagreement&)> explain = {};
  /// Null where `not_available` gives a reason. A case whose first value throws Error is not available; a later value
  /// that throws is broken.
  std::function<Observation(double)> observe = {};
  std::string not_available = {};

  bool is_available() const { return not_available.empty(); }
};

/// One way to drive filters to where their numbers break. Each lives in axes/<id>.cpp as `Axis make_<id>_axis()`, where
/// '-' in the id is written '_'. CMake finds it there, and axis_table() sets the id.
struct Axis : records::StressAxisText {
  records::StressRange limits;  ///< the widest that --range may ask for
  int coarse_samples = 25;
  bool whole = false;  ///< values are whole numbers
  SearchFrom from = SearchFrom::kLow;

  DrivenParam driven_param = nullptr;  ///< of an axis that drives a parameter of filters; else null
  std::function<std::vector<Case>(const AxisInputs&)> make_cases;
};

/// Names a level: "GL", "model", "arithmetic".
const char* name_of(Level level);

/// Gives all axes, by id.
const std::vector<Axis>& axis_table();

/// The axes of a comma-separated list, in that order; all for an empty text.
/// Throws Error(kUsage) for an unknown one, with the nearest id, and for one that is named twice.
std::vector<Axis> choose_axes(const std::string& text);

/// Sets the range of one of `axes` from AXIS=LO,HI.
/// Throws Error(kUsage) where the text is not that, the axis is unknown or not among `axes`, an end is not a finite
/// number, the range is empty or reversed, or it reaches beyond the axis' limits.
void apply_range(std::vector<Axis>& axes, const std::string& text);

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

/// Relative width to which the first change of a verdict is found.
inline constexpr double kOnsetPrecision = 0.01;

/// Observes a case over an axis: coarse samples over the range, then bisection between the neighbours where the verdict
/// is first degraded, and first broken, to kOnsetPrecision of the value (whole numbers: to 1). Verdicts that get better
/// again later are noted. Returns the case's record without its limits; not available where the first observation
/// throws Error.
records::StressCase find_onsets(const Case& item, const Axis& axis);

/// Compares a case's onsets with its theories: agreement within the tolerance of the theory's kind, or an explanation.
/// A theory beyond the range agrees where nothing was met in it, one before the range where the range begins with what
/// it predicts, and one that says that there is none where there is none.
std::vector<records::StressLimit> compare(const Case& item, const records::StressCase& record, const Axis& axis);

/// The options of `shadowbench stress`.
struct StressOptions {
  options::Resources resources;
  std::vector<filters::FilterRequest> filters;
  std::string axes;                 ///< comma-separated ids; empty: all
  std::vector<std::string> ranges;  ///< AXIS=LO,HI
  gl::Backend backend = gl::Backend::kAuto;
  std::uint32_t seed = 1;
  std::filesystem::path out;
  bool force = false;                ///< as in options::RunOptions
  std::vector<std::string> command;  ///< the command line, for the record
};

/// The outcome of all axes.
struct StressOutcome {
  std::string text;       ///< the table of limits, for a terminal
  int disagreements = 0;  ///< limits that are not what theory says, with no explanation
};

/// Drives the chosen filters along the chosen axes and writes stress.html, .md, .json and .csv.
/// Bad axes and ranges are found before anything is made. Cost: about a second per axis and filter in software.
/// Throws Error(kUsage) as choose_axes and apply_range, Error(kContext), Error(kOutput).
StressOutcome run_stress(const StressOptions& options, options::Progress& progress);

/// Lists the axes with range, bound and filters that name them, for people.
std::string describe_axes(const std::vector<filters::FilterRequest>& filters);

}  // namespace shadowbench::stress
