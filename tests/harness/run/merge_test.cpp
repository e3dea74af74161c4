#include "harness/run/merge.h"

#include <gmock/gmock.h>

namespace shadowbench::run {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

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

}  // namespace
}  // namespace shadowbench::run
