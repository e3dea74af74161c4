#include "report/analysis/maps/map_family.h"

#include <gmock/gmock.h>

#include <map>

#include "report/document/blocks.h"
#include "report/pages/trade_section.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {

using namespace records;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

/// What a map of a filter got and paid; times are known to 1 %, the RMSE to 0.001.
struct MadeMap {
  std::string fit = "tight";
  int size = 1024;
  int layers = 1;
  double rmse = 0.1;
  double map_ms = 4.0;
  double lookup_ms = 1.0;
  double prefilter_ms = 0.0;
  double empty_ms = 0.5;
};

constexpr const char* kCascades = "cascades:count=4,split=1,blend=0.1,depths=all";

Quartiles make_time(double ms) { return {ms, 0.99 * ms, 1.01 * ms, 9}; }

CellRecord make_map_cell(const MadeMap& made, const std::string& filter = "vsm") {
  CellRecord cell = make_cell("avenue", filter, made.lookup_ms);
  cell.params = {};
  cell.fit = made.fit;
  cell.map_size = made.size;
  cell.error.rmse = made.rmse;
  cell.rmse_ci95 = Interval{made.rmse - 0.001, made.rmse + 0.001};
  cell.map_scale.texel_m = 1.0 / made.rmse;
  cell.time_ms.map = make_time(made.map_ms);
  cell.time_ms.lookup = make_time(made.lookup_ms);
  cell.time_ms.empty = make_time(made.empty_ms);
  if (made.prefilter_ms > 0.0) cell.time_ms.prefilter = make_time(made.prefilter_ms);
  cell.cost.prefilter_texels = made.prefilter_ms > 0.0 ? 1024 : 0;
  cell.cost.bytes_per_texel = 4;
  cell.cost.map_bytes = std::int64_t{4} * made.layers * made.size * made.size;
  cell.key = cell_key(cell);
  return cell;
}

std::vector<CellRecord> make_map_cells(const std::vector<MadeMap>& maps) {
  std::vector<CellRecord> cells;
  for (const MadeMap& made : maps) cells.push_back(make_map_cell(made));
  return cells;
}

/// A deep scene: what follows the view is better than what is shared, and cascades are better still.
std::vector<CellRecord> make_deep_cells() {
  return make_map_cells({{"tight", 1024, 1, 0.2, 4.0, 1.0},
                         {"tight", 2048, 1, 0.1, 12.0, 1.5},
                         {"view", 1024, 1, 0.15, 4.0, 1.0},
                         {"view", 2048, 1, 0.0992, 11.0, 1.5},
                         {kCascades, 1024, 4, 0.04, 20.0, 5.0}});
}

const MapFamily make_family_of(const std::vector<CellRecord>& cells) {
  const auto families = list_map_families(cells);
  EXPECT_THAT(families, SizeIs(1));
  return families.at(0);
}

TEST(MapFamily, HoldsTheMapsOfOneFilterInOnePlace) {
  std::vector<CellRecord> cells = make_deep_cells();
  cells.push_back(make_map_cell({"tight", 1024}, "esm"));
  cells.push_back(make_map_cell({"view", 1024, 1, 0.09}, "esm"));
  cells.push_back(make_map_cell({"tight", 1024}, "none"));
  cells.push_back(make_map_cell({"tight", 2048, 1, 0.05}, "none"));
  const auto families = list_map_families(cells);
  ASSERT_THAT(families, SizeIs(2)) << "none has one fit alone";
  EXPECT_EQ(families[0].name, "vsm");
  EXPECT_EQ(families[0].place, "avenue");
  ASSERT_THAT(families[0].maps, SizeIs(5));
  EXPECT_EQ(families[0].maps[2].layers, 4);
  EXPECT_TRUE(families[0].maps[0].shared);
  EXPECT_FALSE(families[0].maps[2].shared);
  EXPECT_THAT(families[1].maps, SizeIs(2));
}

TEST(MapFamily, WithoutErrorTimesOrTrust_CellsAreLeftOut) {
  std::vector<CellRecord> cells = make_deep_cells();
  cells[0].error.rmse.reset();
  cells[1].time_ms.map.reset();
  cells[2].status = CellStatus::kSuspect;
  cells[3].cost.prefilter_texels = 5;
  EXPECT_THAT(list_map_families(cells), IsEmpty());
}

/// A lamp's map is the same whatever the fit.
TEST(MapFamily, MapsThatNoFitChanges_AreOne) {
  EXPECT_THAT(list_map_families(make_map_cells({{"view", 1024, 6}, {"tight", 1024, 6}})), IsEmpty());
}

TEST(MapLayers, AreComparedAtAsManyBytes_MapPrefilterAndLookupCounted) {
  const MapFamily family = make_family_of(make_map_cells({{"tight", 1024, 1, 0.1, 1.0, 1.0},
                                                          {"tight", 2048, 1, 0.1, 6.0, 2.0, 2.0},
                                                          {kCascades, 1024, 4, 0.04, 12.0, 4.0, 14.0}}));
  const auto found = compare_layers(family);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_NEAR(found[0].error, 0.4, 1e-12);
  EXPECT_NEAR(found[0].cost, 3.0, 1e-12);
  EXPECT_EQ(found[0].error_sign, -1);
  EXPECT_EQ(found[0].cost_sign, 1);
}

/// A column of the table of all maps: by the column's header, the text of each map.
std::map<std::string, std::string> read_column(const std::vector<MapFamily>& families, const std::string& header) {
  const TextTable table = make_map_table(families, make_run().gl);
  const auto column = std::ranges::find(table.header, header) - table.header.begin();
  std::map<std::string, std::string> texts;
  for (const auto& row : table.rows) texts[row[2]] = row.at(static_cast<std::size_t>(column));
  return texts;
}

constexpr const char* kErrorRatio = "RMSE of layers of as many bytes over its own";
constexpr const char* kCostRatio = "their cost over its own";
constexpr const char* kSharing = "cheaper for all views than a map for each";
constexpr const char* kCaching = "a kept map as accurate saves of its frame, ms (CPU)";

TEST(MapLayers, OfSeveralTheMostAccurateIsCompared) {
  std::vector<CellRecord> cells = make_deep_cells();
  cells.push_back(make_map_cell({"cascades:count=4,split=0,blend=0.1,depths=all", 1024, 4, 0.06, 1.0, 1.0}));
  auto errors = read_column(list_map_families(cells), kErrorRatio);
  EXPECT_EQ(errors.at("tight fit, 2048"), "0.4, less");
  EXPECT_EQ(errors.at("view fit, 2048"), "0.403, less");
  EXPECT_EQ(errors.at("tight fit, 1024"), kNothing);
  auto costs = read_column(list_map_families(cells), kCostRatio);
  EXPECT_EQ(costs.at("tight fit, 2048"), "1.85, more");
  EXPECT_EQ(costs.at("view fit, 2048"), "2, more");
  cells.push_back(make_map_cell({"psm", 2048, 1, 0.03, 2.0, 1.0}));
  EXPECT_EQ(read_column(list_map_families(cells), kErrorRatio).at("psm fit, 2048"), "1.33, more");
  EXPECT_EQ(read_column(list_map_families(cells), kCostRatio).at("psm fit, 2048"), "8.33, more");
}

TEST(MapLayers, WhoWinsIsSaid) {
  const auto say = [](double rmse, double ms) {
    const auto families = list_map_families(
        make_map_cells({{"tight", 2048, 1, 0.1, 6.0, 2.0}, {kCascades, 1024, 4, rmse, ms - 2.0, 2.0}}));
    return read_column(families, kErrorRatio).at("tight fit, 2048") + "; " +
           read_column(families, kCostRatio).at("tight fit, 2048");
  };
  EXPECT_EQ(say(0.05, 4.0), "0.5, less; 0.5, less");
  EXPECT_EQ(say(0.05, 8.0), "0.5, less; 1, not apart");
  EXPECT_EQ(say(0.1005, 4.0), "1, not apart; 0.5, less");
  EXPECT_EQ(say(0.1005, 8.0), "1, not apart; 1, not apart");
  EXPECT_EQ(say(0.2, 8.0), "2, more; 1, not apart");
  EXPECT_EQ(say(0.2, 9.0), "2, more; 1.12, more");
  EXPECT_EQ(say(0.2, 4.0), "2, more; 0.5, less");
}

/// 4.04 + 1.01 V < V (3.96 + 0.99) from V = 2 on; 12.12 + 1.515 V < V 12.375 likewise.
TEST(MapSharing, IsCheaperFromTheViewsThatPayForItsMap) {
  const MapFamily family = make_family_of(make_deep_cells());
  const auto found = find_sharing(family);
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].own, 1u) << "the map of 1024 that follows the view";
  EXPECT_EQ(found[0].from_views, 2);
  EXPECT_EQ(found[1].own, 4u) << "as accurate is the view's map of 2048, which is cheaper than the cascades";
  EXPECT_EQ(found[1].from_views, 2);
  EXPECT_EQ(read_column({family}, kSharing).at("tight fit, 2048"), "from 2 views on, against view fit, 2048");
  EXPECT_EQ(read_column({family}, "map and prefilter, ms (CPU)").at("tight fit, 2048"), "12");
  EXPECT_EQ(read_column({family}, "lookup, ms (CPU)").at("tight fit, 2048"), "1.5");
  EXPECT_EQ(read_column({family}, "RMSE").at("view fit, 2048"), "0.0992");
}

/// A dear shared map of 100 ms against 11 less 1: from 11 views on, by what the quartiles allow.
TEST(MapSharing, TakesAsManyViewsAsTheSmallerOwnMapIsCheaper) {
  const auto from_views = [](double shared_ms, double lookup_ms) {
    return find_sharing(make_family_of(
        make_map_cells({{"tight", 4096, 1, 0.1, shared_ms, lookup_ms}, {"view", 1024, 1, 0.1005, 10.0, 1.0}})))[0]
        .from_views;
  };
  EXPECT_EQ(from_views(100.0, 1.0), 11);
  EXPECT_EQ(from_views(4.0, 1.0), 1);
  EXPECT_EQ(from_views(4.0, 11.0), std::nullopt) << "the lookup alone is as dear as the other's frame";
}

TEST(MapSharing, WithoutOwnMapsAsAccurate_ThatIsSaid) {
  const auto families = list_map_families(make_map_cells({{"tight", 1024, 1, 0.05}, {"view", 1024, 1, 0.1}}));
  EXPECT_EQ(read_column(families, kSharing).at("tight fit, 1024"), "no own map is as accurate");
}

TEST(MapCaching, SavesTheMap_WhereTheKeptOneIsAsAccurate) {
  const MapFamily family = make_family_of(make_deep_cells());
  const auto found = find_caching(family);
  ASSERT_THAT(found, SizeIs(3));
  EXPECT_EQ(found[0].cached, 3u) << "the view's 1024 needs a kept 2048";
  EXPECT_NEAR(found[0].saved_ms, 5.0 - 1.5, 1e-12);
  EXPECT_EQ(found[1].cached, std::nullopt) << "cascades";
  EXPECT_EQ(found[2].cached, 3u) << "0.0992 is not clearly less than 0.1";
  auto saved = read_column({family}, kCaching);
  EXPECT_EQ(saved.at("view fit, 1024"), "3.5, tight fit, 2048");
  EXPECT_EQ(saved.at("view fit, 2048"), "11, tight fit, 2048");
  EXPECT_EQ(saved.at("4 cascades, 1024"), "no kept map is as accurate");
  EXPECT_EQ(saved.at("tight fit, 2048"), kNothing) << "it is kept itself";
}

TEST(MapTable, IsSummedUpInASentence) {
  EXPECT_EQ(summarize_maps(list_map_families(make_deep_cells()), make_run().gl),
            "Of maps of several fits, layers have less error than one map of as many bytes in 2 of 2 comparisons, and "
            "less cost in 0; one map for all views is cheaper than a map for each in 2 of 2 comparisons, from view 2 "
            "on at the earliest; a kept map saves up to 11 ms (CPU) of a frame.");
}

TEST(MapCaching, ThatCannotBeTold_IsNoSaving) {
  const auto families =
      list_map_families(make_map_cells({{"tight", 1024, 1, 0.1, 4.0, 5.0}, {"view", 1024, 1, 0.1005, 4.0, 1.0}}));
  EXPECT_FALSE(find_caching(families[0])[0].pays);
  EXPECT_EQ(read_column(families, kCaching).at("view fit, 1024"), "nothing that can be told, tight fit, 1024");
}

/// Empty lookups over one map should take as long: where they do not, costs are told apart by more than that alone.
TEST(MapFamily, DriftOfTheMachine_WidensTimes) {
  const std::vector<MadeMap> maps = {{"tight", 2048, 1, 0.1, 6.0, 2.0, 0.0, 0.5},
                                     {"view", 2048, 1, 0.1005, 6.0, 2.0, 0.0, 1.0},
                                     {kCascades, 1024, 4, 0.05, 10.0, 4.0, 0.0, 9.0}};
  const auto families = list_map_families(make_map_cells(maps));
  EXPECT_NEAR(families[0].drift, 2.0, 1e-12) << "cascades look up four times, which tells nothing";
  EXPECT_EQ(compare_layers(families[0])[0].cost_sign, 0);
  EXPECT_EQ(read_column(families, "drift").at("view fit, 2048"), "2");
  EXPECT_EQ(read_column(list_map_families(make_deep_cells()), "drift").at("view fit, 2048"), "1");
}

std::string write_trade(const std::vector<CellRecord>& cells) {
  const auto trade = pages::make_trade(cells);
  return trade ? document::write_markdown({"", {pages::make_trade_section(make_run(), cells, *trade)}, {}}) : "";
}

TEST(MapSection, NeedsMapsOfSeveralFits) {
  EXPECT_THAT(write_trade(make_deep_cells()), HasSubstr("Which map: one for all, one for each view, or layers"));
  EXPECT_THAT(write_trade(make_map_cells({{"tight", 1024}, {"view", 1024, 1, 0.09}})), HasSubstr("stand still"))
      << "too few cells for a front";
  EXPECT_THAT(write_trade(make_map_cells({{"tight", 512, 1, 0.3}, {"tight", 1024, 1, 0.2}, {"tight", 2048}})),
              Not(HasSubstr("Which map")));
}

}  // namespace
}  // namespace shadowbench::analysis
