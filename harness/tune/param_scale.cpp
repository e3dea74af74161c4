#include "harness/tune/param_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace shadowbench::tune {
namespace {

constexpr double kRatioForLog = 100.0;         // two decades
constexpr double kRatioForLogFromZero = 10.0;  // of the largest value to the default

double round_to_digits(double value) { return std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr); }

}  // namespace

ParamScale::ParamScale(SearchedParam param) : param_(std::move(param)) {
  assert(param_.min < param_.max);
  if (param_.min > 0.0 && param_.max / param_.min >= kRatioForLog) kind_ = Kind::kLog;
  if (param_.min != 0.0 || !(param_.default_value > 0.0)) return;
  if (param_.max / param_.default_value < kRatioForLogFromZero) return;
  kind_ = Kind::kLogAboveFloor;
  floor_ = param_.default_value * param_.default_value / param_.max;
}

double ParamScale::expand(double unit) const {
  switch (kind_) {
    case Kind::kLinear: return param_.min + unit * (param_.max - param_.min);
    case Kind::kLog: return param_.min * std::pow(param_.max / param_.min, unit);
    case Kind::kLogAboveFloor: return floor_ * std::expm1(unit * std::log1p(param_.max / floor_));
  }
  return param_.min;
}

double ParamScale::to_value(double unit) const {
  const double value = expand(std::clamp(unit, 0.0, 1.0));
  return std::clamp(param_.integer ? std::round(value) : round_to_digits(value), param_.min, param_.max);
}

double ParamScale::to_unit(double value) const {
  switch (kind_) {
    case Kind::kLinear: return (value - param_.min) / (param_.max - param_.min);
    case Kind::kLog: return std::log(value / param_.min) / std::log(param_.max / param_.min);
    case Kind::kLogAboveFloor: return std::log1p(value / floor_) / std::log1p(param_.max / floor_);
  }
  return 0.0;
}

double ParamScale::measure_share(double low, double high) const {
  const double reach = param_.integer ? 0.5 : 0.0;
  return to_unit(std::min(high + reach, param_.max)) - to_unit(std::max(low - reach, param_.min));
}

std::string ParamScale::name() const {
  if (kind_ == Kind::kLinear) return "linear";
  return kind_ == Kind::kLog ? "log" : fmt::format("log above {:.2g}", floor_);
}

}  // namespace shadowbench::tune
