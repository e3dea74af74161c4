#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>

#include "reference/metrics/metric_table.h"

namespace shadowbench::metrics {

std::optional<double> Metric::read(const MetricValues& values) const {
  std::optional<double> number;
  visit_metric(*this, values, [&](const std::string&, const auto& value) {
    if (value) number = static_cast<double>(*value);
  });
  return number;
}

std::span<const Metric> metric_table() {
  static const std::vector<Metric> table = list_metric_rows();
  return table;
}

const Metric& find_metric(std::string_view path) {
  const auto found = std::ranges::find(metric_table(), path, &Metric::path);
  assert(found != metric_table().end());
  return *found;
}

std::vector<Metric> picture_metrics() {
  std::vector<Metric> metrics;
  std::ranges::copy_if(metric_table(), std::back_inserter(metrics),
                       [](const Metric& metric) { return metric.source != MetricSource::kRun; });
  return metrics;
}

std::string_view describe_direction(MetricDirection direction) {
  constexpr std::string_view kTexts[] = {"less is better", "more is better", "0 is best",
                                         "neither less nor more is better"};
  return kTexts[static_cast<std::size_t>(direction)];
}

std::string describe_range(const MetricRange& range) {
  if (range.min && range.max) return fmt::format("{} .. {}", *range.min, *range.max);
  return range.min ? fmt::format("{} or more", *range.min) : "any number";
}

}  // namespace shadowbench::metrics
