#include "report/pages/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "reference/metrics/metric_table.h"
#include "report/analysis/cells.h"
#include "report/records/csv_tables.h"
#include "report/records/format.h"
#include "report/records/json_values.h"
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

constexpr const char* kKernelColumn = "kernel width (class)";

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

namespace {

std::string join_keys(const analysis::TradeConfiguration& configuration) {
  std::vector<std::string> keys;
  for (const records::CellRecord* cell : configuration.cells) keys.push_back(cell->key);
  return fmt::format("{}", fmt::join(keys, "+"));
}

void append(std::vector<std::string>& fields, const std::optional<analysis::Estimate>& estimate) {
  for (double analysis::Estimate::*member :
       {&analysis::Estimate::value, &analysis::Estimate::low, &analysis::Estimate::high})
    fields.push_back(estimate ? fmt::format("{}", *estimate.*member) : std::string());
}

std::vector<std::string> describe_place(const analysis::TradeScope& scope, const analysis::TradeFront& front,
                                        std::size_t configuration) {
  const auto found = std::find(front.configurations.begin(), front.configurations.end(), configuration);
  if (found == front.configurations.end()) {
    const analysis::TradeConfiguration& each = scope.configurations[configuration];
    const analysis::Measured& error = each.errors[front.error];
    return {"", "", "", error.estimate ? each.costs[front.cost].absent : error.absent};
  }
  const analysis::Placement& place = front.placements[static_cast<std::size_t>(found - front.configurations.begin())];
  if (place.standing == analysis::Standing::kApart) return {"", "", "", "its kernel is of no class of width"};
  const std::string by = join_keys(scope.configurations[front.configurations[place.by]]);
  return {place.standing == analysis::Standing::kFront ? "1" : "0",
          place.standing == analysis::Standing::kDominated ? by : "",
          place.standing == analysis::Standing::kTied ? by : "", ""};
}

std::string make_row(const analysis::TradeScope& scope, const analysis::TradeFront& front, std::size_t i,
                     const std::string& renderer) {
  const analysis::TradeConfiguration& each = scope.configurations[i];
  std::vector<std::string> fields = {scope.id,
                                     scope.scene,
                                     scope.view,
                                     fmt::format("{}", scope.width),
                                     fmt::format("{}", scope.height),
                                     analysis::list_error_measures()[front.error].id,
                                     scope.costs[front.cost].id,
                                     join_keys(each),
                                     each.filter,
                                     records::dump_line(records::value_json(each.params)),
                                     fmt::format("{}", each.map_size),
                                     each.sigma_texels ? fmt::format("{}", *each.sigma_texels) : std::string(),
                                     std::string(analysis::name_class(each.width_class))};
  append(fields, each.errors[front.error].estimate);
  append(fields, each.costs[front.cost].estimate);
  const auto place = describe_place(scope, front, i);
  fields.insert(fields.end(), place.begin(), place.end());
  fields.push_back(renderer);
  return records::make_csv_row(fields);
}

std::string make_rows(const analysis::TradeScope& scope, std::size_t error, std::size_t cost,
                      const std::string& renderer) {
  const analysis::TradeFront front = analysis::make_trade_front(scope, error, cost);
  std::string rows;
  for (std::size_t i = 0; i < scope.configurations.size(); ++i) rows += make_row(scope, front, i, renderer);
  return rows;
}

}  // namespace

std::vector<records::CsvColumn> list_front_columns() {
  return {{"scope", "what is compared on one front"},
          {"scene", "the scene's name; empty: all scenes and views together"},
          {"view", "the camera's name; empty likewise"},
          {"width", "picture, pixels"},
          {"height", "picture, pixels"},
          {"error", "which error: rmse, kernel_rmse, leak, flip"},
          {"cost",
           "which cost, the one that the page begins with first: of a frame with one map, moving and static in ms of "
           "the run's clock and picture, gpu.NAME.moving and gpu.NAME.static in ms of 1920x1080; fetches, bytes"},
          {"cell", "the cell's key; of all scenes: the keys of its cells, joined by +"},
          {"filter", "the filter's id"},
          {"params", "the filter's parameters as JSON"},
          {"map_size", "shadow map, texels along a side"},
          {"kernel_sigma_texels", "the kernel's standard deviation along an axis, texels"},
          {"kernel_class", "the class of kernels that are about as wide; each has a front of its own"},
          {"error_value", "the error"},
          {"error_low", "lower end of its interval; the value where it has none"},
          {"error_high", "upper end likewise"},
          {"cost_value", "the cost"},
          {"cost_low", "lower end of its interval; the value where it has none"},
          {"cost_high", "upper end likewise"},
          {"on_front", "1: on the front, 0: not, empty: left out"},
          {"dominated_by", "the cheapest cell of the front that beats it"},
          {"tie_with", "the cell of the front with which it is statistically tied"},
          {"left_out", "why it has no place on this front"},
          {"renderer", "the GPU that a browser timed the cost on; empty: the run's own"}};
}

void write_fronts_csv(const std::vector<records::CellRecord>& cells, const std::vector<analysis::TradeScope>& scopes,
                      const std::vector<records::GpuTimes>& machines,
                      const std::function<void(std::string_view)>& write) {
  std::vector<std::string> names;
  for (const records::CsvColumn& column : list_front_columns()) names.push_back(column.name);
  write(records::make_csv_row(names));
  for (const analysis::TradeScope& scope : scopes)
    for (std::size_t error = 0; error < analysis::kErrorMeasures; ++error)
      for (std::size_t cost = 0; cost < scope.costs.size(); ++cost) write(make_rows(scope, error, cost, {}));
  for (const records::GpuTimes& times : machines) {
    records::Results timed{{}, cells};
    records::apply_gpu_times(timed, times);
    for (const analysis::TradeScope& scope : analysis::make_trade_scopes(timed.cells))
      for (std::size_t error = 0; error < analysis::kErrorMeasures; ++error)
        for (std::size_t cost = 0; cost < scope.costs.size(); ++cost)
          if (scope.costs[cost].is(analysis::CostKind::kTime)) write(make_rows(scope, error, cost, times.renderer));
  }
}

}  // namespace shadowbench::pages
