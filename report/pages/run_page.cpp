#include "report/pages/run_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/analysis/cell_group.h"
#include "report/analysis/summary.h"
#include "report/images/attribution_bar.h"
#include "report/pages/column_list.h"
#include "report/pages/text_tables.h"
#include "report/records/error_parts.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

using OptionalPath = std::optional<std::string>;
using ImageMember = OptionalPath records::ImagesRecord::*;

/// Names the scene, and the map where the run has the scene with several.
std::string head_group(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                       const records::CellRecord& cell) {
  const auto found = std::ranges::find(run.scenes, cell.scene, &records::SceneRecord::name);
  const std::string name =
      found == run.scenes.end() || found->title.empty() ? cell.scene : cell.scene + ": " + found->title;
  const bool one_map = std::ranges::all_of(cells, [&](const records::CellRecord& other) {
    return other.scene != cell.scene || other.map_size == cell.map_size;
  });
  return one_map ? name : fmt::format("{}, map {}", name, cell.map_size);
}

/// The first path that a cell of the group names: cells of one group share it.
OptionalPath find_path(const analysis::CellGroup& group, ImageMember member) {
  for (const records::CellRecord& cell : group.cells)
    if (cell.images.*member) return cell.images.*member;
  return std::nullopt;
}

/// One picture of every cell that has it.
page::Gallery make_cell_gallery(const analysis::CellGroup& group, ImageMember member, const std::string& title,
                                const std::string& caption) {
  page::Gallery gallery{title, {}, true};
  for (const records::CellRecord& cell : group.cells)
    if (cell.images.*member)
      gallery.pictures.push_back({*(cell.images.*member), analysis::label_cell(group, cell) + caption});
  return gallery;
}

page::Gallery make_single_gallery(const analysis::CellGroup& group) {
  page::Gallery gallery{"Single pictures", {}};
  for (const records::CellRecord& cell : group.cells) {
    const std::string name =
        cell.params.empty() ? cell.filter : cell.filter + " (" + records::describe_params(cell.params) + ")";
    if (cell.images.picture) gallery.pictures.push_back({*cell.images.picture, name + ": picture"});
    if (cell.images.visibility) gallery.pictures.push_back({*cell.images.visibility, name + ": visibility"});
  }
  return gallery;
}

page::Gallery make_map_gallery(const analysis::CellGroup& group) {
  page::Gallery gallery{"The shadow map: its depths, and where its texels fall", {}};
  const std::pair<ImageMember, const char*> pictures[] = {
      {&records::ImagesRecord::depth_map, "depth map, as the light sees the scene, with its histogram"},
      {&records::ImagesRecord::texel_density, "how many map texels fall on each pixel"},
      {&records::ImagesRecord::texel_grid, "the map's texels on the surfaces"}};
  for (const auto& [member, caption] : pictures)
    if (const auto path = find_path(group, member)) gallery.pictures.push_back({*path, caption});
  return gallery;
}

std::string css_color(const std::array<float, 3>& color) {
  const auto code = [](float value) { return std::lround(255.0f * value); };
  return fmt::format("#{:02x}{:02x}{:02x}", code(color[0]), code(color[1]), code(color[2]));
}

page::Bars::Row make_bar_row(const analysis::CellGroup& group, const records::CellRecord& cell) {
  const std::string head =
      fmt::format("{}: RMSE {}", analysis::label_cell(group, cell), records::format_number(*cell.error.rmse));
  const auto bar = images::make_attribution_bar(cell);
  if (!bar) return {fmt::format("{} · no attribution: {}", head, records::explain_no_attribution(cell)), {}};
  page::Bars::Row row{
      fmt::format("{} · {}", head, records::describe_shares(*records::list_shares(cell))), {}, bar->net()};
  for (const images::BarSegment& segment : images::stack_segments(*bar))
    row.segments.push_back({segment.begin, segment.end, css_color(records::list_error_parts()[segment.part].color)});
  return row;
}

/// Where the error comes from; nothing where no cell of the group has an attribution.
std::optional<page::Bars> make_bars(const analysis::CellGroup& group) {
  std::vector<images::AttributionBar> drawn;
  for (const records::CellRecord& cell : group.cells)
    if (const auto bar = images::make_attribution_bar(cell)) drawn.push_back(*bar);
  if (drawn.empty()) return std::nullopt;
  const images::BarScale scale = images::choose_bar_scale(drawn);
  page::Bars bars;
  bars.title = fmt::format(
      "Where the error comes from: each part's share times RMSE. Parts left of the grey line offset the others. The "
      "black tick is the RMSE, the full width {}.",
      records::format_number(scale.length));
  for (const records::ErrorPart& part : records::list_error_parts())
    bars.legend.push_back({css_color(part.color), part.name});
  bars.low = -scale.below;
  bars.high = scale.length - scale.below;
  for (const records::CellRecord& cell : group.cells)
    if (cell.error.rmse) bars.rows.push_back(make_bar_row(group, cell));
  return bars;
}

page::Section make_group_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                 const analysis::CellGroup& group, std::size_t number) {
  page::Section section{fmt::format("group-{}", number), head_group(run, cells, group.cells.front()), {}};
  auto& blocks = section.blocks;
  blocks = {page::Paragraph{records::describe_settings(group.cells.front()), true},
            page::Sentences{{}, analysis::describe_group(group, run.gl)},
            page::Table{"What it costs: " + records::describe_clock(run.gl), make_cost_table(group, run.gl)},
            page::Table{"How wrong it is, and why: errors of visibility in [0,1]", make_accuracy_table(group)}};
  if (auto bars = make_bars(group)) blocks.emplace_back(std::move(*bars));
  if (const auto grid = find_path(group, &records::ImagesRecord::grid))
    blocks.emplace_back(page::Gallery{{}, {{*grid, "all filters on " + group.scene + ", full size behind the link"}}});
  blocks.emplace_back(make_cell_gallery(group, &records::ImagesRecord::attribution,
                                        "Where in the picture the error comes from", ": the error and its four parts"));
  blocks.emplace_back(make_cell_gallery(group, &records::ImagesRecord::stability,
                                        "Where numbers break: overflow, negative variance, 16 bits, and bounds",
                                        ": where its numbers break, or come near to it"));
  blocks.emplace_back(make_single_gallery(group));
  blocks.emplace_back(make_map_gallery(group));
  if (const auto exr = find_path(group, &records::ImagesRecord::exr))
    blocks.emplace_back(page::Links{"The float images of all filters:", {{*exr, *exr}}});
  return section;
}

page::Section make_top(const records::RunRecord& run) {
  return {{},
          {},
          {page::Facts{analysis::list_run_facts(run)},
           page::Paragraph{fmt::format("All times are {}. Filters whose intervals overlap are tied.",
                                       records::describe_clock(run.gl))},
           page::Links{"Data:",
                       {{"summary.md", "summary.md"},
                        {"timings.csv", "timings.csv"},
                        {"accuracy.csv", "accuracy.csv"},
                        {"results.json", "results.json"},
                        {"results.schema.json", "its schema"}}}}};
}

page::Section make_absence_section(const std::vector<records::CellRecord>& cells) {
  page::Sentences reasons;
  for (const auto& [reason, count] : analysis::count_absences(cells))
    reasons.items.push_back(fmt::format("{} ({} of {} cells)", reason, count, cells.size()));
  return {"absent", "What is not there, and why", {reasons}};
}

}  // namespace

page::Page make_run_page(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                         const std::optional<Trade>& trade) {
  page::Page page{"Shadow filters compared", {make_top(run)}, {}};
  const auto add = [&](page::Section section) { page.sections.push_back(std::move(section)); };
  if (!run.warnings.empty()) add({"warnings", "Warnings", {page::Sentences{{}, run.warnings}}, true});
  if (trade) add(make_trade_section(run, cells, *trade));
  const std::vector<analysis::CellGroup> groups = analysis::group_cells(cells);
  for (std::size_t i = 0; i < groups.size(); ++i) add(make_group_section(run, cells, groups[i], i));
  if (!analysis::count_absences(cells).empty()) add(make_absence_section(cells));
  add({"columns",
       "What the columns mean",
       {explain_columns("timings.csv", records::list_csv_columns(records::CsvTable::kTimings)),
        explain_columns("accuracy.csv", records::list_csv_columns(records::CsvTable::kAccuracy))}});
  return page;
}

}  // namespace shadowbench::pages
