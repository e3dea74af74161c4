#include "report/regress/compared_metrics.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <type_traits>

#include "report/records/absence.h"
#include "report/records/record_fields.h"

namespace shadowbench::regress {
namespace {

template <class Visitor>
void visit_ratios(const records::CellRecord& cell, Visitor visit) {
  records::visit_fields(
      cell,
      [&]<class T>(const std::string& path, const T& value, const records::About& = {}) {
        if constexpr (std::is_same_v<T, std::optional<records::Ratio>>) visit(path, value);
      });
}

}  // namespace

const std::vector<metrics::Metric>& list_compared_metrics() {
  static const std::vector<metrics::Metric> kept = [] {
    std::vector<metrics::Metric> all(metrics::metric_table().begin(), metrics::metric_table().end());
    std::erase_if(all, [](const metrics::Metric& m) { return m.baseline == metrics::MetricBaseline::kNotKept; });
    return all;
  }();
  return kept;
}

bool is_error(const metrics::Metric& metric) {
  return metric.baseline == metrics::MetricBaseline::kError || metric.baseline == metrics::MetricBaseline::kRate;
}

const std::vector<std::string>& list_compared_ratios() {
  static const std::vector<std::string> paths = [] {
    std::vector<std::string> all;
    visit_ratios(records::CellRecord(), [&](const std::string& path, const auto&) { all.push_back(path); });
    return all;
  }();
  return paths;
}

ComparedValues read_values(const records::CellRecord& cell) {
  ComparedValues values;
  for (const metrics::Metric& metric : list_compared_metrics()) {
    const std::optional<double> value = metric.read(cell);
    if (value && std::isfinite(*value)) values.numbers[std::string(metric.path)] = *value;
  }
  if (!cell.time_ms.lookup || cell.time_ms.lookup->n < kFewestRounds) return values;
  visit_ratios(cell, [&](const std::string& path, const std::optional<records::Ratio>& ratio) {
    if (ratio) values.ratios[path] = *ratio;
  });
  return values;
}

std::string find_absence(const records::CellRecord& cell, const std::string& path) {
  if (path.starts_with("ratio_to_none.") && cell.time_ms.lookup && cell.time_ms.lookup->n < kFewestRounds) {
    return fmt::format("it was timed over {} rounds, and {} are the fewest that give an interval",
                       cell.time_ms.lookup->n, kFewestRounds);
  }
  return records::explain_absence(cell, path);
}

}  // namespace shadowbench::regress
