// Cells that several kinds of machine measured: their times are not compared.

#include <gmock/gmock.h>

#include "report/analysis/advice_words.h"
#include "report/analysis/findings.h"
#include "report/analysis/trade.h"
#include "report/records/records.h"
#include "tests/report/analysis/mixed_cells.h"

namespace shadowbench::analysis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

TEST(MixedMachines, OneKind_CellsCompareAsTheyAre) {
  std::vector<records::CellRecord> cells = make_mixed_cells();
  for (records::CellRecord& cell : cells) cell.machine.reset();
  EXPECT_FALSE(withhold_mixed_times(cells)) << "cells of before";
  for (records::CellRecord& cell : cells) cell.machine = make_kind("A CPU");
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
  std::vector<records::CellRecord> cells = make_mixed_cells();
  cells[0].absent["time_ms.prefilter"] = "none is needed";
  const records::CellRecord cell = withhold_mixed_times(cells).value().front();
  EXPECT_FALSE(frame_time(cell, LightMotion::kMoving) || frame_time(cell, LightMotion::kStatic));
  for (const char* field : {"time_ms.prefilter", "time_ms.moving"})
    EXPECT_THAT(records::explain_absence(cell, field), HasSubstr("times do not compare")) << field;
}

TEST(MixedMachines, WithoutEstimates_NothingIsAdvised_AndOneSentenceSaysWhy) {
  const auto cells = *withhold_mixed_times(make_mixed_cells());
  AdviceRequest request;
  request.cheapest = choose_cost(cells);
  const Advice advice = advise(cells, request);
  EXPECT_THAT(advice.keeping, IsEmpty());
  EXPECT_THAT(describe_failure(advice), HasSubstr("several kinds of machine measured the run"));
}

TEST(MixedMachines, BytesAreComparedAllTheSame) {
  const auto cells = *withhold_mixed_times(make_mixed_cells());
  AdviceRequest request;
  request.cheapest = CostKind::kBytes;
  request.whole = true;
  EXPECT_THAT(advise(cells, request).keeping, SizeIs(3));
}

/// Also where one of the machines has a GPU: its times are left out too.
TEST(MixedMachines, CostIsAnEstimateWhereThereIsOne_AndNoTime) {
  std::vector<records::CellRecord> cells = make_mixed_cells();
  EXPECT_EQ(choose_cost(cells), CostKind::kTime);
  for (records::CellRecord& cell : cells) {
    cell.gpu.emplace();
    (*cell.gpu)["navi21"].estimate = records::GpuEstimateRecord{};
  }
  EXPECT_EQ(choose_cost(cells), CostKind(CostKind::kGpu, "navi21"));
  for (const Quantity& cost : list_cost_measures(cells)) EXPECT_FALSE(cost.is(CostKind::kTime)) << cost.id;
  for (records::CellRecord& cell : cells) cell.machine = cells[2].machine;
  EXPECT_EQ(choose_cost(cells), CostKind::kTime) << "of one GPU";
}

}  // namespace
}  // namespace shadowbench::analysis
