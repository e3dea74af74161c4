#include "report/pages/trade_section.h"

#include <fmt/format.h>

#include <algorithm>

#include "filters/kernel.h"
#include "report/analysis/configuration.h"
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
constexpr const char* kMapsNote =
    "A map that is fitted to the scene (tight, sphere) serves every camera, and can be kept while light and casters "
    "stand still; every other fit follows a camera, and is drawn anew whenever it moves.";

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

void add_charts(Blocks& blocks, const char* heading, document::ChartChoice charts, const char* note) {
  if (charts.charts.empty()) return;
  blocks.emplace_back(document::Heading{heading});
  blocks.emplace_back(std::move(charts));
  if (note) blocks.emplace_back(document::Paragraph{note, true});
}

}  // namespace

std::optional<Trade> make_trade(const std::vector<records::CellRecord>& cells) {
  Trade trade;
  trade.scopes = analysis::make_trade_scopes(cells);
  trade.has_fronts = analysis::has_trade(trade.scopes);
  trade.map_families = analysis::list_map_families(analysis::point_to(cells));
  if (!trade.has_fronts && trade.map_families.empty()) return std::nullopt;
  if (trade.has_fronts) trade.width_charts = analysis::make_width_charts(cells, trade.scopes);
  return trade;
}

document::Section make_trade_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                     const Trade& trade) {
  document::Section section{"trade", "The trade", {}};
  const std::vector<std::string> filters = analysis::list_filters(cells);
  if (trade.has_fronts) add_fronts(section.blocks, run, cells, trade);
  add_charts(section.blocks, "Cost over the kernel width", make_width_choice(trade.width_charts, filters, run.gl),
             nullptr);
  add_charts(section.blocks, "Error of maps of several fits, over their bytes",
             make_map_choice(trade.map_families, analysis::make_map_measure(analysis::point_to(cells)), run.gl),
             kMapsNote);
  if (std::string best = analysis::describe_best_map(trade.map_families); !best.empty())
    section.blocks.emplace_back(document::Paragraph{std::move(best)});
  return section;
}

}  // namespace shadowbench::pages
