#include "report/analysis/findings.h"

#include "reference/metrics/error_stats.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cells.h"
#include "report/analysis/gpu_costs.h"
#include "report/analysis/measures.h"
#include "report/analysis/trade.h"
#include "tests/report/analysis/trade_cells.h"

namespace shadowbench::analysis {
namespace {

using namespace records;

TEST(Summary, Numbers_HaveThreeDigits) {
  EXPECT_EQ(format_number(0.05124), "0.0512");
  EXPECT_EQ(format_number(4.0), "4");
  EXPECT_EQ(format_number(13.94), "13.9");
  EXPECT_EQ(format_number(99.96), "100");
  EXPECT_EQ(format_number(1240.4), "1240");
  EXPECT_EQ(format_number(4194304.0), "4194304");
}

TEST(Summary, SoftwareTimes_AreCalledCpuTime) {
  GlRecord gl = make_run().gl;
  EXPECT_EQ(describe_clock(gl), "CPU time (software rasteriser)");
  EXPECT_EQ(time_unit(gl), "ms (CPU)");
  gl.software = false;
  gl.timer = TimerKind::kTimerQuery;
  EXPECT_EQ(describe_clock(gl), "GPU time (timer query)");
  EXPECT_EQ(time_unit(gl), "ms (GPU)");
}

TEST(Summary, Groups_HoldOnlyWhatMayBeCompared) {
  std::vector<CellRecord> cells = {make_cell("cubes", "none", 4.0), make_cell("stack", "none", 4.0),
                                   make_cell("cubes", "vsm", 4.0), make_cell("cubes", "vsm", 4.0)};
  cells[3].map_size = 2048;
  const auto groups = group_cells(cells);
  ASSERT_THAT(groups, SizeIs(3));
  EXPECT_THAT(groups[0].cells, SizeIs(2));
  EXPECT_EQ(groups[1].scene, "stack");
  EXPECT_EQ(groups[2].cells[0].map_size, 2048);
}

TEST(Summary, OnlyAWrongRange_IsNamedInTheSettings) {
  CellRecord cell = make_cell("cubes", "none", 4.0);
  EXPECT_THAT(describe_settings(cell), Not(AnyOf(HasSubstr("outside"), HasSubstr("test off"))));
  cell.range = {filters::Border::kRepeat, false, false};
  EXPECT_THAT(describe_settings(cell), AllOf(HasSubstr("outside the map: repeat"), HasSubstr("far-plane test off"),
                                             HasSubstr("behind-the-light test off")));
}

TEST(Summary, Absences_AreCounted) {
  const auto counts = count_absences({make_cell("cubes", "a", 1.0), make_cell("cubes", "b", 1.0)});
  EXPECT_EQ(counts.at("error: no truth in this run"), 2);
}

TEST(Summary, ExperimentLine_SaysItsTitleAndWhichShardItIs) {
  RunRecord run = make_run();
  run.experiment = {"A sweep", "", 30, 1, 1};
  EXPECT_THAT(list_run_facts(run), Contains(Pair("experiment", "A sweep · 30 cells")));
  run.experiment = {"", "", 30, 2, 3};
  EXPECT_THAT(list_run_facts(run), Contains(Pair("experiment", "30 cells, shard 2 of 3")));
}

TEST(Summary, WorkLine_CountsTruthsTracedAndReadFromTheCache) {
  EXPECT_THAT(list_run_facts(make_run()),
              Contains(Pair("work",
                            "12 shader variants compiled, 40 passes run, 3 passes skipped because no "
                            "filter needed them, 5 truths ray traced, 2 truths read from the cache; 1.5 s of timed "
                            "passes in 2 s, of which attribution took 0.5 s")));
}

CellRecord make_light_cell(const SweepCell& from, double asked) {
  CellRecord cell = make_sweep_cell(from);
  cell.kernel.width_class = "light";
  cell.kernel.light_texels = asked;
  if (from.filter != "none") cell.kernel.by_light = "radius";
  cell.key = cell_key(cell);
  return cell;
}

/// On `ball` the filter is as wide as it should be, on `cubes` as narrow as it can.
std::vector<CellRecord> make_cells() {
  return {make_light_cell({.scene = "ball", .rmse = 0.1}, 4.0),
          make_light_cell({.scene = "ball", .filter = "vsm", .radius = 4.0, .rmse = 0.05}, 4.0),
          make_light_cell({.scene = "cubes", .rmse = 0.1}, 0.2),
          make_light_cell({.scene = "cubes", .filter = "vsm", .radius = 0.4, .rmse = 0.2}, 0.2)};
}

TEST(LightWidths, OneFilter_IsOneConfigurationOnAllScenes) {
  const auto cells = make_cells();
  const auto configurations = list_configurations(point_to(cells));
  ASSERT_THAT(configurations, SizeIs(2));
  EXPECT_EQ(configurations[1].name, "vsm");
  EXPECT_EQ(describe_kernel(configurations[1]), "0.4 .. 4 texels (light)");
  const auto scopes = make_trade_scopes(cells);
  ASSERT_THAT(scopes, SizeIs(3));
  EXPECT_THAT(scopes[0].configurations, SizeIs(2));
  const auto points = list_points(scopes[0], list_error_measures()[0], list_cost_measures(cells)[kMovingCost]);
  ASSERT_THAT(points, SizeIs(2));
  EXPECT_EQ(name_class(points[0].group), "light") << "none is compared with them";
}

CellRecord make_stable_cell() {
  CellRecord cell = make_cell("cubes", "odd", 4.0);
  cell.params = {{"k", 20.0}, {"store", std::string("r16f")}};
  cell.map_size = 100;
  cell.stability = {0, 0, 0, 1e-7, 2.5, 11.08, 0.001, 0.0001, 0.0, 0, 0};
  return cell;
}

TEST(StabilityWords, NothingBreaks_NothingIsSaid) {
  EXPECT_THAT(describe_stability({"cubes", {make_stable_cell(), make_cell("cubes", "none", 1.0)}}), IsEmpty());
  EXPECT_EQ(caption_texels(make_cell("cubes", "none", 1.0)), "");
  EXPECT_EQ(caption_bound(make_stable_cell()), "kept at every receiver");
  EXPECT_THAT(caption_texels(make_stable_cell()),
              AllOf(HasSubstr("r16f holds numbers up to 65504 (e^11.09)"), HasSubstr("2.5 left"),
                    HasSubstr("safe up to an exponent of 11.08")));
}

TEST(StabilityWords, Overflow_NamesLimitAndSafeValue) {
  CellRecord cell = make_stable_cell();
  cell.stability.overflow_texels = 290;
  cell.stability.nan_texels = 10;
  cell.stability.headroom.reset();
  const auto sentences = describe_stability({"cubes", {cell}});
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(sentences[0],
            "odd: 3 % of its map's texels overflowed: r16f holds numbers up to 65504 (e^11.09); an "
            "exponent "
            "of 11.08 is safe here.");
}

TEST(StabilityWords, EveryTrouble_HasItsSentence) {
  CellRecord cell = make_stable_cell();
  cell.stability.negative_variance_texels = 5000;
  cell.stability.lowest_variance = -7.2e-4;
  cell.stability.half_difference_max = 0.25;
  cell.stability.half_difference_rms = 0.0125;
  cell.stability.bound_shortfall_max = 0.125;
  cell.stability.bound_violations = 7;
  cell.stability.bound_exact_violations = 8;
  const auto sentences = describe_stability({"cubes", {cell}});
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_THAT(sentences[0],
              HasSubstr("the variance of 50 % of its map's texels is below 0 before the clamp, down to -0.00072"));
  EXPECT_THAT(sentences[1], HasSubstr("visibility is up to 0.25 off that of the 32-bit store (RMS 0.0125)"));
  EXPECT_THAT(sentences[2], AllOf(HasSubstr("by up to 0.125; at 7 receivers by more than rounding explains"),
                                  HasSubstr("at 8 in exact arithmetic")));
}

TEST(FindDominatingPart, IsTheOnlyOneAboveHalf) {
  EXPECT_EQ(find_dominating_part({0.0, 0.51, 0.0, 0.49}), 1u);
  EXPECT_EQ(find_dominating_part({0.0, 0.5, 0.5, 0.0}), std::nullopt);
  EXPECT_EQ(find_dominating_part({0.0, 0.9, 0.8, -0.7}), std::nullopt);
  EXPECT_EQ(find_dominating_part({-0.3, -0.3, 0.2, 1.4}), 3u);
}

TEST(LostInTruth, IsAnErrorThatTheTruthsOwnExplains) {
  EXPECT_TRUE(is_lost_in_truth(make_attributed_cell("vsm", 0.001, {0.0, 0.7, 0.1, 0.2})));
  EXPECT_FALSE(is_lost_in_truth(make_attributed_cell("vsm", 0.04, {0.0, 0.7, 0.1, 0.2})));
  EXPECT_FALSE(is_lost_in_truth(make_cell("cubes", "vsm", 4.0)));
}

// Cells that several kinds of machine measured: their times are not compared.

TEST(MixedMachines, OneKind_CellsCompareAsTheyAre) {
  std::vector<CellRecord> cells = make_mixed_cells();
  for (CellRecord& cell : cells) cell.machine.reset();
  EXPECT_FALSE(withhold_mixed_times(cells)) << "cells of before";
  for (CellRecord& cell : cells) cell.machine = make_kind("A CPU");
  EXPECT_FALSE(withhold_mixed_times(cells));
  EXPECT_FALSE(withhold_mixed_times({}));
  cells[2].machine.reset();
  EXPECT_TRUE(withhold_mixed_times(cells)) << "one that is not known is another one";
}

TEST(MixedMachines, WarningCountsTheCellsOfEachKind) {
  EXPECT_THAT(warn_of_mixed_machines(make_mixed_cells()),
              AllOf(StartsWith(std::string(kMixedMachines)), HasSubstr("A slow CPU, 4 cores"), HasSubstr("(2 cells)"),
                    HasSubstr("A fast CPU, 64 cores, A GPU, GPU time (timer query) (1 cell)")));
}

TEST(MixedMachines, HaveNoTimes_AndSayWhy) {
  std::vector<CellRecord> cells = make_mixed_cells();
  cells[0].absent["time_ms.prefilter"] = "none is needed";
  const CellRecord cell = withhold_mixed_times(cells).value().front();
  EXPECT_FALSE(frame_time(cell, LightMotion::kMoving) || frame_time(cell, LightMotion::kStatic));
  for (const char* field : {"time_ms.prefilter", "time_ms.moving"})
    EXPECT_THAT(explain_absence(cell, field), HasSubstr("times do not compare")) << field;
}

TEST(MixedMachines, WithoutEstimates_NothingIsAdvised_AndOneSentenceSaysWhy) {
  const auto cells = *withhold_mixed_times(make_mixed_cells());
  const Advice advice = advise(cells, {.cheapest = choose_cost(cells)});
  EXPECT_THAT(advice.keeping, IsEmpty());
  EXPECT_THAT(describe_failure(advice), HasSubstr("several kinds of machine measured the run"));
}

TEST(MixedMachines, BytesAreComparedAllTheSame) {
  const auto cells = *withhold_mixed_times(make_mixed_cells());
  EXPECT_THAT(advise(cells, {.cheapest = CostKind::kBytes, .whole = true}).keeping, SizeIs(3));
}

/// Also where one of the machines has a GPU: its times are left out too.
TEST(MixedMachines, CostIsAnEstimateWhereThereIsOne_AndNoTime) {
  std::vector<CellRecord> cells = make_mixed_cells();
  EXPECT_EQ(choose_cost(cells), CostKind::kTime);
  for (CellRecord& cell : cells) {
    cell.gpu.emplace();
    (*cell.gpu)["navi21"].estimate = GpuEstimateRecord{};
  }
  EXPECT_EQ(choose_cost(cells), CostKind(CostKind::kGpu, "navi21"));
  for (const Quantity& cost : list_cost_measures(cells)) EXPECT_FALSE(cost.is(CostKind::kTime)) << cost.id;
  for (CellRecord& cell : cells) cell.machine = cells[2].machine;
  EXPECT_EQ(choose_cost(cells), CostKind::kTime) << "of one GPU";
}

TEST(Measures, ErrorsDiffer_BeyondTheLargerStandardError_NotTheSumOfBoth) {
  EXPECT_FALSE(is_clearly_less_error({0.2, 0.199, 0.201}, {0.201, 0.2, 0.202}));
  EXPECT_TRUE(is_clearly_less_error({0.2, 0.199, 0.201}, {0.2015, 0.2005, 0.2025}));
}

/// Both move by 0.01 from group to group, and their difference by a hundredth of that.
TEST(Measures, ErrorsOfTheSamePhases_DifferByWhatTheirDifferencesSay) {
  const Estimate a{0.2, 0.18, 0.22, {0.19, 0.2, 0.2, 0.21}}, b{0.201, 0.18, 0.222, {0.1911, 0.2009, 0.201, 0.211}};
  EXPECT_TRUE(is_clearly_less_error(a, b));
  EXPECT_FALSE(is_clearly_less_error(b, a));
  EXPECT_FALSE(is_clearly_less_error(a, a));
  const Estimate gap = subtract(b, a);
  EXPECT_NEAR(gap.value, 0.001, 1e-12);
  EXPECT_NEAR(gap.high - gap.value, metrics::find_student_t(4) * std::sqrt(2e-8 / 3.0 / 4.0), 1e-9);
  Estimate other = b;
  other.replicates.pop_back();
  EXPECT_FALSE(is_clearly_less_error(a, other)) << "of other phases, and then within both intervals";
}

// What the report says of GPUs, on cells made by hand.

/// What a million lookups take of a frame's.
double to_us(double ms) { return 1e3 * ms / 2.0736; }

/// A cell whose frame takes `ms` here, and `gpu_ms` on a GPU.
CellRecord make_gpu_cell(const std::string& filter, double ms, double gpu_ms) {
  CellRecord cell = make_cell("cubes", filter, 4.0);
  cell.time_ms.moving = OwnTime{{ms, ms, ms, 3}, {ms, ms}};
  ShaderFacts lookup, empty;
  lookup.instructions = 50;
  lookup.compares = 4;
  lookup.loads = 2;
  lookup.vector_registers = 24;
  empty.instructions = 27;
  empty.loads = 1;
  cell.gpu = {
      {"one", {{{"empty", 1, empty}, {"lookup", 1, lookup}}, GpuEstimateRecord{.lookup_us = to_us(gpu_ms)}, ""}}};
  return cell;
}

struct Costs {
  explicit Costs(std::vector<CellRecord> made) : cells(std::move(made)) {}

  std::vector<CellRecord> cells;
  std::vector<Configuration> configurations = list_configurations(point_to(cells));
  std::vector<GpuCost> costs = list_gpu_costs(configurations, "one");
};

/// A CPU's times say nothing of a GPU: they are in no column.
TEST(GpuCosts, OfASoftwareRasteriser_NoTimesStandBesideEstimates) {
  std::vector<CellRecord> cells = {make_gpu_cell("a", 1, 10), make_gpu_cell("b", 2, 20), make_gpu_cell("c", 3, 30)};
  for (const bool software : {false, true}) {
    for (CellRecord& cell : cells) cell.machine = MachineKind{"CPU", 2, "renderer", software, TimerKind::kWallClock};
    const Costs costs(cells);
    EXPECT_EQ(std::ranges::count(make_gpu_table(costs.costs).header, "measured here, ms"), software ? 0 : 1);
  }
}

TEST(GpuCosts, WhatIsGuessedOrRefusedIsSaid) {
  std::vector<CellRecord> cells = {make_gpu_cell("a", 1, 30), make_gpu_cell("b", 2, 10), make_gpu_cell("c", 3, 20)};
  cells.push_back(make_gpu_cell("d", 4, 40));
  cells[1].gpu->at("one").facts[1].facts.loops = 1;
  cells[2].gpu->at("one").facts[1].facts.spilled_registers = 7;
  cells[3].gpu->at("one") = {{}, std::nullopt, "mine.glsl:8: Vulkan refuses"};
  const Costs costs(cells);
  const auto sentences = describe_gpu("one", costs.costs);
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_THAT(sentences[0], HasSubstr("d: mine.glsl:8: Vulkan refuses"));
  EXPECT_THAT(sentences[1], HasSubstr("how often loops turn: b."));
  EXPECT_THAT(sentences[2], HasSubstr("spill to memory, which is slow: c."));
}

TEST(GpuCosts, OfSeveralScenes_AreMeans) {
  std::vector<CellRecord> cells = {make_gpu_cell("a", 1, 10), make_gpu_cell("a", 3, 30)};
  cells[1].scene = "stack";
  cells[1].gpu->at("one").estimate->prefilter_us = 8000.0;
  cells[0].gpu->at("one").estimate->map_us = 2000.0;
  const Costs costs(cells);
  ASSERT_EQ(costs.costs.size(), 1u);
  EXPECT_DOUBLE_EQ(*costs.costs[0].estimate_ms, 25.0);
  EXPECT_DOUBLE_EQ(costs.costs[0].map_ms, 1.0);
  EXPECT_DOUBLE_EQ(costs.costs[0].lookup_ms, 20.0);
  EXPECT_DOUBLE_EQ(costs.costs[0].prefilter_ms, 4.0);
  EXPECT_DOUBLE_EQ(*costs.costs[0].measured_ms, 2.0);
}

TEST(GpuCosts, TheTableIsCheapestFirst_LessTheEmptyLookup) {
  std::vector<CellRecord> cells = {make_gpu_cell("a", 1, 30), make_gpu_cell("b", 2, 10)};
  cells.push_back(make_gpu_cell("wrong", 1, 1));
  cells.back().status = CellStatus::kSuspect;
  const TextTable table = make_gpu_table(Costs(cells).costs);
  ASSERT_THAT(table.rows, SizeIs(2));
  EXPECT_EQ(table.rows[0].front(), "b");
  const std::vector<std::string>& row = table.rows[1];
  ASSERT_EQ(row.size(), table.header.size());
  EXPECT_THAT(std::vector(row.begin(), row.begin() + 5), ElementsAre("a", "30", "1", "30", "0"));
  EXPECT_THAT(std::vector(row.begin() + 7, row.begin() + 9), ElementsAre("23", "5"));
}

}  // namespace
}  // namespace shadowbench::analysis
