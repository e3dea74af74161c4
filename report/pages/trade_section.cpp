#include "report/pages/trade_section.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/analysis/front_words.h"
#include "report/analysis/growth.h"
#include "report/analysis/machines/machine_kinds.h"
#include "report/pages/column_list.h"
#include "report/pages/fronts_csv.h"
#include "report/pages/large_run.h"
#include "report/pages/trade_charts.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

using Blocks = std::vector<page::Block>;

constexpr const char* kFrontsNote =
    "Lower left is better. Filled and joined: no other filter of the same class of width beats it. Hollow: a tie. "
    "Faint: "
    "beaten. Click a mark to look closer.";
constexpr const char* kLargeNote =
    "The run has more than {} cells: beaten ones, and the lines from narrow to wide kernels, are left out of these "
    "charts. fronts.csv has them.";
constexpr const char* kCrossoversNote =
    "A width counts where both were measured, or one was and the other is interpolated between its neighbours; "
    "cheaper is said where the 95 % intervals do not overlap. Crosses mark where the medians meet.";
constexpr const char* kLightsNote =
    "Light 0 is the scene's; the others are it, turned about the vertical in equal steps, each with a frustum, a depth "
    "map and an encoded map of its own. Still: maps and prefilters are kept, and each light is looked up; moving: all "
    "of them are drawn in every frame. Shading is left out. In brackets: the 95 % interval of the per-round ratio to "
    "the reference under as many lights, times its median (quartiles where the run does not hold the reference); "
    "cheaper is said where these do not overlap. Growth is fitted to each filter's own medians, in brackets what its "
    "quartiles allow: each number of lights is timed in rounds of its own, and drift of the machine between them is in "
    "the growth, not in the order. Linear: no median is more than 10 % off the line.";
constexpr const char* kMapsNote =
    "A map that is fitted to the scene (tight, sphere) serves every camera, and can be kept while light and casters "
    "stand still; every other fit follows a camera, and is drawn anew for each and whenever it moves. Cost: medians of "
    "map, prefilter and whole lookup, added. Each map is timed in rounds of its own: cheaper is said where costs "
    "differ by more than the passes' quartiles do, and than empty lookups do between the maps. As accurate: the RMSE "
    "is not clearly larger. Other views are taken to have the error and the cost of the one that was measured.";

void add_fronts(Blocks& blocks, const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                const Trade& trade) {
  blocks.emplace_back(page::Paragraph{kFrontsNote, true});
  if (cells.size() > kMostCellsInDetail)
    blocks.emplace_back(page::Paragraph{fmt::format(kLargeNote, kMostCellsInDetail), true});
  blocks.emplace_back(make_front_choice(trade.scopes, cells, run.gl));
  blocks.emplace_back(page::Details{"How to read the fronts",
                                    {page::Sentences{{}, analysis::explain_fronts(trade.scopes.front().costs)},
                                     page::Links{"All fronts, cell by cell:", {{"fronts.csv", "fronts.csv"}}}}});
  blocks.emplace_back(explain_columns("fronts.csv", list_front_columns()));
}

void add_widths(Blocks& blocks, const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                const Trade& trade) {
  if (!trade.width_charts.empty()) {
    blocks.emplace_back(page::Heading{"From which width of the kernel on a prefiltered map pays"});
    blocks.emplace_back(page::Sentences{{}, analysis::describe_crossovers(trade.width_charts)});
    blocks.emplace_back(page::Paragraph{kCrossoversNote, true});
    blocks.emplace_back(make_width_choice(trade.width_charts, analysis::list_filters(cells), run.gl));
  }
  const auto growth = analysis::describe_growth(cells);
  if (growth.empty()) return;
  blocks.emplace_back(page::Heading{"How times grow"});
  blocks.emplace_back(page::Sentences{{}, growth});
}

void add_lights(Blocks& blocks, const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                const std::vector<analysis::LightChart>& charts) {
  if (charts.empty()) return;
  page::Sentences sentences{{}, analysis::describe_light_growth(charts, run.gl)};
  for (std::string& sentence : analysis::describe_light_order(charts)) sentences.items.push_back(std::move(sentence));
  blocks.emplace_back(page::Heading{"How a frame's cost grows with its lights"});
  blocks.emplace_back(std::move(sentences));
  blocks.emplace_back(page::Paragraph{kLightsNote, true});
  for (const analysis::LightChart& chart : charts) {
    if (chart.counts.size() > 1) blocks.emplace_back(make_light_chart(chart, analysis::list_filters(cells), run.gl));
    blocks.emplace_back(
        page::Table{fmt::format("{}: time of a frame, ms: {}", chart.title, records::describe_clock(run.gl)),
                    analysis::make_light_table(chart)});
  }
}

void add_maps(Blocks& blocks, const records::RunRecord& run, const std::vector<analysis::MapFamily>& families) {
  const page::Sentences findings[] = {
      {"Layers against one map of as many bytes, drawn in every frame:", analysis::describe_layers(families)},
      {"One map for all views against one for each, drawn in every frame:",
       analysis::describe_sharing(families, run.gl)},
      {"Light and casters stand still, and the camera moves:", analysis::describe_caching(families, run.gl)}};
  if (std::ranges::all_of(findings, [](const page::Sentences& each) { return each.items.empty(); })) return;
  blocks.emplace_back(page::Heading{"Which map: one for all, one for each view, or layers"});
  for (std::string& warning : analysis::describe_drift(families))
    blocks.emplace_back(page::Paragraph{std::move(warning)});
  for (const page::Sentences& each : findings)
    if (!each.items.empty()) blocks.emplace_back(each);
  blocks.emplace_back(page::Paragraph{kMapsNote, true});
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

page::Section make_trade_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                 const Trade& trade) {
  page::Section section{"trade", "The trade: what less error costs", {}};
  if (trade.has_fronts) {
    add_fronts(section.blocks, run, cells, trade);
    add_widths(section.blocks, run, cells, trade);
  }
  add_lights(section.blocks, run, cells, trade.light_charts);
  add_maps(section.blocks, run, trade.map_families);
  return section;
}

}  // namespace shadowbench::pages
