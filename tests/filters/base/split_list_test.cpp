#include "filters/base/split_list.h"

#include <gmock/gmock.h>

namespace shadowbench {
namespace {

using ::testing::ElementsAre;

TEST(SplitList, KeepsEmptyParts) {
  EXPECT_THAT(split_list("a,bc"), ElementsAre("a", "bc"));
  EXPECT_THAT(split_list(",a,,b,"), ElementsAre("", "a", "", "b", ""));
  EXPECT_THAT(split_list(""), ElementsAre(""));
  EXPECT_THAT(split_list("a · b,c", " · "), ElementsAre("a", "b,c"));
}

}  // namespace
}  // namespace shadowbench
