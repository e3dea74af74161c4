// What the axes of extreme scenes, maps and input measure, and that they see what is wrong.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "filters/base/error.h"
#include "harness/scene/validate.h"
#include "harness/stress/drawn_scene.h"
#include "harness/stress/onset.h"
#include "harness/stress/slab_scene.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

Case find_case(const AxisInputs& inputs, const std::string& axis, const std::string& filter, const std::string& part) {
  for (Case& item : choose_axes(axis)[0].make_cases(inputs))
    if (item.filter == filter && item.level == Level::kGl && item.variant.find(part) != std::string::npos)
      return std::move(item);
  ADD_FAILURE() << "no case " << part;
  return {};
}

/// Every case of these axes that runs on this GL keeps to its theory.
class ExtremeAxis : public ::testing::TestWithParam<const char*> {};

TEST_P(ExtremeAxis, GlCases_MeetTheirTheories) {
  const AxisInputs inputs = make_gl_inputs("none,box3x3,poisson,esm,vsm");
  Axis axis = choose_axes(GetParam())[0];
  axis.range.high = std::min(axis.range.high, axis.whole ? 512.0 : axis.range.high);  // larger maps cost seconds
  for (const Case& item : axis.make_cases(inputs)) {
    if (item.level != Level::kGl) continue;
    const records::StressCase found = find_onsets(item, axis);
    EXPECT_EQ(found.not_available, "");
    for (const records::StressLimit& limit : compare(item, found, axis)) {
      EXPECT_EQ(limit.agreement, records::StressAgreement::kAgrees)
          << item.filter << " " << item.variant << ": theory " << limit.onset.value_or(-1.0) << ", measured "
          << limit.measured.value_or(-1.0);
    }
  }
}

std::string name_axis(const ::testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, ExtremeAxis,
                         ::testing::Values("position", "scale", "map-edge", "map-size", "light-direction",
                                           "poisoned-input"),
                         name_axis);

TEST(Position, AcneComesFarAway_AndNotRelativeToTheScene) {
  const AxisInputs inputs = make_gl_inputs("none,vsm");
  const double far = 200.0;
  const Observation acne = find_case(inputs, "position", "none", "floor, as it is").observe(far);
  EXPECT_EQ(acne.verdict, Verdict::kDegraded);
  EXPECT_THAT(acne.why, HasSubstr("0 brighter"));
  EXPECT_EQ(find_case(inputs, "position", "vsm", "floor, as it is").observe(far).verdict, Verdict::kOk);
  EXPECT_EQ(find_case(inputs, "position", "none", "floor, relative in double").observe(far).verdict, Verdict::kOk);
}

/// Visibility falls from 1 to 0.9 where a receiver lies e behind its own surface: exp(-80 e) of `esm`, and of `vsm`
/// what bleed_reduction = 0.3 leaves of m / (m + e^2) = 0.93, m being 1e-5. A comparison tolerates nothing.
TEST(Position, Theory_IsWhatTheFormulaTolerates) {
  const AxisInputs inputs = make_gl_inputs("none,vsm,esm");
  const auto theory = [&](const char* filter) {
    return *find_case(inputs, "position", filter, "floor, as it is").theories.at(0).onset;
  };
  const double none = theory("none"), exponential = std::log(1.0 / 0.9) / 80.0,
               variance = std::sqrt(1e-5 * (1.0 / 0.93 - 1.0));
  EXPECT_NEAR(none, 32.0, 0.1);
  EXPECT_NEAR((theory("esm") - none) / (theory("vsm") - none), exponential / variance, 0.01);
  EXPECT_NEAR(theory("vsm") / none, 1.0 + variance / 2.09e-5, 0.5) << "the bias is 2.09e-5 of the depth range";
}

/// Measured limits lie beyond the theories, since not every pixel is off by a whole step, and near them.
TEST(Position, SofteningFilters_DegradeNearTheirTheories) {
  const AxisInputs inputs = make_gl_inputs("vsm,vsm_sat,evsm4,csm_conv,vssm");
  const Axis axis = choose_axes("position")[0];
  for (const filters::FilterRequest& request : inputs.filters) {
    const Case item = find_case(inputs, "position", request.spec.id, "floor, as it is");
    const double ratio = find_onsets(item, axis).degraded->value / *item.theories.at(0).onset;
    EXPECT_GT(ratio, 0.9) << request.spec.id;
    EXPECT_LT(ratio, 1.6) << request.spec.id;
  }
}

TEST(Position, RemedyHolds_OnlyWhereItComesBeforeTheFloats) {
  const AxisInputs inputs = make_gl_inputs("none");
  EXPECT_EQ(find_case(inputs, "position", "none", "cubes, relative in double").observe(1e8).verdict, Verdict::kOk);
  EXPECT_NE(find_case(inputs, "position", "none", "cubes, relative too late").observe(1e6).verdict, Verdict::kOk);
}

TEST(Scale, ScalesTheScene) {
  const Case item = find_case(make_gl_inputs("none"), "scale", "none", "cubes");
  EXPECT_EQ(item.observe(3.0).verdict, Verdict::kOk);
  EXPECT_THROW(item.observe(1e13), Error) << "farther than scenes may reach";
}

TEST(LightDirection, ShadowOfALeaningLight_IsWhereConstructionSays) {
  const AxisInputs inputs = make_gl_inputs("none");
  SceneDrawer drawer(inputs, inputs.filters[0]);
  const SlabSetting setting{.light_local = {0.3, -1.0, 0.1}};
  const Drawing drawing = drawer.draw(scene::validate(make_slab_scene(setting), "test"));
  int lit = 0, dark = 0;
  for (std::size_t i = 0; i < drawing.visibility.size(); ++i) {
    const auto expected = drawing.position[i].w == 0.0f
                              ? std::nullopt
                              : find_slab_visibility(setting, glm::dvec3(drawing.position[i]), 0.1);
    if (!expected) continue;
    EXPECT_EQ(static_cast<double>(drawing.visibility[i]), *expected);
    ++(*expected > 0.5 ? lit : dark);
  }
  EXPECT_GT(lit, 5000);
  EXPECT_GT(dark, 500);
}

TEST(MapSize, OneTexelIsAMap) {
  for (const char* id : {"none", "pcf2x2", "poisson", "vsm", "esm", "vsm_sat", "csm_conv"}) {
    const Observation seen = find_case(make_gl_inputs(id), "map-size", id, "half").observe(1.0);
    EXPECT_EQ(seen.verdict, Verdict::kOk) << id << ": " << seen.why;
    EXPECT_TRUE(seen.measured);
  }
}

/// Four terms of a Fourier series leave light behind an occluder, in a large map as in a small one.
TEST(MapSize, WhatAFormulaLeavesOfTwoDepths_IsExpectedOfMapsOfEverySize) {
  const AxisInputs inputs = make_gl_inputs("csm_conv");
  const Case item = find_case(inputs, "map-size", "csm_conv", "half");
  for (const double size : {256.0, 257.0, 512.0}) EXPECT_LT(item.observe(size).measured.value(), 1e-3) << size;
}

TEST(MapSize, AboveTheLimit_IsRefusedBeforeAnythingIsAllocated) {
  const AxisInputs inputs = make_gl_inputs("none");
  const std::vector<Exhibit> exhibits = choose_axes("map-size")[0].make_exhibits(inputs);
  ASSERT_EQ(exhibits.size(), 1u);
  const auto& rows = exhibits[0].table->rows;
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_THAT(rows[0][2],
              AnyOf(HasSubstr("ok: dark behind an occluder, lit beside it"), HasSubstr("not available: it needs")));
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_THAT(rows[i][2], AllOf(HasSubstr("refused"), HasSubstr(fmt::format("at most {}", rows[0][0]))));
}

}  // namespace
}  // namespace shadowbench::stress
