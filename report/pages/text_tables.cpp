#include "report/pages/text_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "reference/metrics/metric_table.h"
#include "report/analysis/cell_group.h"
#include "report/records/error_parts.h"
#include "report/records/format.h"
#include "report/records/text_table.h"

namespace shadowbench::pages {
namespace {

std::string format_quartiles(const std::optional<records::Quartiles>& time) {
  return time ? fmt::format("{} [{}, {}]", records::format_number(time->median), records::format_number(time->q1),
                            records::format_number(time->q3))
              : records::kNothing;
}

std::string format_own(const std::optional<records::OwnTime>& time) {
  return time ? records::format_interval(time->median, time->ci95) : records::kNothing;
}

constexpr const char* kKernelColumn = "kernel's width (class)";

using Metrics = std::vector<const metrics::Metric*>;

/// The metrics of a group that have a column here.
Metrics list_tabled(std::string_view group) {
  Metrics tabled;
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.tabled && metric.group() == group) tabled.push_back(&metric);
  return tabled;
}

// The only metric with an interval.
bool is_rmse(const metrics::Metric& metric) { return metric.path == "error.rmse"; }

void add_titles(std::vector<std::string>& header, const Metrics& tabled) {
  for (const metrics::Metric* metric : tabled)
    header.push_back(std::string(metric->title) + (is_rmse(*metric) ? " [95 % over phases]" : ""));
}

void add_values(std::vector<std::string>& row, const Metrics& tabled, const records::CellRecord& cell) {
  for (const metrics::Metric* metric : tabled) {
    const std::optional<double> value = metric->read(cell);
    row.push_back(value && is_rmse(*metric) && cell.rmse_ci95 ? records::format_interval(*value, *cell.rmse_ci95)
                  : metric->unit == "share"                   ? records::format_rate(value)
                                                              : records::format_number(value));
  }
}

std::string format_dominating_part(const records::CellRecord& cell) {
  if (analysis::is_lost_in_truth(cell)) return "none: within the truth's own error";
  const auto shares = records::list_shares(cell);
  if (!shares) return records::kNothing;
  const auto part = analysis::find_dominating_part(*shares);
  return part ? fmt::format("{} {}", records::list_error_parts()[*part].id, records::format_share(*(*shares)[*part]))
              : "none";
}

// "numeric / estimator / discretisation / model", and the numbers in that order.
std::string join_part_names() {
  std::vector<std::string> names;
  for (const records::ErrorPart& part : records::list_error_parts()) names.emplace_back(part.id);
  return fmt::format("{}", fmt::join(names, " / "));
}

std::string format_shares(const records::CellRecord& cell) {
  const auto shares = records::list_shares(cell);
  if (!shares) return records::kNothing;
  std::vector<std::string> texts;
  for (const auto& share : *shares) texts.push_back(share ? records::format_share(*share) : records::kNothing);
  return fmt::format("{}", fmt::join(texts, " / "));
}

}  // namespace

records::TextTable make_cost_table(const analysis::CellGroup& group, const records::GlRecord& gl) {
  const std::string unit = records::time_unit(gl);
  const Metrics costs = list_tabled("cost");
  records::TextTable table;
  table.header = {"filter",
                  "parameters",
                  kKernelColumn,
                  fmt::format("moving light: map, prefilter, filter, {}, median [95 %]", unit),
                  fmt::format("static light: filter alone, {}, median [95 %]", unit),
                  fmt::format("lookup, {}, median [quartiles]", unit),
                  fmt::format("prefilter, {}", unit),
                  fmt::format("map, {}", unit)};
  add_titles(table.header, costs);
  table.header.emplace_back("status");
  for (const records::CellRecord& cell : group.cells) {
    auto& row = table.rows.emplace_back(std::vector<std::string>{
        cell.filter, cell.params.empty() ? records::kNothing : records::describe_params(cell.params),
        records::describe_kernel(cell.kernel), format_own(cell.time_ms.moving), format_own(cell.time_ms.static_light),
        format_quartiles(cell.time_ms.lookup), format_quartiles(cell.time_ms.prefilter),
        format_quartiles(cell.time_ms.map)});
    add_values(row, costs, cell);
    row.push_back(records::describe_status(cell));
  }
  return table;
}

records::TextTable make_accuracy_table(const analysis::CellGroup& group) {
  const Metrics errors = list_tabled("error"), artefacts = list_tabled("artefact");
  records::TextTable table;
  table.header = {"filter", kKernelColumn};
  add_titles(table.header, errors);
  table.header.emplace_back("dominating part, first phase");
  add_titles(table.header, artefacts);
  table.header.push_back("share of " + join_part_names() + ", first phase");
  for (const records::CellRecord& cell : group.cells) {
    auto& row = table.rows.emplace_back(
        std::vector<std::string>{group.names.name(cell), records::describe_kernel(cell.kernel)});
    add_values(row, errors, cell);
    row.push_back(format_dominating_part(cell));
    add_values(row, artefacts, cell);
    row.push_back(format_shares(cell));
  }
  return table;
}

document::Details explain_columns(const std::string& file, const std::vector<records::CsvColumn>& columns) {
  document::Facts facts;
  for (const records::CsvColumn& column : columns) facts.items.push_back({column.name, column.meaning});
  return {"Columns of " + file, {facts}};
}

}  // namespace shadowbench::pages
