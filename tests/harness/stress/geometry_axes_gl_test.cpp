// The axes that draw their own scenes, on the GL: planes, formats, stacked occluders, radii and taps.

#include <gmock/gmock.h>

#include "harness/stress/onset.h"
#include "harness/stress/stored_depths.h"
#include "harness/stress/tilted_plane.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

TEST(GeometryAxes, GlCases_MeetTheirTheories) {
  const AxisInputs inputs = make_gl_inputs("none,box4x4,poisson,vsm:bleed_reduction=0,slope_variance=0,esm");
  for (const char* id : {"grazing-light", "depth-formats", "light-bleeding", "kernel-radius", "taps"}) {
    const Axis axis = choose_axes(id)[0];
    int limits = 0;
    for (const Case& item : axis.make_cases(inputs)) {
      if (item.level != Level::kGl) continue;
      const records::StressCase found = find_onsets(item, axis);
      EXPECT_EQ(found.not_available, "");
      for (const records::StressLimit& limit : compare(item, found, axis)) {
        EXPECT_EQ(limit.agreement, records::StressAgreement::kAgrees)
            << id << " " << item.filter << " " << item.variant << ": theory " << limit.onset.value_or(-1.0)
            << ", measured " << limit.measured.value_or(-1.0);
        ++limits;
      }
    }
    EXPECT_GT(limits, 0) << id;
  }
}

TEST(TiltedPlane, DrawnAcne_EndsWhereTheModelsDoes) {
  const AxisInputs inputs = make_gl_inputs("tent3x3");
  const auto drawn = make_gl_plane(inputs, inputs.filters[0]), model = make_model_plane(inputs.filters[0]);
  for (const PlaneTilt& tilt : {PlaneTilt{20.0, false}, PlaneTilt{75.0, true}, PlaneTilt{89.9, true}}) {
    drawn->tilt(tilt);
    model->tilt(tilt);
    const double theory = find_gain_m(tilt, 1.5);
    EXPECT_NEAR(find_needed_bias(*drawn, theory).value() / find_needed_bias(*model, theory).value(), 1.0, 0.01)
        << tilt.angle_deg;
    EXPECT_NEAR(drawn->find_acne(0.4 * theory).mean_shadow, model->find_acne(0.4 * theory).mean_shadow, 0.01);
    EXPECT_NEAR(drawn->find_acne(0.4 * theory).share, model->find_acne(0.4 * theory).share, 0.03);
  }
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
