#include "harness/submit/partition.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace shadowbench::submit {
namespace {

using ::testing::ElementsAre;

TEST(Partition, OfEqualCells_IsEven) {
  using Range = options::CellRange;
  EXPECT_THAT(split_evenly({1, 1, 1, 1, 1, 1}, 3), ElementsAre(Range{0, 2}, Range{2, 4}, Range{4, 6}));
  EXPECT_THAT(split_evenly({1, 1}, 1), ElementsAre(Range{0, 2}));
}

TEST(Partition, OfACellThatOutweighsAll_HasNoEmptyStretch) {
  using Range = options::CellRange;
  EXPECT_THAT(split_evenly({1, 100, 1}, 3), ElementsAre(Range{0, 1}, Range{1, 2}, Range{2, 3}));
  EXPECT_THAT(split_evenly({100, 1, 1}, 3), ElementsAre(Range{0, 1}, Range{1, 3}));
}

TEST(Partition, OfAnyCells_HoldsEachOnce_AndNoStretchCostsMoreThanItsShareAndOneCell) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    std::vector<double> costs(std::uniform_int_distribution<std::size_t>(1, 300)(random));
    for (double& cost : costs) cost = std::exponential_distribution<double>(1.0)(random) + 1e-3;
    const int tasks = std::uniform_int_distribution<int>(1, static_cast<int>(costs.size()))(random);
    const double share = std::accumulate(costs.begin(), costs.end(), 0.0) / tasks;
    const double dearest = *std::ranges::max_element(costs);
    const auto ranges = split_evenly(costs, tasks);
    EXPECT_LE(ranges.size(), static_cast<std::size_t>(tasks));
    int at = 0;
    for (const options::CellRange& range : ranges) {
      EXPECT_EQ(range.begin, at);
      EXPECT_LT(range.begin, range.end);
      EXPECT_LE(std::accumulate(costs.begin() + range.begin, costs.begin() + range.end, 0.0), share + dearest);
      at = range.end;
    }
    EXPECT_EQ(at, static_cast<int>(costs.size()));
  }
}

}  // namespace
}  // namespace shadowbench::submit
