// The axes that draw their own scenes, on the GL: planes, formats, stacked occluders, radii and taps.

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "harness/stress/drawn_maps.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

TEST(GeometryAxes, GlCases_MeetTheirTheories) {
  const AxisInputs inputs = make_gl_inputs("none,box4x4,poisson,vsm:bleed_reduction=0,slope_variance=0,esm");
  for (const char* id : {"grazing-light", "depth-formats", "light-bleeding", "kernel-radius", "taps"})
    expect_theories_met(choose_axes(id)[0], inputs, Level::kGl, false);
}

TiltedPlane make_plane(const std::string& filter, const PlaneTilt& tilt) {
  const AxisInputs inputs = make_gl_inputs(filter);
  TiltedPlane plane(inputs, inputs.filters[0]);
  plane.tilt(tilt);
  return plane;
}

/// The bias that a filter needs on a plane, in texels.
double find_bias(const std::string& filter, const PlaneTilt& tilt) {
  return make_plane(filter, tilt).find_needed_bias(find_gain_m(tilt, 4.0)).value() / kPlaneTexel_m;
}

/// NUMBERS: s (r + 1) tan(angle), by sqrt 2 on the diagonal; the nearest texel's centre is half a texel away at most.
TEST(TiltedPlane, Needs_WhatThePlaneGainsOverTheKernel) {
  for (const auto& [filter, reach] :
       {std::pair("none", 0.5), std::pair("pcf2x2", 1.0), std::pair("tent3x3", 1.5), std::pair("box4x4", 2.0)}) {
    for (const double angle : {10.0, 45.0, 80.0, 89.9}) {
      const double gain = reach * std::tan(angle * std::numbers::pi / 180.0);
      EXPECT_NEAR(find_bias(filter, {angle, false}) / gain, 1.0, 0.03) << filter << " " << angle;
      EXPECT_NEAR(find_bias(filter, {angle, true}) / (gain * std::numbers::sqrt2), 1.0, 0.06) << filter << " " << angle;
    }
  }
}

TEST(TiltedPlane, FacingTheLight_NeedsNoBias) { EXPECT_EQ(find_bias("tent3x3", {0.0, false}), 0.0); }

TEST(TiltedPlane, TwiceTheTheory_IsTheMostThatIsTried) {
  const PlaneTilt tilt{60.0, false};
  EXPECT_FALSE(make_plane("box4x4", tilt).find_needed_bias(find_gain_m(tilt, 0.5)));
}

TEST(TiltedPlane, AcneGrowsAsTheBiasShrinks) {
  const PlaneTilt tilt{70.0, false};
  TiltedPlane plane = make_plane("tent3x3", tilt);
  const double theory = find_gain_m(tilt, 1.5);
  const Acne none = plane.find_acne(0.0), half = plane.find_acne(0.5 * theory), enough = plane.find_acne(1.01 * theory);
  EXPECT_NEAR(none.mean_shadow, 0.5, 0.02);
  EXPECT_GT(none.share, half.share);
  EXPECT_GT(half.share, half.mean_shadow);
  EXPECT_EQ(enough.mean_shadow, 0.0);
  EXPECT_EQ(enough.share, 0.0);
}

/// Half a quantum: of 2^-16 and 2^-24, and of a float, which is finest near 0.
TEST(StoredDepths, LinearDepth_IsOffByHalfAQuantum) {
  for (const auto& [format, quantum] : {std::pair(GLenum{GL_DEPTH_COMPONENT16}, 1.0 / 65535.0),
                                        std::pair(GLenum{GL_DEPTH_COMPONENT24}, 1.0 / 16777215.0)}) {
    StoredDepths depths(shared_renderer().shaders, format);
    EXPECT_NEAR(depths.find_error_around({1000.0, false, false}, 2.0) / (0.5 * quantum * 999.0), 1.0, 0.02);
  }
  StoredDepths floats(shared_renderer().shaders, GL_DEPTH_COMPONENT32F);
  const double far = floats.find_error_around({1000.0, false, false}, 900.0),
               near = floats.find_error_around({1000.0, false, false}, 2.0);
  EXPECT_NEAR(far / (0x1p-25 * 999.0), 1.0, 0.02);
  EXPECT_LT(near, 0.01 * far);
}

/// d^2 (f - n) / (n f) times half a quantum: ten times the distance, a hundred times the error.
TEST(StoredDepths, PerspectiveDepth_IsOffByTheSquareOfTheDistance) {
  StoredDepths depths(shared_renderer().shaders, GL_DEPTH_COMPONENT16);
  const DepthPlan plan{1000.0, true, false};
  const double near = depths.find_error_around(plan, 4.0), far = depths.find_error_around(plan, 40.0);
  EXPECT_NEAR(near / (16.0 * 0.999 * 0.5 / 65535.0), 1.0, 0.03);
  EXPECT_NEAR(far / near, 100.0, 4.0);
}

TEST(StoredDepths, ReversedFloats_KeepWhatOthersLose) {
  StoredDepths floats(shared_renderer().shaders, GL_DEPTH_COMPONENT32F);
  EXPECT_GT(floats.find_largest_error({1e6, true, false}).relative, 0.02);
  EXPECT_LT(floats.find_largest_error({1e6, true, true}).relative, 1e-6);
  EXPECT_NEAR(floats.find_largest_error({1e6, true, false}).distance / 1e6, 1.0, 0.1);
}

TEST(StoredDepths, DistanceAndDepth_AreInverse) {
  for (const DepthPlan& plan :
       {DepthPlan{100.0, false, false}, DepthPlan{100.0, true, false}, DepthPlan{100.0, true, true}}) {
    for (const double distance : {1.0, 3.0, 100.0})
      EXPECT_NEAR(distance_of(plan, depth_of(plan, distance)), distance, 1e-9);
    EXPECT_NEAR(depth_of(plan, 1.0), plan.reversed ? 1.0 : 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace shadowbench::stress
