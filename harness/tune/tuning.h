#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/scene/lights/light_fit.h"
#include "report/records/records.h"

namespace shadowbench::tune {

/// One number that is searched.
struct SearchedParam {
  std::string name;
  double min = 0.0;  ///< inclusive
  double max = 1.0;  ///< inclusive
  double default_value = 0.0;
  bool integer = false;
  std::string unit = {};
  double scene::CascadeRule::*of_fit = nullptr;  ///< the member of a fit that it is, in place of a filter's parameter
};

/// Lays a parameter's range on [0,1], so that a step means as much anywhere:
/// logarithmic where min > 0 and max / min >= 100;
/// log(1 + x / floor), floor = default^2 / max, where min = 0 < default and max / default >= 10: the default lies in
/// the middle, values far below it at 0; linear elsewhere.
class ParamScale {
 public:
  explicit ParamScale(SearchedParam param);

  const SearchedParam& param() const { return param_; }

  /// The value at a place in [0,1]: whole for integers, else rounded to four significant digits, within the
  /// range.
  double to_value(double unit) const;

  /// The place of a value within the range.
  double to_unit(double value) const;

  /// The part of [0,1] that values from `low` to `high` take; an integer reaches half a step to both sides.
  double measure_share(double low, double high) const;

  /// Names the scale: "linear", "log", "log above 1e-09".
  std::string name() const;

 private:
  enum class Kind { kLinear, kLog, kLogAboveFloor };

  SearchedParam param_;
  Kind kind_ = Kind::kLinear;
  double floor_ = 0.0;

  double expand(double unit) const;
};

/// The error of a setting: one value per parameter, in their order. Lower is better; must be finite.
using Objective = std::function<double(const std::vector<double>& values)>;

/// One setting that was drawn.
struct Evaluation {
  int number = 0;     ///< from 1
  std::string stage;  ///< "default", "global", "local" or "range"
  std::vector<double> values;
  double error = 0.0;
};

/// Where one parameter may lie, the others at their best, for the error to stay near the best.
struct GoodRange {
  std::vector<records::Interval> intervals;  ///< ascending; more than one where the range has holes
  double share = 0.0;                        ///< of the scaled range that they take, [0,1]
  bool no_effect = false;                    ///< the error is the same all over the range
};

struct SearchSettings {
  int budget = 80;         ///< settings that the search draws, the default included; the good ranges come on top
  double tolerance = 0.1;  ///< good: an error of at most (1 + tolerance) times the best
  std::function<void(const Evaluation&)> on_evaluation = {};  ///< hears of every setting drawn
};

struct SearchResult {
  std::vector<double> best;
  double best_error = 0.0;
  double default_error = 0.0;
  std::vector<GoodRange> ranges;  ///< one per parameter
  int search_evaluations = 0;     ///< at most the budget
  int evaluations = 0;            ///< those of the good ranges included
};

/// Finds the values that make the objective least. First the default is drawn, then, on scaled parameters (ParamScale),
/// DIRECT-L over the whole range with up to 60 % of the budget, then Subplex from the best with the rest, both from
/// NLopt. Deterministic. The result is never worse than the default. Last come the good ranges;
/// where they find something better than the best by more than 1 %, that becomes the best, and they are looked for
/// anew, at most twice. Requires at least one parameter and a budget of 1 or more. Throws what the objective throws.
/// Source: Gablonsky and Kelley 2001, A Locally-Biased Form of the DIRECT Algorithm, J. Global Optimization 21; Rowan
/// 1990, Functional Stability Analysis of Numerical Algorithms (Subplex).
SearchResult search_parameters(const std::vector<ParamScale>& params, const SearchSettings& settings,
                               const Objective& objective);

}  // namespace shadowbench::tune
