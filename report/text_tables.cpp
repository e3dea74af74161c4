#include "report/text_tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "report/accuracy_words.h"
#include "report/error_parts.h"

namespace shadowbench::report {
namespace {

std::string format_quartiles(const std::optional<Quartiles>& time) {
  return time
             ? fmt::format("{} [{}, {}]", format_number(time->median), format_number(time->q1), format_number(time->q3))
             : kNothing;
}

template <class T>
std::string format_optional(const std::optional<T>& value) {
  return value ? format_number(static_cast<double>(*value)) : kNothing;
}

std::string format_optional_rate(const std::optional<double>& rate) { return rate ? format_rate(*rate) : kNothing; }

std::string format_rmse(const CellRecord& cell) {
  if (!cell.error.rmse || !cell.truth.se) return format_optional(cell.error.rmse);
  return fmt::format("{} ({})", format_number(*cell.error.rmse), format_number(*cell.truth.se));
}

std::string format_dominating_part(const CellRecord& cell) {
  if (is_lost_in_truth(cell)) return "none: within the truth's own error";
  const auto shares = list_shares(cell);
  if (!shares) return kNothing;
  const auto part = find_dominating_part(*shares);
  return part ? fmt::format("{} {}", list_error_parts()[*part].id, format_share((*shares)[*part])) : "none";
}

// "numeric / estimator / discretisation / model", and the numbers in that order.
std::string join_part_names() {
  std::vector<std::string> names;
  for (const ErrorPart& part : list_error_parts()) names.emplace_back(part.id);
  return fmt::format("{}", fmt::join(names, " / "));
}

std::string format_shares(const CellRecord& cell) {
  const auto shares = list_shares(cell);
  if (!shares) return kNothing;
  std::vector<std::string> texts;
  for (const double share : *shares) texts.push_back(format_share(share));
  return fmt::format("{}", fmt::join(texts, " / "));
}

}  // namespace

TextTable make_cost_table(const CellGroup& group, const GlRecord& gl) {
  const std::string unit = time_unit(gl);
  TextTable table;
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
  for (const CellRecord& cell : group.cells) {
    table.rows.push_back({cell.filter, cell.params.empty() ? kNothing : describe_params(cell.params),
                          format_quartiles(cell.time_ms.lookup), format_ratio(cell.ratio_to_none.lookup),
                          format_quartiles(cell.time_ms.prefilter), format_quartiles(cell.time_ms.map),
                          format_optional(cell.cost.fetches), format_optional(cell.cost.bytes_per_texel),
                          format_optional(cell.cost.passes), describe_status(cell)});
  }
  return table;
}

TextTable make_accuracy_table(const CellGroup& group) {
  TextTable table;
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
  for (const CellRecord& cell : group.cells) {
    table.rows.push_back({label_cell(group, cell), format_rmse(cell), format_optional(cell.error.mean),
                          format_optional(cell.error.kernel_rmse), format_dominating_part(cell),
                          format_optional_rate(cell.artefact.acne), format_optional_rate(cell.artefact.leak),
                          format_optional_rate(cell.artefact.contact_gap), format_optional_rate(cell.artefact.noise),
                          format_shares(cell)});
  }
  return table;
}

}  // namespace shadowbench::report
