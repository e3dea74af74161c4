#include <algorithm>
#include <cmath>
#include <set>

#include "harness/tune/tuning.h"

namespace shadowbench::tune {
namespace {

constexpr int kScanSteps = 16;
constexpr double kFinestStep = 1.0 / 256.0;  // of the scaled range
constexpr double kSameError = 1e-9;          // relative

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
    for (const ValueInterval& interval : range.intervals)
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

GoodRange find_good_range(const std::vector<ParamScale>& params, std::size_t which, const std::vector<double>& best,
                          double tolerance, SettingsDrawn& drawn) {
  return RangeScan(params, which, best, tolerance, drawn).run();
}

}  // namespace shadowbench::tune
