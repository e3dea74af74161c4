#include "report/pages/text_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/analysis/accuracy_words.h"
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

template <class T>
std::string format_optional(const std::optional<T>& value) {
  return value ? records::format_number(static_cast<double>(*value)) : records::kNothing;
}

std::string format_optional_rate(const std::optional<double>& rate) {
  return rate ? records::format_rate(*rate) : records::kNothing;
}

std::string format_rmse(const records::CellRecord& cell) {
  if (!cell.error.rmse || !cell.truth.se) return format_optional(cell.error.rmse);
  return fmt::format("{} ({})", records::format_number(*cell.error.rmse), records::format_number(*cell.truth.se));
}

std::string format_dominating_part(const records::CellRecord& cell) {
  if (analysis::is_lost_in_truth(cell)) return "none: within the truth's own error";
  const auto shares = records::list_shares(cell);
  if (!shares) return records::kNothing;
  const auto part = analysis::find_dominating_part(*shares);
  return part ? fmt::format("{} {}", records::list_error_parts()[*part].id, records::format_share((*shares)[*part]))
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
  for (const double share : *shares) texts.push_back(records::format_share(share));
  return fmt::format("{}", fmt::join(texts, " / "));
}

}  // namespace

records::TextTable make_cost_table(const analysis::CellGroup& group, const records::GlRecord& gl) {
  const std::string unit = records::time_unit(gl);
  records::TextTable table;
  table.header = {"filter",
                  "parameters",
                  fmt::format("lookup, {}, median [quartiles]", unit),
                  "lookup / none, median [95 %]",
                  fmt::format("prefilter, {}", unit),
                  fmt::format("map, {}", unit),
                  "fetches per receiver",
                  "bytes per texel",
                  "passes",
                  "status"};
  for (const records::CellRecord& cell : group.cells) {
    table.rows.push_back({cell.filter, cell.params.empty() ? records::kNothing : records::describe_params(cell.params),
                          format_quartiles(cell.time_ms.lookup), records::format_ratio(cell.ratio_to_none.lookup),
                          format_quartiles(cell.time_ms.prefilter), format_quartiles(cell.time_ms.map),
                          format_optional(cell.cost.fetches), format_optional(cell.cost.bytes_per_texel),
                          format_optional(cell.cost.passes), records::describe_status(cell)});
  }
  return table;
}

records::TextTable make_accuracy_table(const analysis::CellGroup& group) {
  records::TextTable table;
  table.header = {"filter",
                  "RMSE to the area truth (its standard error)",
                  "mean signed error",
                  "RMSE to the kernel truth",
                  "dominating part",
                  "acne",
                  "leak",
                  "contact gap",
                  "noise",
                  "share of " + join_part_names()};
  for (const records::CellRecord& cell : group.cells) {
    table.rows.push_back({analysis::label_cell(group, cell), format_rmse(cell), format_optional(cell.error.mean),
                          format_optional(cell.error.kernel_rmse), format_dominating_part(cell),
                          format_optional_rate(cell.artefact.acne), format_optional_rate(cell.artefact.leak),
                          format_optional_rate(cell.artefact.contact_gap), format_optional_rate(cell.artefact.noise),
                          format_shares(cell)});
  }
  return table;
}

}  // namespace shadowbench::pages
