#include <gtest/gtest.h>

#include <algorithm>

#include "harness/gl/survey.h"
#include "tests/harness/gl/gl_fixture.h"

namespace shadowbench::gl {
namespace {

// What NUMBERS.md says of llvmpipe, found again.
TEST_F(GlTest, Measurement_OfLlvmpipe_IsWhatIsKnownOfIt) {
  for (const GLenum format : {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT32F}) {
    const WeightPrecision pcf = measure_pcf_weights(context(), format);
    EXPECT_EQ(pcf.bits, WeightPrecision::kMaxBits);
    EXPECT_EQ(pcf.max_error, 0.0);
  }
  const GlSurvey measured = survey_gl(context());
  EXPECT_TRUE(measured.r32f.exact());
  EXPECT_TRUE(measured.rg32f.exact());
  EXPECT_GT(measured.exp_ulp, 1.0);
  EXPECT_LT(measured.exp_ulp, 100.0);
}

TEST_F(GlTest, TimerQuery_OfLlvmpipe_IsNotBelieved) {
  const TimerCheck check = check_timer(context());
  EXPECT_GT(check.wall_ms, 1.0);
  EXPECT_LT(check.agreement, 0.9);
  EXPECT_EQ(choose_timer(context()), TimerKind::kWallClock);
}

TEST_F(GlTest, WallTime_GrowsWithTheWork) {
  SurveyShader probe("survey_load.frag", {256, 256});
  const auto time = [&](int iterations) {
    probe.program().set("u_iterations", iterations);
    double best = time_ms(TimerKind::kWallClock, [&] { probe.draw(); });
    for (int i = 0; i < 4; ++i) best = std::min(best, time_ms(TimerKind::kWallClock, [&] { probe.draw(); }));
    return best;
  };
  EXPECT_GT(time(400), 4.0 * time(20));
}

TEST_F(GlTest, WallTime_LeavesOutWhatWasQueuedBefore) {
  SurveyShader probe("survey_load.frag", {512, 512});
  probe.program().set("u_iterations", 400);
  const auto time_nothing = [&] {
    probe.draw();
    return time_ms(TimerKind::kWallClock, [] {});
  };
  probe.draw();
  const double one_draw = time_ms(TimerKind::kWallClock, [&] { probe.draw(); });
  EXPECT_LT(std::min({time_nothing(), time_nothing(), time_nothing()}), 0.2 * one_draw);
}

TEST_F(GlTest, QueryTime_IsPositive) {
  SurveyShader probe("survey_load.frag", {256, 256});
  probe.program().set("u_iterations", 100);
  EXPECT_GT(time_ms(TimerKind::kQuery, [&] { probe.draw(); }), 0.0);
}

}  // namespace
}  // namespace shadowbench::gl
