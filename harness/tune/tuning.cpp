#include "harness/tune/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <map>
#include <nlopt.hpp>
#include <set>

namespace shadowbench::tune {
namespace {

constexpr double kRatioForLog = 100.0;         // two decades
constexpr double kRatioForLogFromZero = 10.0;  // of the largest value to the default

double round_to_digits(double value) { return std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr); }

constexpr double kGlobalShare = 0.6;    // of the budget
constexpr double kFirstStep = 0.1;      // of Subplex, on the scaled range
constexpr double kSmallestStep = 1e-3;  // likewise
constexpr int kRepeatsPerSetting = 50;  // places that round to known settings cost nothing, but must not go on for ever
constexpr int kRangeRounds = 3;
constexpr double kWorthAnotherRound = 0.01;  // relative
constexpr int kScanSteps = 16;
constexpr double kFinestStep = 1.0 / 256.0;  // of the scaled range
constexpr double kSameError = 1e-9;          // relative

/// Draws settings, each once: settings that round to the same values are one.
class SettingsDrawn {
 public:
  SettingsDrawn(const Objective& objective, const std::function<void(const Evaluation&)>& on_evaluation)
      : objective_(objective), on_evaluation_(on_evaluation) {}

  double error(const std::vector<double>& values, const char* stage) {
    const auto found = errors_.find(values);
    if (found != errors_.end()) return found->second;
    const double error = objective_(values);
    errors_.emplace(values, error);
    if (best_.empty() || error < best_error_) {
      best_ = values;
      best_error_ = error;
    }
    if (on_evaluation_) on_evaluation_({count(), stage, values, error});
    return error;
  }

  bool knows(const std::vector<double>& values) const { return errors_.contains(values); }
  int count() const { return static_cast<int>(errors_.size()); }
  const std::vector<double>& best() const { return best_; }
  double best_error() const { return best_error_; }

 private:
  const Objective& objective_;
  const std::function<void(const Evaluation&)>& on_evaluation_;
  std::map<std::vector<double>, double> errors_;
  std::vector<double> best_;
  double best_error_ = 0.0;
};

std::vector<double> list_defaults(const std::vector<ParamScale>& params) {
  std::vector<double> defaults;
  for (const ParamScale& scale : params) defaults.push_back(scale.param().default_value);
  return defaults;
}

/// One search. NLopt calls it back.
class Search {
 public:
  Search(const std::vector<ParamScale>& params, const SearchSettings& settings, SettingsDrawn& drawn)
      : params_(params), settings_(settings), drawn_(drawn) {}

  void run() {
    drawn_.error(list_defaults(params_), "default");
    run_stage(nlopt::GN_DIRECT_L, "global", std::max(1, static_cast<int>(kGlobalShare * settings_.budget)));
    run_stage(nlopt::LN_SBPLX, "local", settings_.budget);
  }

 private:
  const std::vector<ParamScale>& params_;
  const SearchSettings& settings_;
  SettingsDrawn& drawn_;
  const char* stage_ = "";
  int limit_ = 0;  ///< settings drawn at the end of the stage
  std::exception_ptr failure_;

  std::vector<double> to_values(const std::vector<double>& units) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < units.size(); ++i) values.push_back(params_[i].to_value(units[i]));
    return values;
  }

  std::vector<double> to_units(const std::vector<double>& values) const {
    std::vector<double> units;
    for (std::size_t i = 0; i < values.size(); ++i)
      units.push_back(std::clamp(params_[i].to_unit(values[i]), 0.0, 1.0));
    return units;
  }

  double evaluate(const std::vector<double>& units) {
    const std::vector<double> values = to_values(units);
    if (!drawn_.knows(values) && drawn_.count() >= limit_) throw nlopt::forced_stop();
    try {
      return drawn_.error(values, stage_);
    } catch (...) {
      failure_ = std::current_exception();  // NLopt passes on none but its own
      throw nlopt::forced_stop();
    }
  }

  static double call(const std::vector<double>& units, std::vector<double>&, void* search) {
    return static_cast<Search*>(search)->evaluate(units);
  }

  void run_stage(nlopt::algorithm algorithm, const char* stage, int limit) {
    if (drawn_.count() >= limit) return;
    stage_ = stage;
    limit_ = limit;
    nlopt::opt optimiser(algorithm, static_cast<unsigned>(params_.size()));
    optimiser.set_lower_bounds(0.0);
    optimiser.set_upper_bounds(1.0);
    optimiser.set_min_objective(&Search::call, this);
    optimiser.set_maxeval(kRepeatsPerSetting * settings_.budget);
    optimiser.set_xtol_abs(kSmallestStep);
    optimiser.set_initial_step(kFirstStep);
    std::vector<double> units = to_units(drawn_.best());
    double error = 0.0;
    try {
      optimiser.optimize(units, error);
    } catch (const nlopt::forced_stop&) {
    } catch (const nlopt::roundoff_limited&) {
      // As near as rounding allows.
    }
    if (failure_) std::rethrow_exception(failure_);
  }
};

/// Scans one parameter, the others at `best`, at 17 places evenly over its scale (an integer with fewer values: at all
/// of them) and bisects between good and bad neighbours to 1/256 of the scale, or to neighbouring integers. What is
/// narrower than 1/16 of the scale, and does not hold the best, may be missed.
class RangeScan {
 public:
  RangeScan(const std::vector<ParamScale>& params, std::size_t which, const std::vector<double>& best, double tolerance,
            SettingsDrawn& drawn)
      : scale_(params[which]),
        which_(which),
        best_(best),
        drawn_(drawn),
        best_error_(drawn.error(best, "range")),
        limit_(best_error_ * (1.0 + tolerance)) {}

  GoodRange run() {
    const std::vector<double> values = list_values();
    GoodRange range;
    range.no_effect = std::all_of(values.begin(), values.end(), [&](double value) {
      return std::abs(error(value) - best_error_) <= kSameError * std::max(std::abs(best_error_), kSameError);
    });
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!is_good(values[i])) continue;
      if (i == 0 || !is_good(values[i - 1]))
        range.intervals.push_back({i == 0 ? values[i] : find_edge(values[i], values[i - 1]), values[i]});
      const bool ends = i + 1 == values.size() || !is_good(values[i + 1]);
      if (ends) range.intervals.back().high = i + 1 == values.size() ? values[i] : find_edge(values[i], values[i + 1]);
    }
    for (const records::Interval& interval : range.intervals)
      range.share += scale_.measure_share(interval.low, interval.high);
    return range;
  }

 private:
  const ParamScale& scale_;
  std::size_t which_;
  std::vector<double> best_;
  SettingsDrawn& drawn_;
  double best_error_;
  double limit_;

  double error(double value) {
    std::vector<double> values = best_;
    values[which_] = value;
    return drawn_.error(values, "range");
  }

  bool is_good(double value) { return error(value) <= limit_; }

  /// Values to scan, ascending: the best one's own among them.
  std::vector<double> list_values() const {
    const SearchedParam& param = scale_.param();
    std::set<double> values = {best_[which_]};
    if (param.integer && param.max - param.min <= kScanSteps)
      for (double value = param.min; value <= param.max; value += 1.0) values.insert(value);
    else
      for (int step = 0; step <= kScanSteps; ++step)
        values.insert(scale_.to_value(static_cast<double>(step) / kScanSteps));
    return {values.begin(), values.end()};
  }

  /// The last good value on the way from a good to a bad one.
  double find_edge(double good, double bad) {
    for (;;) {
      const double unit_good = scale_.to_unit(good), unit_bad = scale_.to_unit(bad);
      const bool whole = scale_.param().integer;
      if (whole ? std::abs(good - bad) <= 1.0 : std::abs(unit_good - unit_bad) <= kFinestStep) return good;
      const double middle = whole ? std::floor(0.5 * (good + bad)) : scale_.to_value(0.5 * (unit_good + unit_bad));
      if (middle == good || middle == bad) return good;  // rounding leaves nothing between
      (is_good(middle) ? good : bad) = middle;
    }
  }
};

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

SearchResult search_parameters(const std::vector<ParamScale>& params, const SearchSettings& settings,
                               const Objective& objective) {
  assert(!params.empty() && settings.budget >= 1);
  SearchResult result;
  SettingsDrawn drawn(objective, settings.on_evaluation);
  Search(params, settings, drawn).run();
  result.search_evaluations = drawn.count();
  const auto found_better = [&] { return drawn.best_error() < result.best_error * (1.0 - kWorthAnotherRound); };
  for (int round = 0; round == 0 || (round < kRangeRounds && found_better()); ++round) {
    result.best = drawn.best();
    result.best_error = drawn.best_error();
    result.ranges.clear();
    for (std::size_t i = 0; i < params.size(); ++i)
      result.ranges.push_back(RangeScan(params, i, result.best, settings.tolerance, drawn).run());
  }
  result.default_error = drawn.error(list_defaults(params), "range");
  result.evaluations = drawn.count();
  return result;
}

}  // namespace shadowbench::tune
