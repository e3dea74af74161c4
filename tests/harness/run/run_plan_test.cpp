#include "harness/run/run_plan.h"

#include <nlohmann/json.hpp>

#include "filters/front_matter.h"
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

/// A filter's file that has every key of front matter but `weights`, which stands in for a kernel's shape.
constexpr const char* kFilter = R"(/*+++
title = "t"
source = "s"
kind = "bound"
bound_at_zero = "least"
store = ["rg32f", "rg16f"]
combine = "linear"
sample = "linear"
samples = 1
claims = ["one"]
radius_texels = "radius"
bias_texels = 1.5
teaching = false
moments = true
exponent = "c"
variance_floor = "least"
kernel = {shape = "gaussian:radius", read = "bilinear"}
[param.radius]
default = 3
min = 0
max = 9
unit = "texels"
text = "r"
[param.c]
default = 2.0
choices = [2.0, 3.0]
text = "c"
[param.least]
default = 0.0
min = 0.0
max = 0.5
text = "l"
[param.n]
const = true
default = 4
min = 1
max = 16
text = "n"
[param.m]
const = true
default = 4
min = 1
max = 16
text = "m"
[disk.points]
count = "n"
seed = 1
pattern = "vogel"
[pass.sum]
store = "rg32f"
steps = "levels"
size = "full"
anisotropy = 1
[screen.blur]
reach = 1
steps = 2
+++*/
#include "lib/disk.glsl"
vec4 encode(EncodeInput e) { return vec4(e.depth); }
vec4 sum(PassInput p) { return vec4(0.0); }
vec2 blur(ScreenInput s) { return vec2(0.0); }
float visibility(Receiver r) { return 1.0; }
)";

/// Of every key a line, or a part of one, and what to put there.
const std::map<std::string, std::pair<std::string, std::string>> kChanges = {
    {".title", {"\"t\"", "\"other\""}},
    {".source", {"\"s\"", "\"other\""}},
    {".kind", {"kind = \"bound\"\nbound_at_zero = \"least\"", "kind = \"other\""}},
    {".store", {"[\"rg32f\", \"rg16f\"]", "[\"rg16f\", \"rg32f\"]"}},
    {".combine", {"combine = \"linear\"", "combine = [\"linear\", \"log\"]"}},
    {".sample", {"sample = \"linear\"", "sample = [\"linear\", \"nearest\"]"}},
    {".samples", {"samples = 1", "samples = [1, 2]"}},
    {".claims", {"\"one\"", "\"two\""}},
    {".radius_texels", {"radius_texels = \"radius\"", "radius_texels = 3"}},
    {".bias_texels", {"bias_texels = 1.5", "bias_texels = 0"}},
    {".teaching", {"teaching = false", "teaching = true"}},
    {".moments", {"moments = true\nexponent = \"c\"\nvariance_floor = \"least\"", "moments = false\nexponent = \"c\""}},
    {".exponent", {"exponent = \"c\"\n", ""}},
    {".variance_floor", {"variance_floor = \"least\"\n", ""}},
    {".bound_at_zero", {"bound_at_zero = \"least\"\n", ""}},
    {".param", {"[disk.points]", "[param.more]\ndefault = true\ntext = \"m\"\n[disk.points]"}},
    {".disk", {"[pass.sum]", "[disk.more]\ncount = \"n\"\n[pass.sum]"}},
    {".kernel", {"kernel = {shape = \"gaussian:radius\", read = \"bilinear\"}\n", ""}},
    {".pass", {"[pass.sum]\nstore = \"rg32f\"\nsteps = \"levels\"\nsize = \"full\"\nanisotropy = 1\n", ""}},
    {".screen", {"[screen.blur]\nreach = 1\nsteps = 2\n", ""}},
    {"param.default", {"default = 3", "default = 4"}},
    {"param.min", {"min = 0\n", "min = 1\n"}},
    {"param.max", {"max = 9", "max = 10"}},
    {"param.choices", {"[2.0, 3.0]", "[2.0, 4.0]"}},
    {"param.unit", {"unit = \"texels\"", "unit = \"t\""}},
    {"param.text", {"\"r\"", "\"other\""}},
    {"param.const", {"choices = [2.0, 3.0]", "choices = [2.0, 3.0]\nconst = true"}},
    {"disk.count", {"count = \"n\"", "count = \"m\""}},
    {"disk.seed", {"seed = 1", "seed = 2"}},
    {"disk.pattern", {"pattern = \"vogel\"", "pattern = \"blue-noise\""}},
    {"pass.store", {"[pass.sum]\nstore = \"rg32f\"", "[pass.sum]\nstore = \"rg16f\""}},
    {"pass.steps", {"steps = \"levels\"", "steps = \"once\""}},
    {"pass.size", {"size = \"full\"", "size = \"half\""}},
    {"pass.anisotropy", {"anisotropy = 1", "anisotropy = 4"}},
    {"screen.reach", {"reach = 1", "reach = 2"}},
    {"screen.steps", {"steps = 2", "steps = 3"}},
    {"kernel.shape", {"gaussian:radius", "box:3"}},
    {"kernel.weights", {"shape = \"gaussian:radius\"", "weights = [1, 2, 1]"}},
    {"kernel.read", {"read = \"bilinear\"", "read = \"nearest\""}},
};

std::string replace_once(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// A folder in which one cell of a user's filter was measured.
class FinishedCell : public ::testing::Test {
 protected:
  const TestFolder folder_;
  options::RunOptions options_;

  void SetUp() override {
    options_.resources = options::find_resources();
    options_.scenes = {"ball"};
    options_.out = folder_.path() / "out";
    write_filter(kFilter);
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

TEST_F(FinishedCell, AnyKeyOfFrontMatter_AsksForANewMeasurement) {
  for (const auto& [table, keys] : filters::front_matter_keys()) {
    for (const std::string& key : keys) {
      SCOPED_TRACE(table + "." + key);
      const auto change = kChanges.find(table + "." + key);
      ASSERT_NE(change, kChanges.end()) << "say how this key may change";
      write_filter(replace_once(kFilter, change->second.first, change->second.second));
      EXPECT_FALSE(is_finished());
    }
  }
  write_filter(kFilter);
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
