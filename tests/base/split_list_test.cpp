#include "base/split_list.h"

#include <gmock/gmock.h>

#include "base/error.h"

namespace shadowbench {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(SplitList, KeepsEmptyParts) {
  EXPECT_THAT(split_list("a,bc"), ElementsAre("a", "bc"));
  EXPECT_THAT(split_list(",a,,b,"), ElementsAre("", "a", "", "b", ""));
  EXPECT_THAT(split_list(""), ElementsAre(""));
  EXPECT_THAT(split_list("a · b,c", " · "), ElementsAre("a", "b,c"));
}

TEST(SplitAssignments, TakesKeysAndValues) {
  EXPECT_THAT(split_assignments("a=1,b", "--x"), ElementsAre(Pair("a", "1"), Pair("b", "")));
  EXPECT_THROW(split_assignments("a=1,a=2", "--x"), Error);
  EXPECT_THROW(split_assignments("", "--x"), Error);
}

}  // namespace
}  // namespace shadowbench
