#include "report/records/metric_list.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reference/metrics/metric_table.h"

namespace shadowbench::records {
namespace {

nlohmann::json bound_json(const std::optional<double>& bound) {
  return bound ? nlohmann::json(*bound) : nlohmann::json();
}

}  // namespace

std::string make_metric_text() {
  std::string text;
  for (const metrics::Metric& metric : metrics::metric_table()) {
    text += fmt::format("{}  {}, {}, {}\n  {}\n", metric.path, metric.unit, metrics::describe_range(metric.range),
                        metrics::describe_direction(metric.direction), metric.definition);
  }
  return text;
}

std::string make_metric_json() {
  nlohmann::json json = nlohmann::json::array();
  for (const metrics::Metric& metric : metrics::metric_table()) {
    json.push_back({{"path", metric.path},
                    {"name", metric.name()},
                    {"unit", metric.unit},
                    {"min", bound_json(metric.range.min)},
                    {"max", bound_json(metric.range.max)},
                    {"direction", metrics::describe_direction(metric.direction)},
                    {"definition", metric.definition},
                    {"diff", metric.source != metrics::MetricSource::kRun}});
  }
  return json.dump(2) + "\n";
}

}  // namespace shadowbench::records
