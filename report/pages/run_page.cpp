#include "report/pages/run_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

#include "report/analysis/cells.h"
#include "report/analysis/findings.h"
#include "report/analysis/gpu_costs.h"
#include "report/analysis/measures.h"
#include "report/pages/answer.h"
#include "report/pages/grid_sheets.h"
#include "report/pages/run_data.h"
#include "report/pages/tables.h"
#include "report/pages/trade_section.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/records.h"

namespace shadowbench::pages {
namespace {

using OptionalPath = std::optional<std::string>;
using ImageMember = OptionalPath records::ImagesRecord::*;

constexpr const char* kGpuNote =
    "Facts are counted by the GPU's own compiler (Mesa's RADV) in the code that is drawn here: own instructions and "
    "reads are the lookup's less those of a lookup that reads nothing of the map. Estimates are made of them and of "
    "data sheets: the largest of arithmetic, sampling and memory, as if each were alone. Of drawing the map they have "
    "a "
    "lower bound: its triangles or its filled texels, at the rates of data sheets. What every lookup pays is in no "
    "estimate. They rank filters; they are no measurement.";

/// Names the scene, and the map and its fit where the run has the scene with several.
std::string head_group(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                       const records::CellRecord& cell) {
  const auto found = std::ranges::find(run.scenes, cell.scene, &records::SceneRecord::name);
  std::string head = found == run.scenes.end() || found->title.empty() || found->title == cell.scene
                         ? cell.scene
                         : cell.scene + ": " + found->title;
  const auto varies = [&](auto member) {
    return std::ranges::any_of(cells, [&](const records::CellRecord& other) {
      return other.scene == cell.scene && other.*member != cell.*member;
    });
  };
  if (varies(&records::CellRecord::map_size)) head += fmt::format(", map {}", cell.map_size);
  if (!varies(&records::CellRecord::fit)) return head;
  std::set<std::string> fits;
  for (const records::CellRecord& each : cells) fits.insert(each.fit);
  return head + ", " + records::name_fit(cell.fit, fits);
}

/// The first path that a cell of the group names: cells of one group share it.
OptionalPath find_path(const analysis::CellGroup& group, ImageMember member) {
  for (const records::CellRecord& cell : group.cells)
    if (cell.images.*member) return cell.images.*member;
  return std::nullopt;
}

/// One picture of every cell that has its numbers' breaks drawn.
document::Gallery make_stability_gallery(const analysis::CellGroup& group) {
  document::Gallery gallery{"Where numbers break: overflow, negative variance, 16 bits, and bounds", {}, true};
  for (const records::CellRecord& cell : group.cells)
    if (cell.images.stability)
      gallery.pictures.push_back(
          {*cell.images.stability, group.names.name(cell) + ": where its numbers break, or come near to it"});
  return gallery;
}

/// Those of some pictures that a group has.
document::Gallery make_gallery(const char* title, const analysis::CellGroup& group,
                               const std::vector<std::pair<ImageMember, const char*>>& pictures) {
  document::Gallery gallery{title, {}};
  for (const auto& [member, caption] : pictures)
    if (const auto path = find_path(group, member)) gallery.pictures.push_back({*path, caption});
  return gallery;
}

std::string css_color(const std::array<float, 3>& color) {
  const auto code = [](float value) { return std::lround(255.0f * value); };
  return fmt::format("#{:02x}{:02x}{:02x}", code(color[0]), code(color[1]), code(color[2]));
}

/// The error's parts, share times RMSE, positive ones from the zero line to the right, negative ones to the left; words
/// alone where there is no attribution, or the cell is suspect: it must not set the scale of the others.
document::Bars::Row make_bar_row(const analysis::CellGroup& group, const records::CellRecord& cell) {
  const std::string head = fmt::format("{}: {}", group.names.name(cell), records::format_number(*cell.error.rmse));
  const auto shares = records::list_shares(cell);
  if (cell.status == records::CellStatus::kSuspect || !shares || !std::isfinite(*cell.error.rmse))
    return {fmt::format("{} · no attribution: {}", head, records::explain_no_attribution(cell)), {}};
  document::Bars::Row row{head, {}, 0.0, records::describe_shares(*shares)};
  double left = 0.0, right = 0.0;
  for (std::size_t part = 0; part < metrics::kErrorParts; ++part) {
    const double length = (*shares)[part].value_or(0.0) * *cell.error.rmse;
    const std::string color = css_color(records::list_error_parts()[part].color);
    row.net += length;
    if (length > 0.0) row.segments.push_back({right, right + length, color});
    if (length < 0.0) row.segments.push_back({left + length, left, color});
    (length > 0.0 ? right : left) += length;
  }
  return row;
}

double round_up_length(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (value <= step * power * (1.0 + 1e-9)) return step * power;
  return 10.0 * power;
}

/// Where the error comes from, on a scale of a round length that holds all; nothing where no cell of the group has an
/// attribution.
std::optional<document::Bars> make_bars(const analysis::CellGroup& group) {
  constexpr double kSmallestLength = 0.001;
  document::Bars bars;
  double below = 0.0, above = 0.0;
  bool is_any = false;
  for (const records::CellRecord& cell : group.cells) {
    if (!cell.error.rmse) continue;
    const document::Bars::Row& row = bars.rows.emplace_back(make_bar_row(group, cell));
    is_any = is_any || !row.words.empty();
    for (const auto& segment : row.segments) {
      below = std::max(below, -segment.begin);
      above = std::max(above, segment.end);
    }
  }
  if (!is_any) return std::nullopt;
  const double length = round_up_length(std::max(kSmallestLength, below + above));
  bars.title =
      fmt::format("Parts of the RMSE, to {}; those left of the line offset others.", records::format_number(length));
  for (const records::ErrorPart& part : records::list_error_parts())
    bars.legend.push_back({css_color(part.color), part.name});
  bars.low = -below;
  bars.high = length - below;
  return bars;
}

/// Tables of one scene.
void add_numbers(std::vector<document::Block>& blocks, const records::RunRecord& run,
                 const analysis::CellGroup& group) {
  blocks.emplace_back(document::Paragraph{records::describe_settings(group.cells.front()), true});
  blocks.emplace_back(
      document::Table{"What it costs: " + records::describe_clock(run.gl), make_cost_table(group, run.gl)});
  const bool offset = std::ranges::any_of(group.cells, [](const records::CellRecord& cell) {
    const auto shares = records::list_shares(cell);
    return shares && records::has_offsets(*shares);
  });
  blocks.emplace_back(
      document::Table{fmt::format("How wrong it is, and why: errors of visibility in [0,1]{}",
                                  offset ? fmt::format("; shares add up to 100 %: {}", records::kOffsets) : ""),
                      make_accuracy_table(group)});
  if (const auto stability = analysis::describe_stability(group); !stability.empty())
    blocks.emplace_back(document::Sentences{{}, stability});
}

void add_pictures(std::vector<document::Block>& blocks, const analysis::CellGroup& group) {
  if (const auto grid = find_path(group, &records::ImagesRecord::grid)) {
    const auto has_place = [](const records::CellRecord& cell) { return cell.images.grid.has_value(); };
    const auto filters = static_cast<std::size_t>(std::ranges::count_if(group.cells, has_place));
    document::Gallery gallery;
    for (const std::string& sheet : list_sheets(*grid, filters))
      gallery.pictures.push_back({sheet, "filters on " + group.scene + " by their error, first phase"});
    blocks.emplace_back(std::move(gallery));
  }
  for (document::Gallery& gallery :
       std::array{make_gallery("All lights of the scene at once", group,
                               {{&records::ImagesRecord::all_lights,
                                 "the truth and each filter, with what a frame costs whose lights all move"}}),
                  make_stability_gallery(group),
                  make_gallery("The shadow map: its depths, and where its texels fall", group,
                               {{&records::ImagesRecord::depth_map, "depth map, as the light sees the scene"},
                                {&records::ImagesRecord::texel_density, "how many map texels fall on each pixel"}})})
    if (!gallery.pictures.empty()) blocks.emplace_back(std::move(gallery));
  if (const auto exr = find_path(group, &records::ImagesRecord::exr))
    blocks.emplace_back(document::Links{"The float images of all filters, first phase:", {{*exr, *exr}}});
}

/// What there is of each scene and map, folded away, and all of them again; of a large run their pictures alone.
void add_groups(std::vector<document::Block>& blocks, const records::RunRecord& run,
                const std::vector<records::CellRecord>& cells) {
  const bool is_large = cells.size() > kMostCellsInDetail;
  if (is_large)
    blocks.emplace_back(document::Paragraph{
        fmt::format("The run has {} cells: of more than {}, tables of each scene are left out. timings.csv and "
                    "accuracy.csv have all numbers.",
                    cells.size(), kMostCellsInDetail)});
  document::Details scenes{"Tables and images of each scene", {}};
  for (const analysis::CellGroup& group : analysis::group_cells(cells)) {
    document::Details details{head_group(run, cells, group.cells.front()), {}};
    if (!is_large) add_numbers(details.blocks, run, group);
    add_pictures(details.blocks, group);
    if (!details.blocks.empty()) scenes.blocks.emplace_back(std::move(details));
  }
  if (!scenes.blocks.empty()) blocks.emplace_back(std::move(scenes));
}

double find_worst_rmse(const analysis::CellGroup& group) {
  double worst = 0.0;
  for (const records::CellRecord& cell : group.cells) worst = std::max(worst, cell.error.rmse.value_or(0.0));
  return worst;
}

/// Bars of every scene and map, the one with the largest RMSE first and unfolded; nothing where no cell has an
/// attribution, or where so many cells have that nobody would look at all.
std::optional<document::Section> make_causes_section(const records::RunRecord& run,
                                                     const std::vector<records::CellRecord>& cells) {
  if (cells.size() > kMostCellsInDetail) return std::nullopt;
  std::vector<analysis::CellGroup> groups = analysis::group_cells(cells);
  std::ranges::stable_sort(groups, std::greater(), find_worst_rmse);
  document::Section section{"causes", "Where the error comes from", {}};
  document::Details others{"Other scenes", {}};
  for (const analysis::CellGroup& group : groups) {
    auto bars = make_bars(group);
    if (!bars) continue;
    const std::string head = head_group(run, cells, group.cells.front());
    if (section.blocks.empty()) {
      section.blocks = {document::Heading{head}, std::move(*bars)};
      continue;
    }
    others.blocks.emplace_back(document::Heading{head});
    others.blocks.emplace_back(std::move(*bars));
  }
  if (!others.blocks.empty()) section.blocks.emplace_back(std::move(others));
  return section.blocks.empty() ? std::nullopt : std::optional(std::move(section));
}

/// RMSE of scenes by filters: what the script's table begins with.
document::Section make_table_section(const std::vector<records::CellRecord>& cells) {
  const std::vector<const records::CellRecord*> all = analysis::point_to(cells);
  const std::vector<analysis::Place> places = analysis::list_places(all);
  records::TextTable table;
  table.header = {"filter", "kernel"};
  for (const analysis::Place& place : places) table.header.push_back(analysis::describe_place(place, places));
  for (const analysis::Configuration& configuration : analysis::list_configurations(all)) {
    auto& row =
        table.rows.emplace_back(std::vector<std::string>{configuration.name, analysis::describe_kernel(configuration)});
    row.resize(table.header.size(), records::kNothing);
    for (const records::CellRecord* cell : configuration.cells)
      row[2 + analysis::find_place(places, *cell)] = records::format_number(cell->error.rmse);
  }
  document::Section section{
      "table",
      "All numbers",
      {document::Mount{"numbers", {document::Table{"RMSE to the area truth", std::move(table)}}}}};
  section.brief = true;
  return section;
}

/// Facts and estimates for each GPU that the run names; nothing where it names none.
std::optional<document::Section> make_gpu_section(const std::vector<records::CellRecord>& cells) {
  const std::vector<const records::CellRecord*> all = analysis::point_to(cells);
  const std::vector<std::string> gpus = analysis::list_gpus(all);
  if (gpus.empty()) return std::nullopt;
  const std::vector<analysis::Configuration> configurations = analysis::list_configurations(all);
  document::Section section{"gpus", "GPUs", {}};
  document::Sentences sentences;
  document::Details tables{"Estimates and facts of every filter", {}};
  for (const std::string& gpu : gpus) {
    const auto costs = analysis::list_gpu_costs(configurations, gpu);
    for (std::string& each : analysis::describe_gpu(gpu, costs)) sentences.items.push_back(std::move(each));
    if (records::TextTable table = analysis::make_gpu_table(costs); !table.rows.empty())
      tables.blocks.emplace_back(document::Table{
          fmt::format("{}: estimates for a {}x{} frame with one map, moving light, and facts of the lookup", gpu,
                      records::kGpuFrameWidth, records::kGpuFrameHeight),
          std::move(table)});
  }
  if (!sentences.items.empty()) tables.blocks.emplace(tables.blocks.begin(), std::move(sentences));
  tables.blocks.emplace(tables.blocks.begin(), document::Paragraph{kGpuNote, true});
  if (!tables.blocks.empty()) section.blocks.emplace_back(std::move(tables));
  return section;
}

document::Section make_evidence_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                        bool is_whole) {
  document::Section section{"evidence", "Behind the numbers", {}};
  add_groups(section.blocks, run, cells);
  if (const auto absences = analysis::count_absences(cells); !absences.empty()) {
    document::Sentences reasons;
    for (const auto& [reason, count] : absences)
      reasons.items.push_back(fmt::format("{} ({} of {} cells)", reason, count, cells.size()));
    section.blocks.emplace_back(document::Details{"What is not there, and why", {reasons}});
  }
  document::Details columns{"Columns of the CSV files", {}};
  explain_columns(columns, "timings.csv", records::list_csv_columns(records::CsvTable::kTimings));
  explain_columns(columns, "accuracy.csv", records::list_csv_columns(records::CsvTable::kAccuracy));
  section.blocks.emplace_back(std::move(columns));
  document::Details machine{"Precision, machine and command", {document::Facts{analysis::list_run_facts(run)}}};
  if (std::string power = analysis::describe_power(cells); !power.empty())
    machine.blocks.emplace_back(document::Paragraph{std::move(power)});
  section.blocks.emplace_back(std::move(machine));
  if (!is_whole) return section;
  section.blocks.emplace_back(document::Links{"Data:",
                                              {{"summary.md", "summary.md"},
                                               {"details.md", "details.md"},
                                               {"timings.csv", "timings.csv"},
                                               {"accuracy.csv", "accuracy.csv"},
                                               {"results.json", "results.json"},
                                               {"results.schema.json", "its schema"}}});
  return section;
}

}  // namespace

document::Page make_run_page(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                             const std::vector<records::BiasCell>& biases, const std::string& so_far) {
  const analysis::AdviceRequest request = choose_request(cells);
  document::Page page{"Shadow filters compared", {}, {}};
  const auto add = [&](document::Section section) { page.sections.push_back(std::move(section)); };
  if (!cells.empty()) page.of = describe_setting(cells);
  if (!so_far.empty()) add({"so-far", "", {document::Paragraph{so_far}}, true});
  add(make_answer_section(run, cells, request, biases));
  page.sections.back().brief = true;
  const auto without_external = analysis::leave_out_external(cells);
  const std::vector<records::CellRecord>& own = without_external ? *without_external : cells;
  if (auto causes = make_causes_section(run, own)) add(std::move(*causes));
  if (!run.warnings.empty()) add({"warnings", "Warnings", {document::Sentences{{}, run.warnings}}, true, true});
  if (!cells.empty()) {
    add(make_table_section(cells));
    add({"viewer", "Look closer", {document::Mount{"viewer", {}}}});
    if (std::ranges::any_of(cells, [](const auto& cell) { return cell.images.frames.has_value(); }))
      add({"live", "Live", {document::Mount{"live", {}}}});
    page.data = make_run_data(run, cells, biases);
  }
  if (auto external = make_external_section(cells)) add(std::move(*external));
  if (auto trade = make_trade_section(run, own)) add(std::move(*trade));
  if (auto cascades = make_cascade_section(own)) add(std::move(*cascades));
  if (auto gpus = make_gpu_section(own)) add(std::move(*gpus));
  add(make_evidence_section(run, cells, so_far.empty()));
  return page;
}

}  // namespace shadowbench::pages
