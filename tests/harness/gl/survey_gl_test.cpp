#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/gl/survey.h"
#include "tests/harness/gl/gl_fixture.h"

namespace shadowbench::gl {
namespace {

using ::testing::HasSubstr;

const GlSurvey& measure_once(Context& context) {
  static const GlSurvey measured = survey_gl(context);
  return measured;
}

// What NUMBERS.md says of llvmpipe, found again.
TEST_F(GlTest, Measurement_OfLlvmpipe_IsWhatIsKnownOfIt) {
  const GlSurvey& measured = measure_once(context());
  for (const auto* format : {&measured.d16, &measured.d24, &measured.d32f}) {
    EXPECT_TRUE(format->pcf.exact());
    EXPECT_EQ(format->pcf.max_error, 0.0);
  }
  EXPECT_TRUE(measured.r32f.exact());
  EXPECT_TRUE(measured.rg32f.exact());
  EXPECT_EQ(measured.r8_levels, 256);
  EXPECT_NEAR(measured.slope_ratio, 1.0, 1e-3);
}

TEST_F(GlTest, OffsetUnit_OfLlvmpipe_FollowsTheFormat) {
  const GlSurvey& measured = measure_once(context());
  EXPECT_NEAR(std::log2(measured.d16.offset_unit_near), -15.0, 1e-3);
  EXPECT_NEAR(std::log2(measured.d16.offset_unit_far), -15.0, 1e-3);
  EXPECT_NEAR(std::log2(measured.d24.offset_unit_near), -23.0, 1e-3);
  EXPECT_NEAR(std::log2(measured.d24.offset_unit_far), -23.0, 1e-3);
  EXPECT_NEAR(std::log2(measured.d32f.offset_unit_near), -25.0, 1e-3);  // 2^(e-23), 0.25 = 2^-2
  EXPECT_NEAR(std::log2(measured.d32f.offset_unit_far), -24.0, 1e-3);
}

TEST_F(GlTest, Reference_IsClampedForFixedPointDepthAlone) {
  const GlSurvey& measured = measure_once(context());
  EXPECT_TRUE(measured.d16.clamps_reference);
  EXPECT_TRUE(measured.d24.clamps_reference);
  EXPECT_FALSE(measured.d32f.clamps_reference);
}

TEST_F(GlTest, Functions_OfLlvmpipe_AreAsGoodAsMeasuredBefore) {
  const GlSurvey& measured = measure_once(context());
  EXPECT_GT(measured.exp_ulp, 1.0);
  EXPECT_LT(measured.exp_ulp, 100.0);
  EXPECT_GT(measured.sin_error, 0.0);
  EXPECT_LT(measured.sin_error, 2e-7);
  EXPECT_GT(measured.cos_error, 0.0);
  EXPECT_LT(measured.cos_error, 2e-7);
  EXPECT_LE(measured.texel_border_error, 0x1p-13);
}

TEST_F(GlTest, PcfWeightBits_AreThoseOfTheWholeMeasurement) {
  EXPECT_EQ(measure_pcf_weights(context(), GL_DEPTH_COMPONENT24).bits, WeightPrecision::kMaxBits);
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
