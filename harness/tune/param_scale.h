#pragma once

#include <string>

#include "harness/scene/lights/light_fit.h"

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

}  // namespace shadowbench::tune
