#include "report/pages/trade_section.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "report/pages/run_page.h"
#include "report/pages/write_page.h"
#include "report/records/json_io.h"
#include "tests/report/analysis/trade_cells.h"

namespace shadowbench::pages {

using namespace analysis;
using namespace records;
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

constexpr const char* kHostile = "</script><script>alert('1', \"2\")</script><!--";

std::string write_trade(const std::vector<records::CellRecord>& cells) {
  return document::write_html({"", {*make_trade_section(make_run(), cells)}, {}});
}

nlohmann::json read_charts(const std::string& page) {
  const std::string start = "<script type=\"application/json\" id=\"charts\">";
  const auto begin = page.find(start) + start.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

std::string write_and_read(const TestFolder& folder, const std::vector<records::CellRecord>& cells,
                           const std::string& file) {
  std::vector<std::string> keys;
  for (const records::CellRecord& cell : cells) {
    records::write_cell(folder.path(), cell);
    keys.push_back(cell.key);
  }
  write_report(folder.path(), make_run(), keys);
  return read_text(folder.path() / file);
}

const document::ChartChoice* find_in(const std::vector<document::Block>& blocks, const std::string& id) {
  for (const document::Block& block : blocks) {
    if (const auto* choice = std::get_if<document::ChartChoice>(&block); choice && choice->id == id) return choice;
    const auto* details = std::get_if<document::Details>(&block);
    if (const auto* inside = details ? find_in(details->blocks, id) : nullptr) return inside;
  }
  return nullptr;
}

const document::ChartChoice& find_choice(const document::Section& section, const std::string& id) {
  if (const auto* found = find_in(section.blocks, id)) return *found;
  throw std::runtime_error("the section has no choice of charts " + id);
}

std::vector<std::string> list_titles(const document::Chart& chart) {
  std::vector<std::string> titles;
  for (const document::ChartSeries& series : chart.series) titles.push_back(series.title);
  return titles;
}

TEST(TradeSection, Fronts_AreChartsOfEveryErrorAndCost) {
  const auto cells = make_crossing_cells("cubes");
  const document::Section section = *make_trade_section(make_run(), cells);
  const document::ChartChoice& choice = find_choice(section, "front");
  ASSERT_THAT(choice.charts, SizeIs(16));
  EXPECT_THAT(choice.selectors[1].options, SizeIs(4));
  const document::Chart& chart = choice.charts[0];
  EXPECT_EQ(chart.id, "cubes.main.960x540.rmse.moving");
  EXPECT_THAT(chart.x_name, HasSubstr("CPU time (software rasteriser)"));
  ASSERT_THAT(chart.series, SizeIs(4)) << "the front, beaten, tied, members";
  const document::ChartSeries &line = chart.series[0], &beaten = chart.series[1], &tied = chart.series[2];
  EXPECT_THAT(line.points, SizeIs(3));
  EXPECT_EQ(line.line, document::LineStyle::kSteps);
  EXPECT_TRUE(beaten.faint);
  EXPECT_FALSE(tied.faint);
  EXPECT_FALSE(tied.filled);
  EXPECT_THAT(tied.points, SizeIs(2));
  EXPECT_THAT(chart.series[3].points, SizeIs(3));
  EXPECT_THAT(list_titles(chart), Each("")) << "labels at the marks, and no key";
  const document::ChartPoint& member = chart.series[3].points[0];
  EXPECT_EQ(member.label, "none");
  EXPECT_THAT(member.details,
              ElementsAre("none", "radius 0", "kernel: 0 texels (medium)", "map 1024 × 1024",
                          HasSubstr("RMSE to the area truth: 0.1 [0.099, 0.101]"),
                          HasSubstr("time of map, prefilter and filter, moving light: 4 ms"), "on the front"));
  EXPECT_EQ(member.opens, cells[0].key);
  EXPECT_EQ(member.group, "medium");
  for (const document::ChartSeries& series : chart.series)
    for (const document::ChartPoint& point : series.points) EXPECT_EQ(point.group, "medium") << series.title;
}

TEST(TradeSection, Fronts_OfALargeRun_LeaveOutWhatIsBeaten) {
  std::vector<records::CellRecord> cells;
  for (int light = 0; cells.size() <= kMostCellsInDetail; ++light) {
    for (records::CellRecord cell : make_crossing_cells("cubes")) {
      cell.light = std::to_string(light) + ",45";
      cells.push_back(cell);
    }
  }
  const document::Section section = *make_trade_section(make_run(), cells);
  const document::Chart& chart = find_choice(section, "front").charts[0];
  ASSERT_THAT(chart.series, SizeIs(3));
  EXPECT_THAT(chart.series[1].points, SizeIs(2)) << "tied";
  for (const document::ChartSeries& series : chart.series) EXPECT_FALSE(series.faint);
  const std::string page = document::write_html({"", {section}, {}});
  EXPECT_THAT(page, HasSubstr("more than 2000 cells: beaten ones"));
  EXPECT_THAT(write_trade(make_crossing_cells("cubes")), Not(HasSubstr("more than 2000 cells")));
}

TEST(TradeSection, FrontOfOnePoint_HasNoLine_AndNamesHaveSixDigits) {
  auto cells = make_crossing_cells("cubes");
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i].params["radius"] = 0.1f * static_cast<float>(i);
  const document::Section section = *make_trade_section(make_run(), cells);
  for (const document::Chart& chart : find_choice(section, "front").charts)
    for (const document::ChartSeries& series : chart.series) {
      if (series.line == document::LineStyle::kSteps) EXPECT_GT(series.points.size(), 1u) << chart.id;
      for (const document::ChartPoint& point : series.points) EXPECT_LT(point.label.size(), 24u) << point.label;
    }
}

TEST(TradeSection, CostOverWidth_IsAChartOfEachStateOfTheLight) {
  const auto cells = make_crossing_cells("cubes");
  const document::Section section = *make_trade_section(make_run(), cells);
  const document::ChartChoice& choice = find_choice(section, "width");
  ASSERT_THAT(choice.charts, SizeIs(2));
  EXPECT_EQ(choice.charts[0].id, "cubes.main.960x540.map1024.width.static");
  EXPECT_THAT(list_titles(choice.charts[0]), ElementsAre("none", "poisson", "vsm"));
  EXPECT_EQ(choice.charts[0].series[1].line, document::LineStyle::kDashed);
  EXPECT_EQ(choice.charts[0].series[2].line, document::LineStyle::kSolid) << "prefiltered";
}

TEST(TradeSection, MapsOfSeveralFits_AreACurveEach) {
  std::vector<CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({.map_size = 2048}), make_sweep_cell({})};
  cells[2].fit = "view";
  const document::Section section = *make_trade_section(make_run(), cells);
  const document::Chart& chart = find_choice(section, "maps").charts.at(0);
  EXPECT_THAT(list_titles(chart), ElementsAre("tight fit", "view fit"));
  EXPECT_THAT(chart.series[0].points, SizeIs(2));
  EXPECT_EQ(chart.series[0].points[1].label, "2048");
}

TEST(TradeSection, HostileTexts_EndNoElement) {
  std::vector<records::CellRecord> cells = make_crossing_cells(kHostile);
  for (records::CellRecord& cell : cells) {
    if (cell.filter == "poisson") cell.filter = kHostile;
    cell.params["name"] = std::string(kHostile);
    cell.images.picture = kHostile;
  }
  const std::string page = write_trade(cells);
  EXPECT_THAT(page, Not(HasSubstr("alert('1', \"2\")")));
  EXPECT_THAT(page, Not(HasSubstr("<!--")));
  const std::regex opening("<script"), closing("</script>");
  EXPECT_EQ(std::distance(std::sregex_iterator(page.begin(), page.end(), opening), {}), 2);
  EXPECT_EQ(std::distance(std::sregex_iterator(page.begin(), page.end(), closing), {}), 2);
  const nlohmann::json data = read_charts(page);
  EXPECT_EQ(data["charts"][0]["charts"][0]["series"].back()["points"][1][2], std::string(kHostile) + " (radius 2)");
}

TEST(TradeSection, Report_HasItBeforeTheEvidence) {
  const TestFolder folder;
  const std::string page = write_and_read(folder, make_crossing_cells("cubes"), "index.html");
  EXPECT_THAT(page, HasSubstr("<h2>The trade</h2>"));
  EXPECT_LT(page.find("id=\"trade\""), page.find("id=\"evidence\""));
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    EXPECT_NE(entry.path().filename().string().front(), '.');
}

TEST(TradeSection, OfAFewCells_IsNotThere) {
  const TestFolder folder;
  const std::string page =
      write_and_read(folder, {make_sweep_cell({}), make_sweep_cell({"cubes", "vsm"})}, "index.html");
  EXPECT_THAT(page, Not(HasSubstr("id=\"charts\"")));
  EXPECT_THAT(page, Not(HasSubstr("id=\"trade\"")));
}

}  // namespace
}  // namespace shadowbench::pages
