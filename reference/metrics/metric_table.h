#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reference/metrics/error_stats.h"

namespace shadowbench::metrics {

/// Says what a number is measured from.
enum class MetricSource {
  kRun,       ///< a scene, its rays and models: `shadowbench run` alone has them
  kValues,    ///< the values of two pictures, pixel by pixel: measure_error()
  kPictures,  ///< two whole pictures: measure_flip()
};

/// Holds the least and largest value that a number can have; empty: there is none.
struct MetricRange {
  std::optional<double> min;
  std::optional<double> max;
};

/// Describes one number of a cell's `error`, `truth`, `artefact` and `attribution` groups.
struct Metric {
  std::string_view path;  ///< in a cell's record: "error.rmse", "attribution.numeric.share"
  std::string_view unit;
  MetricRange range;
  MetricSource source = MetricSource::kRun;
  double ErrorStats::*statistic = nullptr;  ///< where measure_error() puts it; null for other sources
  std::string_view definition;

  /// The path without its group: "rmse", "numeric.share".
  std::string_view name() const { return path.substr(path.find('.') + 1); }
};

/// Gives every number of those groups, in the order of the record: the one list of metrics that there is.
std::span<const Metric> metric_table();

/// Gives the metrics that two pictures are enough for, in the order of the table.
std::vector<Metric> picture_metrics();

}  // namespace shadowbench::metrics
