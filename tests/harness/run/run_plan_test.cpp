#include "harness/run/run_plan.h"

#include <nlohmann/json.hpp>

#include "harness/run/merge.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/measures.h"
#include "report/pages/advice_text.h"
#include "report/pages/answer.h"
#include "report/pages/run_page.h"
#include "report/records/json_io.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::run {
namespace {

using analysis::CostKind;
using analysis::LightMotion;
using records::CellRecord;

// Which finished cells a run goes on with: none that was made from something else.

constexpr const char* kRenderer = "a GL";

/// A folder in which one cell of a user's filter was measured.
class FinishedCell : public ::testing::Test {
 protected:
  const TestFolder folder_;
  const std::string filter_ = read_text(SHADOWBENCH_SOURCE_DIR "/filters/pcss.glsl");
  options::RunOptions options_;

  void SetUp() override {
    options_.resources = options::find_resources();
    options_.scenes = {"ball"};
    options_.out = folder_.path() / "out";
    write_filter(filter_);
    options_.reference = options_.filters.front();
    const RunPlan plan = make_plan(options_, kRenderer);
    records::CellRecord cell;
    cell.key = plan.tasks.at(0).keys.at(0);
    cell.content = plan.tasks.at(0).contents.at(0);
    cell.machine = records::MachineKind{.cpu = "", .renderer = kRenderer};
    records::write_cell(options_.out, cell);
    ASSERT_TRUE(is_finished());
  }

  void write_filter(const std::string& text) {
    const std::filesystem::path file = folder_.write("mine.glsl", text);
    filters::Catalogue catalogue(options_.resources.filters);
    catalogue.add_user_file(file);
    options_.filters = catalogue.parse_requests("mine");
  }

  bool is_finished() const { return make_plan(options_, kRenderer).finished == 1; }
};

/// The text of front matter counts as it is, and so does every key of it.
TEST_F(FinishedCell, AnyLineOfFrontMatter_AsksForANewMeasurement) {
  for (std::size_t at = filter_.find('\n'); at < filter_.find("+++*/"); at = filter_.find('\n', at + 1)) {
    write_filter(std::string(filter_).insert(at, " "));
    EXPECT_FALSE(is_finished()) << filter_.substr(0, at);
  }
  write_filter(filter_);
  EXPECT_TRUE(is_finished());
}

TEST_F(FinishedCell, WhatTheFilterIncludes_AsksForANewMeasurement) {
  const std::filesystem::path shaders = folder_.path() / "shaders";
  std::filesystem::copy(options_.resources.shaders, shaders, std::filesystem::copy_options::recursive);
  options_.resources.shaders = shaders;
  EXPECT_TRUE(is_finished());
  std::ofstream(shaders / "lib" / "disk.glsl", std::ios::app) << "// more\n";
  EXPECT_FALSE(is_finished());
}

TEST_F(FinishedCell, MoreTime_AsksForANewMeasurement) {
  options_.cell_timeout_s *= 2.0;
  EXPECT_FALSE(is_finished());
}

TEST(JoinRuns, FilesThatWereNamedElsewhere_AreForgotten_AndBuiltInScenesAreKept) {
  records::RunRecord first, second;
  first.scenes = {{"cubes", "", {"cubes"}}, {"three_lights.sun", "", {"three_lights", "--light-name", "sun"}}};
  second.scenes = {{"tree", "", {"models/tree.obj", "--ground"}}};
  second.filter_files = first.filter_files = {{"mine", "filters/mine.glsl"}};
  const records::RunRecord whole = join_runs({first, second});
  ASSERT_EQ(whole.scenes.size(), 3u);
  EXPECT_THAT(whole.scenes[0].view_words, ElementsAre("cubes"));
  EXPECT_THAT(whole.scenes[1].view_words, ElementsAre("three_lights", "--light-name", "sun"));
  EXPECT_THAT(whole.scenes[2].view_words, IsEmpty());
  ASSERT_EQ(whole.filter_files.count("mine"), 1u);
  EXPECT_FALSE(whole.filter_files.at("mine"));
}

// One cost is chosen, and one cell has the same number of it wherever it is told.

/// A cell that `ms` were measured of, and whose estimate has `us` a million receivers and of its prefilter.
CellRecord make_cell(const std::string& filter, double ms, double us) {
  CellRecord cell = records::make_attributed_cell(filter, ms / 100.0, {});
  cell.machine = records::kind_of(records::make_run().machine, records::make_run().gl);
  cell.time_ms.moving = records::OwnTime{{ms, 0.99 * ms, 1.01 * ms, 9}, {0.98 * ms, 1.02 * ms}};
  cell.time_ms.static_light = records::OwnTime{{0.5 * ms, 0.4 * ms, 0.6 * ms, 9}, {-0.1, ms}};
  cell.gpu = {
      {"navi21", {{}, records::GpuEstimateRecord{.lookup_us = us, .prefilter_us = us, .bound_by = "memory"}, {}}}};
  cell.key = records::cell_key(cell);
  return cell;
}

std::vector<CellRecord> make_cells() {
  return {make_cell("vsm", 9.0, 3.0), make_cell("none", 30.0, 7.0), make_cell("pcf2x2", 20.0, 5.0)};
}

/// What the chart of the fronts has of a cell at first.
double read_chart(const document::Page& page, const std::string& key) {
  for (const document::Section& section : page.sections)
    for (const document::Block& block : section.blocks)
      if (const auto* choice = std::get_if<document::ChartChoice>(&block); choice && choice->id == "front")
        for (const document::ChartSeries& series : choice->charts.front().series)
          for (const document::ChartPoint& point : series.points)
            if (point.opens == key) return point.x.value;
  return -1.0;
}

/// The cost that everything begins with, of a cell, everywhere it is told.
std::vector<double> list_told(const std::vector<CellRecord>& cells, const CellRecord& cell) {
  const document::Page page = pages::make_run_page(records::make_run(), cells);
  const std::string field = page.data["costs"][0]["field"];
  EXPECT_EQ(page.data["costs"][0]["id"], page.data["cost"]);
  std::vector<double> told = {read_chart(page, cell.key)};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (page.data["cells"][i]["key"] != cell.key) continue;
    told.push_back(page.data["cells"][i]["values_of"][field]);
    told.push_back(page.data["configurations"][i][field]);
    told.push_back(page.data["scopes"][0]["rows"][i][field]);
    told.push_back(page.data["scopes"][0]["rows"][i]["worst"][field]["value"]);
  }
  analysis::AdviceRequest request = pages::choose_request(cells);
  request.whole = true;
  const auto advice = pages::make_advice_json(records::make_run(), analysis::advise(cells, request));
  EXPECT_EQ(advice["keeping"][0]["cells"][0]["key"], cell.key);
  told.push_back(advice["keeping"][0]["cost"]["mean"]);
  told.push_back(advice["keeping"][0]["cells"][0]["cost"]);
  told.push_back(advice["picks"][0]["cost"]);
  return told;
}

TEST(OneCost, WhereNoGpuDrew_IsTheEstimateOfAFrame_Everywhere) {
  const std::vector<CellRecord> cells = make_cells();
  const CellRecord& cell = cells[0];
  const double ms = (3.0 * 2.0736 + 3.0) / 1000.0, still = 3.0 * 2.0736 / 1000.0;
  EXPECT_THAT(list_told(cells, cell), Each(::testing::DoubleNear(ms, 1e-15)));
  const auto record = records::to_json(cell)["gpu"]["navi21"]["frame_ms"];
  EXPECT_DOUBLE_EQ(record["moving"], ms);
  EXPECT_DOUBLE_EQ(record["static"], still);
}

TEST(OneCost, WhereAGpuDrew_IsItsTime_Everywhere) {
  std::vector<CellRecord> cells = make_cells();
  for (CellRecord& cell : cells) cell.machine->software = false;
  EXPECT_THAT(list_told(cells, cells[0]), Each(9.0));
}

// A row of another renderer has no machine of this run.
TEST(OneCost, RowsOfOtherRenderers_ChooseNothing) {
  std::vector<CellRecord> cells = make_cells();
  cells.push_back(cells[0]);
  cells.back().external.emplace();
  cells.back().machine.reset();
  EXPECT_EQ(analysis::choose_cost(cells), CostKind(CostKind::kGpu, "navi21"));
}

TEST(OneCost, SaysOfWhichFrameItIs_AndWhatIsLeftOut) {
  const std::vector<CellRecord> cells = make_cells();
  const auto meaning = [&](const CostKind& cost, LightMotion light) {
    return analysis::make_frame_measure(cost, light, analysis::point_to(cells)).meaning;
  };
  const CostKind estimate(CostKind::kGpu, "navi21");
  EXPECT_EQ(meaning(estimate, LightMotion::kMoving),
            "ms of a 1920x1080 frame with one map, estimated for navi21, moving light: a lower bound of the map, "
            "prefilter and lookups; left out: what every lookup pays. Published times were missed by a factor of at "
            "most 1.6");
  EXPECT_THAT(meaning(estimate, LightMotion::kStatic), HasSubstr("static light: lookups; left out: what every lookup"));
  EXPECT_THAT(meaning(CostKind::kTime, LightMotion::kMoving),
              HasSubstr("ms of a 960x540 frame with one map, measured, moving light: map, prefilter and lookups"));
  const document::Page page = pages::make_run_page(records::make_run(), cells);
  EXPECT_EQ(page.data["costs"][0]["text"], meaning(estimate, LightMotion::kMoving));
  EXPECT_EQ(page.data["costs"][3]["text"], meaning(CostKind::kTime, LightMotion::kStatic));
}

}  // namespace
}  // namespace shadowbench::run
