#include "report/pages/trade_section.h"

#include <fmt/format.h>

#include <algorithm>

#include "filters/kernel_width.h"
#include "report/analysis/machines/machine_kinds.h"
#include "report/pages/fronts_csv.h"
#include "report/pages/text_tables.h"
#include "report/pages/trade_charts.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

using Blocks = std::vector<document::Block>;

constexpr const char* kFrontsNote =
    "Lower left is better. Filled and joined: unbeaten in its class of width. Hollow: a tie. Faint: beaten. Click a "
    "mark to look closer.";
constexpr const char* kLargeNote =
    "The run has more than {} cells: beaten ones, and the lines from narrow to wide kernels, are left out of these "
    "charts. fronts.csv has them.";
constexpr const char* kCrossoversNote =
    "A width counts where both were measured, or one was and the other is interpolated between its neighbours; cheaper "
    "and dearer are said where the 95 % intervals do not overlap. Crosses mark where the medians meet.";
constexpr const char* kLightsNote =
    "Light 0 is the scene's; the others are it, turned about the vertical in equal steps, each with a frustum, a depth "
    "map and an encoded map of its own. Still: maps and prefilters are kept, and each light is looked up; moving: all "
    "of them are drawn in every frame. Shading is left out. In brackets: the 95 % interval of the per-round ratio to "
    "the reference under as many lights, times its median (quartiles where the run does not hold the reference); "
    "cheaper is said where these do not overlap. Growth is fitted to each filter's own medians, in brackets what its "
    "quartiles allow: each number of lights is timed in rounds of its own, and drift of the machine between them is in "
    "the growth, not in the order. Off a line: how far a median is at most.";
constexpr const char* kMapsNote =
    "A map that is fitted to the scene (tight, sphere) serves every camera, and can be kept while light and casters "
    "stand still; every other fit follows a camera, and is drawn anew for each and whenever it moves. Cost: medians of "
    "map, prefilter and whole lookup, added. Each map is timed in rounds of its own: cheaper is said where costs "
    "differ by more than the passes' quartiles do, and than empty lookups do between the maps (drift: the slowest over "
    "the fastest). As accurate: the RMSE is not clearly larger. Other views are taken to have the error and the cost "
    "of the one that was measured.";

/// How fronts are read: what dominated and tied mean, what the intervals are, how scenes are combined, and what each of
/// `costs` is.
std::vector<std::string> explain_fronts(const std::vector<analysis::Measure>& costs) {
  std::vector<std::string> sentences = {
      fmt::format(
          "Only filters whose kernels are about equally wide are compared: a wider kernel makes a softer shadow, "
          "and is no worse filter. A kernel's width is its standard deviation along an axis, in texels; each "
          "class has a front of its own: {}.",
          filters::describe_classes()),
      "A cell of the front beats another of its class, which is then dominated, where it costs no more, its error is "
      "not clearly larger, and one of the two is clearly less. A cell is tied with one of the front where neither is "
      "clearly less. Clearly: errors where the 95 % interval of their difference, which is taken group by group of "
      "the phases that all cells share, does not hold 0; times whose 95 % intervals do not overlap; everything else "
      "where the numbers differ. Of several that beat a cell, the cheapest is named."};
  const auto explain = [&](const analysis::Measure& measure) {
    sentences.push_back(
        fmt::format("{}: {}. All scenes together: {}.", measure.name, measure.meaning, measure.over_scenes));
  };
  std::ranges::for_each(analysis::list_error_measures(), explain);
  std::ranges::for_each(costs, explain);
  return sentences;
}

void add_fronts(Blocks& blocks, const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                const Trade& trade) {
  blocks.emplace_back(document::Paragraph{kFrontsNote, true});
  if (cells.size() > kMostCellsInDetail)
    blocks.emplace_back(document::Paragraph{fmt::format(kLargeNote, kMostCellsInDetail), true});
  blocks.emplace_back(make_front_choice(trade.scopes, cells, run.gl));
  blocks.emplace_back(
      document::Details{"How to read the fronts",
                        {document::Sentences{{}, explain_fronts(trade.scopes.front().costs)},
                         document::Links{"All fronts, cell by cell:", {{"fronts.csv", "fronts.csv"}}}}});
  blocks.emplace_back(explain_columns("fronts.csv", list_front_columns()));
}

/// A heading, a sentence, charts, a table that is folded away, and how it is read.
void add_finding(Blocks& blocks, const char* heading, const std::string& sentence, document::ChartChoice charts,
                 std::vector<document::Table> tables, const char* note) {
  blocks.emplace_back(document::Heading{heading});
  if (!sentence.empty()) blocks.emplace_back(document::Paragraph{sentence});
  if (!charts.charts.empty()) blocks.emplace_back(std::move(charts));
  document::Details details{"Table, and how to read it", {}};
  for (document::Table& table : tables)
    if (!table.table.rows.empty()) details.blocks.emplace_back(std::move(table));
  details.blocks.emplace_back(document::Paragraph{note, true});
  blocks.emplace_back(std::move(details));
}

void add_widths(Blocks& blocks, const records::RunRecord& run, const std::vector<std::string>& filters,
                const std::vector<analysis::CostChart>& charts) {
  if (charts.empty()) return;
  add_finding(blocks, "From which width of the kernel on a prefiltered map pays", analysis::summarize_widths(charts),
              make_curve_choice("width", charts, filters, run.gl),
              {{"Prefiltered maps against many taps, widths in texels", analysis::make_comparison_table(charts)}},
              kCrossoversNote);
}

void add_growth(Blocks& blocks, const std::vector<records::CellRecord>& cells) {
  records::TextTable table = analysis::make_growth_table(cells);
  if (table.header.size() < 2) return;
  blocks.emplace_back(document::Heading{"How times grow"});
  blocks.emplace_back(
      document::Table{"Time grows as the size to the power of: 1 is in proportion, 0 not at all", table});
}

void add_lights(Blocks& blocks, const records::RunRecord& run, const std::vector<std::string>& filters,
                const std::vector<analysis::CostChart>& charts) {
  if (charts.empty()) return;
  std::vector<analysis::CostChart> drawn = charts;
  std::erase_if(drawn, [](const analysis::CostChart& chart) {
    return analysis::list_measured({&chart, 1}).size() < 2;
  });
  add_finding(
      blocks, "How a frame's cost grows with its lights", analysis::summarize_lights(charts, run.gl),
      make_curve_choice("lights", drawn, filters, run.gl),
      {{fmt::format("Time of a frame, ms: {}", records::describe_clock(run.gl)), analysis::make_light_table(charts)},
       {"Filters that change order", analysis::make_comparison_table(charts)}},
      kLightsNote);
}

void add_maps(Blocks& blocks, const records::RunRecord& run, const std::vector<analysis::MapFamily>& families) {
  const std::string sentence = analysis::summarize_maps(families, run.gl);
  if (sentence.empty()) return;
  add_finding(
      blocks, "Which map: one for all, one for each view, or layers", sentence, make_map_choice(families, run.gl),
      {{"Each filter's maps, the map drawn in every frame", analysis::make_map_table(families, run.gl)}}, kMapsNote);
}

}  // namespace

std::optional<Trade> make_trade(const std::vector<records::CellRecord>& measured) {
  const auto withheld = analysis::withhold_mixed_times(measured);
  const std::vector<records::CellRecord>& cells = withheld ? *withheld : measured;
  Trade trade;
  trade.scopes = analysis::make_trade_scopes(cells);
  trade.has_fronts = analysis::has_trade(trade.scopes);
  trade.light_charts = analysis::make_light_charts(cells, trade.scopes);
  trade.map_families = analysis::list_map_families(cells);
  if (!trade.has_fronts && trade.light_charts.empty() && trade.map_families.empty()) return std::nullopt;
  if (trade.has_fronts) trade.width_charts = analysis::make_width_charts(cells, trade.scopes);
  return trade;
}

document::Section make_trade_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                     const Trade& trade) {
  document::Section section{"trade", "The trade", {}};
  const std::vector<std::string> filters = analysis::list_filters(cells);
  if (trade.has_fronts) {
    add_fronts(section.blocks, run, cells, trade);
    add_widths(section.blocks, run, filters, trade.width_charts);
    add_growth(section.blocks, cells);
  }
  add_lights(section.blocks, run, filters, trade.light_charts);
  add_maps(section.blocks, run, trade.map_families);
  return section;
}

}  // namespace shadowbench::pages
