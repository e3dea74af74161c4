// What the axes of extreme maps see without a GL.

#include <gmock/gmock.h>

#include "harness/stress/run_stress.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

TEST(Extremes, WithoutAGl_GlCasesSayThatThereIsNone) {
  for (const char* id : {"map-edge", "map-size", "poisoned-input"}) {
    for (const Case& item : choose_axes(id)[0].make_cases(make_inputs("none,vsm"))) {
      EXPECT_EQ(item.not_available.find("no GL") != std::string::npos, item.level == Level::kGl)
          << id << " " << item.variant;
    }
  }
}

TEST(PoisonedInput, ModelsKeepPoisonWithinTheKernel) {
  const Axis axis = choose_axes("poisoned-input")[0];
  int spread = 0;
  for (const Case& item : axis.make_cases(make_inputs(""))) {
    if (item.level != Level::kModel) continue;
    const records::StressCase found = find_onsets(item, axis);
    EXPECT_FALSE(found.broken) << item.filter << " " << item.variant << ": " << found.broken->why;
    if (found.degraded) ++spread;
  }
  EXPECT_GT(spread, 0) << "the poison does nothing, so nothing was shown";
}

}  // namespace
}  // namespace shadowbench::stress
