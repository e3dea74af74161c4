#include "report/pages/tables.h"

#include <fmt/format.h>

#include "report/analysis/cell_group.h"
#include "report/analysis/summary.h"
#include "report/page/markdown.h"
#include "report/pages/text_tables.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

std::string markdown_list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += "- " + page::escape_markdown(item) + "\n";
  return text;
}

std::string markdown_group(const analysis::CellGroup& group, const records::GlRecord& gl) {
  return fmt::format(
      "## {}\n\n{}. Times are {}.\n\n{}\n### What it costs\n\n{}\n### How wrong it is, and why\n\n{}\n",
      page::escape_markdown(group.scene), page::escape_markdown(records::describe_settings(group.cells.front())),
      records::describe_clock(gl), markdown_list(analysis::describe_group(group, gl)),
      page::markdown_table(make_cost_table(group, gl)), page::markdown_table(make_accuracy_table(group)));
}

std::string markdown_absences(const std::vector<records::CellRecord>& cells) {
  std::vector<std::string> items;
  for (const auto& [reason, count] : analysis::count_absences(cells))
    items.push_back(fmt::format("{} ({} of {} cells)", reason, count, cells.size()));
  return items.empty() ? std::string() : "## What is not there, and why\n\n" + markdown_list(items) + "\n";
}

std::string markdown_columns(CsvTable table) {
  std::string text;
  for (const CsvColumn& column : list_csv_columns(table))
    text += fmt::format("- `{}`: {}\n", column.name, page::escape_markdown(column.meaning));
  return text;
}

}  // namespace

std::string make_summary(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                         const std::string& trade) {
  std::string text = "# Shadow filters compared\n\n";
  for (const auto& [name, value] : analysis::list_run_facts(run))
    text += fmt::format("- **{}**: {}\n", name, page::escape_markdown(value));
  text += "\nAll times are " + records::describe_clock(run.gl) + ". Filters whose intervals overlap are tied.\n\n";
  if (!run.warnings.empty()) text += "## Warnings\n\n" + markdown_list(run.warnings) + "\n";
  text += trade;
  for (const analysis::CellGroup& group : analysis::group_cells(cells)) text += markdown_group(group, run.gl);
  text += markdown_absences(cells) + "## Columns of timings.csv\n\n" + markdown_columns(CsvTable::kTimings);
  text += "\n## Columns of accuracy.csv\n\n" + markdown_columns(CsvTable::kAccuracy);
  return text;
}

}  // namespace shadowbench::pages
