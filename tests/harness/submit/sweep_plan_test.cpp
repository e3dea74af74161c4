#include "harness/submit/sweep_plan.h"

#include <gmock/gmock.h>

namespace shadowbench::submit {
namespace {

using ::testing::ElementsAre;
using Range = options::CellRange;

TEST(SplitEvenly, OfWhatGoesUp_IsEqual) {
  EXPECT_THAT(split_evenly(6, 3), ElementsAre(Range{0, 2}, Range{2, 4}, Range{4, 6}));
  EXPECT_THAT(split_evenly(2, 1), ElementsAre(Range{0, 2}));
  EXPECT_THAT(split_evenly(0, 3), ElementsAre());
}

TEST(SplitEvenly, OfAnyCells_HoldsEachOnce_AndNoStretchIsEmptyOrMoreThanOneLonger) {
  for (int cells = 1; cells <= 60; ++cells) {
    for (int tasks = 1; tasks <= 70; ++tasks) {
      const std::vector<Range> ranges = split_evenly(cells, tasks);
      EXPECT_EQ(ranges.size(), static_cast<std::size_t>(std::min(cells, tasks)));
      int at = 0;
      for (const Range& range : ranges) {
        EXPECT_EQ(range.begin, at);
        EXPECT_GE(range.end - range.begin, std::max(cells / tasks, 1));
        EXPECT_LE(range.end - range.begin, cells / tasks + 1);
        at = range.end;
      }
      EXPECT_EQ(at, cells);
    }
  }
  EXPECT_EQ(split_evenly(2000000000, 1000).back(), (Range{1998000000, 2000000000}));
}

}  // namespace
}  // namespace shadowbench::submit
