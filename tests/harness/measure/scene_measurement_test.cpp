// A filter whose visibility is the same everywhere is suspect, by a truth made by hand.

#include "harness/measure/scene_measurement.h"

#include <gtest/gtest.h>

namespace shadowbench::measure {
namespace {

/// Checks a constant image of 400 receivers, half of them blocked; the others see `area` of the light, and `ratio` of
/// what is above their own plane.
records::CellStatus judge(float area, float ratio) {
  SceneTruth truth;
  truth.mask.assign(400, 1);
  truth.area = truth.ratio = images::Image(20, 20, 1);
  std::fill_n(truth.area.texels.begin(), 200, area);
  std::fill_n(truth.ratio.texels.begin(), 200, ratio);
  MeasuredCell cell;
  cell.visibility = images::Image(20, 20, 1);
  check_against_truth(cell, truth);
  return cell.record.status;
}

TEST(AConstant, IsSuspect_WhereReceiversAreWhollyLit) {
  EXPECT_EQ(judge(1.0f, 1.0f), records::CellStatus::kSuspect);
  EXPECT_EQ(judge(0.7f, 1.0f), records::CellStatus::kSuspect) << "their own plane hides the rest of the light";
  EXPECT_EQ(judge(0.7f, 0.9f), records::CellStatus::kOk) << "a penumbra";
}

}  // namespace
}  // namespace shadowbench::measure
