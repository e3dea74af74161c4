#pragma once

#include <vector>

#include "reference/metrics/metric_table.h"

namespace shadowbench::metrics {

/// Makes the rows of the table of metrics; metric_table() keeps them.
std::vector<Metric> list_metric_rows();

}  // namespace shadowbench::metrics
