#pragma once

#include <string>
#include <utility>
#include <vector>

namespace shadowbench::document {

/// An axis: its ends, its ticks, and whether steps are ratios.
struct ChartAxis {
  bool log = false;
  double low = 0.0;
  double high = 1.0;
  std::vector<std::pair<double, std::string>> ticks;  ///< ascending, within the ends
};

/// What the ticks stand for.
enum class TickKind { kNumber, kBytes };

/// Chooses an axis that holds all values with a margin: logarithmic where all are positive and span a factor of 3 or
/// more, otherwise linear, from 0 where the values reach near it. Ends that are not positive do not keep an axis from
/// being logarithmic where `ends` is what they are in: pass values as `values` and interval ends as `ends`.
ChartAxis choose_axis(const std::vector<double>& values, const std::vector<double>& ends, TickKind kind);

/// Does the same, but keeps to a logarithmic axis for positive values that lie close together too.
ChartAxis choose_log_axis(const std::vector<double>& values, const std::vector<double>& ends);

}  // namespace shadowbench::document
