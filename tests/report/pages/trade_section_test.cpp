#include "report/pages/trade_section.h"

#include <nlohmann/json.hpp>
#include <regex>

#include "report/analysis/advice_words.h"
#include "report/analysis/cells.h"
#include "report/pages/advice_text.h"
#include "report/pages/run_page.h"
#include "report/pages/write_page.h"
#include "report/records/json_io.h"
#include "tests/report/analysis/trade_cells.h"
#include "tests/report/pages/answer.h"

namespace shadowbench::pages {
namespace {

using namespace analysis;
using namespace records;

constexpr const char* kHostile = "</script><script>alert('1', \"2\")</script><!--";

std::string write_trade(const std::vector<CellRecord>& cells) {
  return document::write_html({"", {*make_trade_section(make_run(), cells)}, {}});
}

const document::ChartChoice& find_choice(const document::Section& section, const std::string& id) {
  const auto* found = document::find_block<document::ChartChoice>(
      section.blocks, [&](const document::ChartChoice& choice) { return choice.id == id; });
  if (!found) throw std::runtime_error("the section has no choice of charts " + id);
  return *found;
}

std::vector<std::string> list_titles(const document::Chart& chart) {
  return list_each(chart.series, &document::ChartSeries::title);
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
  std::vector<CellRecord> cells;
  for (int light = 0; cells.size() <= kMostCellsInDetail; ++light) {
    for (CellRecord cell : make_crossing_cells("cubes")) {
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

TEST(TradeSection, MapsOfSeveralFits_CompeteForTheirBytes_AndHaveChartsOverTheWidthOfTheirOwn) {
  auto cells = make_crossing_cells("cubes");
  const std::size_t own = cells.size();
  for (std::size_t i = 0; i < own; ++i) {
    cells.push_back(cells[i]);
    cells.back().fit = "view";
  }
  const document::Section section = *make_trade_section(make_run(), cells);
  const document::Chart& chart = find_choice(section, "front").charts.at(3);
  EXPECT_EQ(chart.id, "cubes.main.960x540.rmse.bytes");
  std::vector<std::string> labels;
  for (const document::ChartSeries& series : chart.series)
    for (const document::ChartPoint& point : series.points)
      if (!point.label.empty()) labels.push_back(point.label);
  EXPECT_THAT(labels, SizeIs(2 * own));
  EXPECT_THAT(labels, ::testing::IsSupersetOf({"none, tight fit", "none, view fit"}));
  EXPECT_THAT(list_each(find_choice(section, "width").charts, &document::Chart::id),
              ElementsAre("cubes.main.960x540.map1024.tight-fit.width.static",
                          "cubes.main.960x540.map1024.tight-fit.width.moving",
                          "cubes.main.960x540.map1024.view-fit.width.static",
                          "cubes.main.960x540.map1024.view-fit.width.moving"));
}

TEST(TradeSection, HostileTexts_EndNoElement) {
  std::vector<CellRecord> cells = make_crossing_cells(kHostile);
  for (CellRecord& cell : cells) {
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
  const nlohmann::json data = nlohmann::json::parse(read_script(page, "charts"));
  EXPECT_EQ(data["charts"][0]["charts"][0]["series"].back()["points"][1][2], std::string(kHostile) + " (radius 2)");
}

TEST(TradeSection, OfAFewCells_IsNotThere) {
  const std::vector<CellRecord> cells = {make_sweep_cell({}), make_sweep_cell({"cubes", "vsm"})};
  EXPECT_FALSE(make_trade_section(make_run(), cells));
}

constexpr std::size_t kLongestLine = 100;

Demand max_rmse(double most) { return {&limit_of("error.rmse"), most}; }

CellRecord measure(const std::string& scene, const std::string& filter, double ms, double rmse) {
  CellRecord cell = make_scored_cell(scene, filter, ms, rmse);
  cell.ratio_to_none.moving = Ratio{ms / 4.0, {ms / 4.1, ms / 3.9}};
  return cell;
}

/// Three filters on two scenes, and the advice on them as text and as JSON.
class AdvisedCells : public ::testing::Test {
 protected:
  std::vector<CellRecord> cells_ = {measure("cubes", "none", 1.0, 0.04), measure("stack", "none", 1.0, 0.06),
                                    measure("cubes", "wide", 4.0, 0.02), measure("stack", "wide", 6.0, 0.0295),
                                    measure("cubes", "huge", 9.0, 0.01), measure("stack", "huge", 9.0, 0.01)};

  std::string write(std::vector<Demand> demands) const {
    return make_advice_text(make_run(), advise(cells_, {.demands = std::move(demands)}));
  }
  nlohmann::json write_json(std::vector<Demand> demands) const {
    return make_advice_json(make_run(), advise(cells_, {.demands = std::move(demands)}));
  }
};
using AdviceText = AdvisedCells;
using AdviceJson = AdvisedCells;
using Configurations = AdvisedCells;

std::vector<std::string> list_names(const nlohmann::json& json) {
  std::vector<std::string> names;
  for (const auto& [name, value] : json.items()) names.push_back(name);
  return names;
}

TEST_F(Configurations, CellsOfOneChoice_AreTogetherWhateverTheScene) {
  cells_[5].view = "top";
  const auto pointers = point_to(cells_);
  const auto configurations = list_configurations(pointers);
  ASSERT_EQ(configurations.size(), 3U);
  EXPECT_THAT(configurations[1].cells, ElementsAre(&cells_[2], &cells_[3]));
  EXPECT_EQ(configurations[0].surroundings, configurations[1].surroundings);
  const auto places = list_places(pointers);
  ASSERT_EQ(places.size(), 3U);
  EXPECT_EQ(describe_place(places[0], places), "cubes");
  EXPECT_EQ(describe_place(places[2], places), "stack (top)");
}

TEST_F(AdviceText, BeginsWithThePicks_ThenTheFastOne_OrWhatIsNearest) {
  EXPECT_THAT(write({max_rmse(0.03)}),
              HasSubstr("\nwide: 8.5 ms (CPU) a frame, moving light; cheapest of 2 on the front that keep the "
                        "limits\nwith a kernel of 0.65 texels (medium), radius 4, store rg32f\n"));
  EXPECT_THAT(write({}), HasSubstr("\nwide: 8.5 ms (CPU) a frame, moving light; cheapest of 2 on the front\n"));
  EXPECT_THAT(
      write({max_rmse(0.001)}),
      AllOf(StartsWith("Nothing fits.\n"),
            HasSubstr("Nearest to the limits:\n  huge  12.5 ms (CPU)  RMSE 0.01    breaks --max-rmse 0.001 with "
                      "0.01\n")));
}

TEST_F(AdviceText, ALimitKeptWithinTheIntervalOverPhases_SaysSo) {
  for (CellRecord& cell : cells_) cell.rmse_ci95 = Interval{*cell.error.rmse - 0.002, *cell.error.rmse + 0.002};
  EXPECT_THAT(write({max_rmse(0.03)}),
              HasSubstr("0.0295  stack  kept by less than its interval over the phases of the map reaches, 0.002\n"));
}

TEST_F(AdviceText, Evidence_IsQuoted) {
  const std::string text = write({max_rmse(0.03)});
  EXPECT_THAT(text,
              HasSubstr("  --max-rmse 0.03  0.0295  stack  kept by less than the truth's own standard error, 0.001\n"));
  EXPECT_THAT(text, HasSubstr("ms (CPU)"));
  EXPECT_THAT(text, HasSubstr("  stack  9.5       9.31 .. 9.69  1.5 [1.46, 1.54]  0.0295  4 MiB  4\n"));
  EXPECT_THAT(text, HasSubstr("Others on the front:\n  huge  12.5 ms (CPU)  RMSE 0.01\n"));
  EXPECT_THAT(text, HasSubstr("Cheaper, outside the limits:\n  none  4.5 ms (CPU)  RMSE 0.051  breaks --max-rmse 0.03 "
                              "with 0.06\n"));
  EXPECT_THAT(text, HasSubstr("3 of 3 configurations judged, on cubes, stack.\n"));
  EXPECT_THAT(text, HasSubstr("Times are CPU time"));
}

TEST_F(AdviceText, LimitOnTimeWithinTheSpread_IsSaid) {
  const Demand limit{&cost_spec(CostKind::kTime), 4.51};
  const std::string text = write({limit});
  EXPECT_THAT(text, HasSubstr("  --max-ms 4.51  4.5 ms (CPU)  cubes  its upper quartile, 4.59, is over it\n"));
}

TEST_F(AdviceText, WhatWasNotJudged_IsSaid) {
  cells_[0].error.rmse.reset();
  cells_[0].absent["error.rmse"] = "the cat slept on it";
  EXPECT_THAT(
      write({max_rmse(0.03)}),
      HasSubstr("2 of 3 configurations judged, on cubes, stack.\nNot judged, 1: no error.rmse on cubes: the cat slept "
                "on it.\n"));
}

TEST_F(AdviceText, Lines_FitATerminal) {
  cells_[0].error.rmse.reset();
  cells_[0].absent["error.rmse"] = std::string(40, 'x') + " " + std::string(40, 'y') + " and more of the same";
  for (const double most : {0.03, 0.001}) {
    std::istringstream text(write({max_rmse(most)}));
    for (std::string line; std::getline(text, line);) {
      const auto width = std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; });
      EXPECT_LE(static_cast<std::size_t>(width), kLongestLine) << line;
    }
  }
}

TEST_F(AdviceJson, Fields_AreTheSameWhateverTheAnswer) {
  const auto fits = write_json({max_rmse(0.03)});
  const auto nothing = write_json({max_rmse(0.001)});
  EXPECT_EQ(list_names(fits), list_names(nothing));
  EXPECT_EQ(fits["fits"], true);
  EXPECT_EQ(nothing["fits"], false);
  EXPECT_EQ(nothing["keeping"].size(), 0U);
  EXPECT_EQ(list_names(fits["keeping"][0]), list_names(nothing["failing"][0]));
}

TEST_F(AdviceJson, Claims_HaveNoSize) {
  for (CellRecord& cell : cells_) {
    cell.penumbra.growth = 1.0;
    if (cell.filter == "none") cell.claims = {"contact-hardening"};
  }
  const auto json = write_json({Demand()});
  EXPECT_EQ(json["keeping"][0]["limits"].dump(),
            R"([{"claim":"contact-hardening","kept":true,"option":"--requires"}])");
  EXPECT_EQ(json["failing"][0]["limits"][0]["kept"], false);
}

TEST_F(AdviceJson, LimitThatHasNothingToSeeInAScene_NamesIt) {
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (i % 2 == 0)
      cells_[i].artefact.leak = 0.0;
    else
      explain(cells_[i], "artefact.leak", {"too few", true});
  const Demand leak{&limit_of("artefact.leak"), 0.1};
  const auto limits = write_json({max_rmse(0.03), leak})["keeping"][0]["limits"];
  EXPECT_TRUE(limits[0]["nothing_to_see"].empty());
  EXPECT_EQ(limits[1]["nothing_to_see"].dump(), R"([{"reason":"too few","scene":"stack","view":"main"}])");
}

TEST_F(AdviceJson, Numbers_AreThoseOfTheCells) {
  const auto json = write_json({max_rmse(0.03)});
  EXPECT_EQ(json["software"], true);
  EXPECT_EQ(json["clock"], "CPU time (software rasteriser)");
  EXPECT_EQ(json["asked"]["limits"]["--max-rmse"], 0.03);
  EXPECT_EQ(json["keeping"][0]["settings"]["filter"], "wide");
  EXPECT_EQ(json["keeping"][0]["cost"]["mean"], 8.5);
  EXPECT_EQ(json["keeping"][0]["limits"][0]["worst"], 0.0295);
  EXPECT_EQ(json["keeping"][0]["limits"][0]["key"], cells_[3].key);
  EXPECT_EQ(json["keeping"][0]["limits"][0]["within_uncertainty"], true);
  EXPECT_EQ(json["keeping"][0]["cells"][1]["cost"], 9.5);
  EXPECT_EQ(json["failing"][0]["label"], "none");
  EXPECT_EQ(json["failing"][0]["limits"][0]["worst"], 0.06);
}

}  // namespace
}  // namespace shadowbench::pages
