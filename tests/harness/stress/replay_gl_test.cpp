// Mistakes of published comparisons, replayed.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>

#include "harness/stress/axis.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Replay, OfA16BitExponentialVarianceMap_ShowsBothRankings) {
  AxisInputs inputs = make_gl_inputs("vsm");
  inputs.out = std::filesystem::path(::testing::TempDir()) / fmt::format("replay{}", getpid());
  std::filesystem::create_directories(inputs.out);
  const std::vector<Exhibit> exhibits = choose_axes("warp-exponent")[0].make_exhibits(inputs);
  ASSERT_EQ(exhibits.size(), 1u);
  const auto& rows = exhibits[0].table->rows;
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_THAT(rows[0][0], HasSubstr("(c=10, radius=1, store=rg16f"));
  EXPECT_THAT(rows[0][1], Not(StartsWith("0 of")));
  EXPECT_EQ(rows[0][3], "3 of 3");
  EXPECT_THAT(rows[1][0], HasSubstr("(c=5.54, radius=1, store=rg16f"));
  EXPECT_THAT(rows[1][1], StartsWith("0 of"));
  EXPECT_EQ(rows[1][4], "1 of 3");
  EXPECT_TRUE(std::filesystem::exists(inputs.out / exhibits[0].pictures.front().file));
  std::filesystem::remove_all(inputs.out);
}

}  // namespace
}  // namespace shadowbench::stress
