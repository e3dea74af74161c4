// The lookup draws what it is told, and the axes' GL cases break where theory says.

#include "harness/stress/axis.h"
#include "harness/stress/synthetic_scene.h"
#include "tests/harness/stress/stress_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::stress {
namespace {

TEST(GeometryAxes, GlCases_MeetTheirTheories) {
  const AxisInputs inputs = make_gl_inputs("none,box4x4,poisson,vsm:bleed_reduction=0,slope_variance=0,esm");
  for (const char* id : {"grazing-light", "depth-formats", "light-bleeding", "kernel-radius", "taps"})
    expect_theories_met(choose_axes(id)[0], inputs, Level::kGl, false);
}

/// What a case says of a theory that was met at `measured`, where the case saw `record`.
std::string explain(const Case& item, double measured, const records::StressCase& record = {}) {
  return item.explain({item.theories.front(), measured, record});
}

TEST(GrazingLight, WeightsOfFewBits_ExplainALowerBias_ButNoHigherOne) {
  const AxisInputs inputs = make_gl_inputs("pcf2x2");
  const Case item = choose_axes("grazing-light")[0].make_cases(inputs).at(0);
  const double theory = find_gain_m({45.0, false}, 1.0) / kPlaneTexel_m;
  records::StressCase lower, higher;
  lower.samples = {{45.0, Verdict::kBroken, 0.8 * theory, {}}};
  higher.samples = {{45.0, Verdict::kBroken, 1.2 * theory, {}}};
  inputs.renderer->accuracy = {.exp_roundoffs = 1.0, .weight_bits = 23.0};
  EXPECT_EQ(explain(item, 45.0, lower), "");
  inputs.renderer->accuracy->weight_bits = 8.0;
  EXPECT_THAT(explain(item, 45.0, lower), HasSubstr("weights of 8 bits"));
  EXPECT_EQ(explain(item, 45.0, higher), "");
  inputs.renderer->accuracy.reset();
}

TEST(DepthFormats, GlThatRoundsToTheNearest_ExplainsNoEarlierOnset) {
  const AxisInputs inputs = make_gl_inputs("none");
  const Case item = choose_axes("depth-formats")[0].make_cases(inputs).at(0);
  item.observe(1000.0);
  EXPECT_EQ(explain(item, 0.9 * item.theories.front().onset.value()), "");
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

TEST(TiltedPlane, FacingTheLight_NeedsNoBias) { EXPECT_EQ(find_bias("tent3x3", {0.0, false}), 0.0); }

TEST(TiltedPlane, TwiceTheTheory_IsTheMostThatIsTried) {
  const PlaneTilt tilt{60.0, false};
  EXPECT_FALSE(make_plane("box4x4", tilt).find_needed_bias(find_gain_m(tilt, 0.5)));
}

TEST(TiltedPlane, AcneGrowsAsTheBiasShrinks) {
  const PlaneTilt tilt{70.0, false};
  TiltedPlane plane = make_plane("tent3x3", tilt);
  const double theory = find_gain_m(tilt, 1.5);
  EXPECT_NEAR(plane.find_acne(0.0), 0.5, 0.02);
  EXPECT_GT(plane.find_acne(0.0), plane.find_acne(0.5 * theory));
  EXPECT_GT(plane.find_acne(0.5 * theory), 0.0);
  EXPECT_EQ(plane.find_acne(1.01 * theory), 0.0);
}

Case find_case(const AxisInputs& inputs, const std::string& axis, const std::string& filter, const std::string& part) {
  for (Case& item : choose_axes(axis)[0].make_cases(inputs))
    if (item.filter == filter && item.level == Level::kGl && item.variant.find(part) != std::string::npos)
      return std::move(item);
  ADD_FAILURE() << "no case " << part;
  return {};
}

TEST(PictureSize, PassThatIsNarrowerThanAPixel_ChangesNothing_AndAWiderOneTakesNoise) {
  const AxisInputs inputs = make_gl_inputs("pcss:taps=4,search_taps=4");
  const Axis axis = choose_axes("picture-size")[0];
  expect_theories_met(axis, inputs, Level::kGl, false);
  const Case item = axis.make_cases(inputs).at(0);
  EXPECT_NEAR(item.observe(7.0).measured.value(), 1.0, 1e-4);
  EXPECT_LT(item.observe(256.0).measured.value(), 0.3);
  expect_theories_met(axis, make_gl_inputs("pcss:max_radius=3"), Level::kGl, false);
  EXPECT_THAT(axis.make_cases(make_gl_inputs("pcss:rotation=none")).at(0).not_available, HasSubstr("no noise"));
}

/// Every case of this axis that runs on this GL keeps to its theory.
TEST(MapSize, GlCases_MeetTheirTheories) {
  Axis axis = choose_axes("map-size")[0];
  axis.range.high = 512.0;  // larger maps cost seconds
  expect_theories_met(axis, make_gl_inputs("none,box3x3,poisson,esm,vsm,msm_packed32,msm_packed64"), Level::kGl, false);
}

TEST(MapSize, OneTexelIsAMap) {
  for (const char* id : {"none", "pcf2x2", "poisson", "vsm", "esm", "vsm_sat", "csm_conv"}) {
    const Observation seen = find_case(make_gl_inputs(id), "map-size", id, "half").observe(1.0);
    EXPECT_EQ(seen.verdict, Verdict::kOk) << id << ": " << seen.why;
    EXPECT_TRUE(seen.measured);
  }
}

/// A texel of 32 bits has 64 shares: by its own design, in a map of any size.
TEST(MapSize, WhatAFilterPacks_IsNoFaultOfTheMap) {
  const AxisInputs inputs = make_gl_inputs("msm_packed32,msm_packed64");
  for (const char* id : {"msm_packed32", "msm_packed64"})
    EXPECT_LT(find_case(inputs, "map-size", id, "half").observe(6.0).measured.value(), 1e-5) << id;
}

/// Four terms of a Fourier series leave light behind an occluder, in a large map as in a small one.
TEST(MapSize, WhatAFormulaLeavesOfTwoDepths_IsExpectedOfMapsOfEverySize) {
  const AxisInputs inputs = make_gl_inputs("csm_conv");
  const Case item = find_case(inputs, "map-size", "csm_conv", "half");
  for (const double size : {256.0, 257.0, 512.0}) EXPECT_LT(item.observe(size).measured.value(), 1e-3) << size;
}

SyntheticScene make_scene() {
  SyntheticScene scene;
  scene.size = 8;
  scene.depths.assign(64, 0.5f);
  scene.depths[3 * 8 + 2] = 0.25f;
  scene.receivers = {{scene.uv(2), scene.uv(3), 0.4f},
                     {scene.uv(3), scene.uv(2), 0.4f},
                     {scene.uv(2), scene.uv(3), 0.2f},
                     {scene.uv(0), scene.uv(0), 0.6f}};
  return scene;
}

TEST(GlLookup, EqualsTheModel_ForEveryFilterThatHasOne) {
  const AxisInputs inputs = make_gl_inputs("");
  for (const filters::FilterRequest& request : inputs.filters) {
    const EdgeScene edge = make_edge_scene(4, {{0.3f, 0.6f}});
    const LookupResult gl = make_gl_lookup(inputs, request)(edge.scene, request.values);
    const LookupResult model = make_model_lookup(inputs, request)(edge.scene, request.values);
    for (std::size_t i = 0; i < gl.visibility.size(); ++i)
      EXPECT_NEAR(gl.visibility[i], model.visibility[i], 2e-3) << request.spec.id << " " << i;  // csm_conv: half floats
  }
}

TEST(GlLookup, TakesAnotherSceneAndOtherValues) {
  const AxisInputs inputs = make_gl_inputs("esm:radius=0");
  filters::ParamValues values = inputs.filters[0].values;
  const auto lookup = make_gl_lookup(inputs, inputs.filters[0]);
  EXPECT_EQ(lookup(make_scene(), values).visibility.size(), 4u);
  EXPECT_EQ(lookup(make_edge_scene(0, {{0.3f, 0.6f}}).scene, values).broken_texels, 0);
  values["c"] = 500.0;
  EXPECT_GT(lookup(make_scene(), values).broken_texels, 0);
}

TEST(GlLookup, MapThatTheGlCannotGive_IsAnError_AndSoNotAvailable) {
  const AxisInputs inputs = make_gl_inputs("none");
  SyntheticScene scene = make_scene();
  scene.size = inputs.renderer->context->info().max_texture_size * 2;
  Case item;
  item.observe = [lookup = make_gl_lookup(inputs, inputs.filters[0]), scene,
                  values = inputs.filters[0].values](double) {
    lookup(scene, values);
    return Observation{};
  };
  Axis axis;
  axis.range = {1.0, 2.0};
  EXPECT_NE(find_onsets(item, axis).not_available, "");
}

/// Every case of the first axes that runs on this GL keeps to its theory, or says why not.
TEST(Axes, GlCases_MeetTheirTheories) {
  for (const char* id : {"esm-exponent", "vsm-cancellation"})
    expect_theories_met(choose_axes(id)[0], make_gl_inputs("vsm,esm,vsm_sat,vssm"), Level::kGl, true);
}

}  // namespace
}  // namespace shadowbench::stress
