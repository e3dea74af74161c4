#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "reference/metrics/error_stats.h"

namespace shadowbench::tune {

/// What a tuned number is made from.
enum class TuneMetricKind { kStatistic, kFlip, kAcne, kLeak };

/// A number that tuning can make small: of [0,1], 0 at best.
struct TuneMetric {
  std::string_view name;  ///< as `list metrics` has it, without its group
  TuneMetricKind kind = TuneMetricKind::kStatistic;
  double metrics::ErrorStats::*statistic =
      nullptr;  ///< of kStatistic, which are in units of visibility, as the truth's standard error
};

/// Finds a metric. Throws Error(kUsage), with those there are, where there is none of that name.
const TuneMetric& find_tune_metric(const std::string& name);

/// Names all metrics, in the order to show them.
std::vector<std::string> list_tune_metrics();

}  // namespace shadowbench::tune
