// What the report says of GPUs, on cells made by hand.

#include "report/analysis/gpu_costs.h"

#include <gmock/gmock.h>

#include "tests/report/records/synthetic.h"

namespace shadowbench::analysis {
namespace {

using records::CellRecord;
using ::testing::HasSubstr;

/// What a million lookups take of a frame's.
double to_us(double ms) { return 1e3 * ms / 2.0736; }

/// A cell whose frame takes `ms` here, and `gpu_ms` on a GPU.
CellRecord make_gpu_cell(const std::string& filter, double ms, double gpu_ms) {
  CellRecord cell = records::make_cell("cubes", filter, 4.0);
  cell.time_ms.moving = records::OwnTime{{ms, ms, ms, 3}, {ms, ms}};
  records::ShaderFacts lookup, empty;
  lookup.instructions = 50;
  lookup.compares = 4;
  lookup.loads = 2;
  lookup.vector_registers = 24;
  empty.instructions = 27;
  empty.loads = 1;
  cell.gpu = {
      {"one",
       {{{"empty", 1, empty}, {"lookup", 1, lookup}}, records::GpuEstimateRecord{.lookup_us = to_us(gpu_ms)}, ""}}};
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
    for (CellRecord& cell : cells)
      cell.machine = records::MachineKind{"CPU", 2, "renderer", software, records::TimerKind::kWallClock};
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
  cells.back().status = records::CellStatus::kSuspect;
  const records::TextTable table = make_gpu_table(Costs(cells).costs);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0].front(), "b");
  EXPECT_EQ(table.rows[1].front(), "a");
  EXPECT_EQ(table.rows[1].size(), table.header.size());
  EXPECT_EQ(table.rows[1][1], "30");
  EXPECT_EQ(table.rows[1][2], "1");
  EXPECT_EQ(table.rows[1][3], "30");
  EXPECT_EQ(table.rows[1][4], "0");
  EXPECT_EQ(table.rows[1][7], "23");
  EXPECT_EQ(table.rows[1][8], "5");
}

}  // namespace
}  // namespace shadowbench::analysis
