// The rows of the table of metrics and one more, linked in the place of the project's own: nothing else is compiled
// anew.
#include "reference/metrics/metric_table.h"

#include "tests/report/added_metric/added_metric.h"

#define list_metric_rows list_project_rows
#include "reference/metrics/metric_table.cpp"
#undef list_metric_rows

namespace shadowbench::metrics {

std::vector<Metric> list_metric_rows() {
  std::vector<Metric> rows = list_project_rows();
  rows.push_back({"artefact.banding",
                  [](MetricValues&) -> std::optional<double>& { return added_value; },
                  "share",
                  {0.0, 1.0},
                  MetricDirection::kLess,
                  "banding",
                  "of the receivers: those in a band",
                  MetricBaseline::kRate,
                  true,
                  "--max-banding",
                  MetricSource::kValues,
                  &ErrorStats::mae});
  return rows;
}

}  // namespace shadowbench::metrics
