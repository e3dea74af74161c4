#include "report/document/chart_axis.h"

#include <gmock/gmock.h>

#include "report/document/chart.h"

namespace shadowbench::document {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(ChartAxis, IsLogarithmic_WhereValuesArePositiveAndFarApart) {
  const ChartAxis log = choose_axis({0.02, 0.2}, {-0.1, 0.3}, TickKind::kNumber);
  EXPECT_TRUE(log.log);
  EXPECT_GT(log.low, 0.0);
  EXPECT_GT(log.high, 0.3);
  EXPECT_THAT(log.ticks, Contains(std::pair<double, std::string>(0.1, "0.1")));
  EXPECT_FALSE(choose_axis({0.0, 0.2}, {}, TickKind::kNumber).log);
  EXPECT_FALSE(choose_axis({1.0, 1.1}, {}, TickKind::kNumber).log);
}

TEST(ChartAxis, HoldsItsTicks_WithZeroWrittenPlainly) {
  for (const auto& values : {std::vector{0.0, 1.0}, std::vector{0.03, 7.0}, std::vector{5.0, 5.0},
                             std::vector{0.0, 0.0}, std::vector{1e-5, 1e5}}) {
    const ChartAxis axis = choose_axis(values, {}, TickKind::kNumber);
    EXPECT_THAT(axis.ticks, Not(IsEmpty()));
    EXPECT_LE(axis.ticks.size(), 12u);
    for (const auto& [value, label] : axis.ticks) {
      EXPECT_GE(value, axis.low);
      EXPECT_LE(value, axis.high * (1.0 + 1e-9));
      EXPECT_NE(label, "-0");
    }
    EXPECT_LT(axis.low, values[0]);
    EXPECT_GT(axis.high, values[1]);
  }
}

TEST(ChartAxis, ForcedToRatios_HasTicksInANarrowRangeToo) {
  const ChartAxis axis = choose_log_axis({5.0, 5.1}, {});
  EXPECT_TRUE(axis.log);
  EXPECT_GE(axis.ticks.size(), 2u);
  EXPECT_TRUE(choose_log_axis({5.0}, {}).log);
}

TEST(ChartAxis, BytesAreInPowersOfTwo) {
  const ChartAxis axis = choose_axis({262144.0, 8388608.0}, {}, TickKind::kBytes);
  EXPECT_EQ(axis.ticks.front().second, "256 KiB");
  EXPECT_EQ(axis.ticks.back().second, "8 MiB");
}

TEST(ChartStyle, NeighboursDiffer_InColourAndShape) {
  for (std::size_t i = 0; i + 1 < 12; ++i) {
    EXPECT_STRNE(style_of(i).color, style_of(i + 1).color);
    EXPECT_NE(style_of(i).mark, style_of(i + 1).mark);
  }
}

}  // namespace
}  // namespace shadowbench::document
