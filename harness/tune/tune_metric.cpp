#include "harness/tune/tune_metric.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "filters/base/error.h"

namespace shadowbench::tune {
namespace {

using metrics::ErrorStats;

constexpr TuneMetric kMetrics[] = {
    {"rmse", TuneMetricKind::kStatistic, &ErrorStats::rmse},
    {"mae", TuneMetricKind::kStatistic, &ErrorStats::mae},
    {"p95", TuneMetricKind::kStatistic, &ErrorStats::p95},
    {"flip", TuneMetricKind::kFlip, nullptr},
    {"leak", TuneMetricKind::kLeak, nullptr},
    {"acne", TuneMetricKind::kAcne, nullptr},
};

}  // namespace

const TuneMetric& find_tune_metric(const std::string& name) {
  for (const TuneMetric& metric : kMetrics)
    if (metric.name == name) return metric;
  throw Error(ErrorKind::kUsage, fmt::format("--metric: nothing is tuned for '{}'; choose {}", name,
                                             fmt::join(list_tune_metrics(), ", ")));
}

std::vector<std::string> list_tune_metrics() {
  std::vector<std::string> names;
  for (const TuneMetric& metric : kMetrics) names.emplace_back(metric.name);
  return names;
}

}  // namespace shadowbench::tune
