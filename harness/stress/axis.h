#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/stress/axis_inputs.h"
#include "harness/stress/verdict.h"

namespace shadowbench::stress {

using Range = records::StressRange;
using Exhibit = records::StressExhibit;
using TheoryKind = records::StressTheoryKind;

/// How an axis is sampled, and how values are drawn.
enum class Scale { kLinear, kLog };

/// From which end of the range the first change of a verdict is looked for.
enum class SearchFrom { kLow, kHigh };

/// What a case runs on.
enum class Level {
  kGl,         ///< the passes of harness/render
  kModel,      ///< the filter's scalar model
  kArithmetic  ///< the axis' own few lines, in the precision that is tested
};

/// A limit that is known before anything is measured.
struct Theory {
  std::optional<double> onset;  ///< value of the axis; empty: theory says that there is none
  TheoryKind kind = TheoryKind::kOverflow;
  std::string formula;                  ///< with its numbers: "ln(65504) / 1 = 11.09"
  std::string source;                   ///< author, year, title, equation; or "derived"
  Verdict predicts = Verdict::kBroken;  ///< the verdict that the case reaches at `onset`
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
  /// What else a record shows, where its numbers bear that out; printed with the axis. May be null.
  std::function<std::vector<std::string>(const records::StressCase&)> remark = {};
  /// Null where `not_available` gives a reason. A case whose first value throws Error is not available; a later value
  /// that throws is broken.
  std::function<Observation(double)> observe = {};
  std::string not_available = {};

  bool is_available() const { return not_available.empty(); }
};

/// One way to drive filters to where their numbers break. Each lives in axes/<id>.cpp as `Axis make_<id>_axis()`, where
/// '-' in the id is written '_'. CMake finds it there.
struct Axis {
  std::string id;  ///< the file's name; axis_table() sets it
  std::string title;
  std::string quantity;  ///< "exponent c"
  std::string unit;      ///< empty: a pure number
  Scale scale = Scale::kLog;
  Range range;   ///< by default
  Range limits;  ///< the widest that --range may ask for
  int coarse_samples = 25;
  bool whole = false;  ///< values are whole numbers
  SearchFrom from = SearchFrom::kLow;

  std::string measured;       ///< what observations measure: "largest error of visibility"
  std::string measured_unit;  ///< empty: a pure number
  Scale measured_scale = Scale::kLog;
  double bound = 0.0;       ///< a measured value above it is `degraded`
  std::string broken_when;  ///< in words: "infinities in the map; NaN, all lit or all dark"

  DrivenParam driven_param = nullptr;  ///< of an axis that drives a parameter of filters; else null
  std::function<std::vector<Case>(const AxisInputs&)> make_cases;
  std::function<std::vector<Exhibit>(const AxisInputs&)> make_exhibits;  ///< its own tables and pictures; may be null
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

}  // namespace shadowbench::stress
