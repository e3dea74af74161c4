// The lookup draws what it is told, and the axes' GL cases break where theory says.

#include <gmock/gmock.h>

#include "base/error.h"
#include "harness/stress/synthetic_scene.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

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

TEST(GlLookup, ReceiversSeeTheTexelsTheyStandIn) {
  const AxisInputs inputs = make_gl_inputs("none");
  const LookupResult result = make_gl_lookup(inputs, inputs.filters[0])(make_scene(), inputs.filters[0].values);
  EXPECT_THAT(result.visibility, ::testing::ElementsAre(0.0, 1.0, 1.0, 0.0));
  EXPECT_EQ(result.broken_texels, 0);
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

/// Annen et al.: exp(c z) overflows at c = 88.72 in 32-bit and 11.09 in 16-bit floats, where depth reaches 1.
TEST(Axes, EsmOnGl_BreaksAtItsExponent) {
  const Axis axis = choose_axes("esm-exponent")[0];
  for (const Case& item : axis.make_cases(make_gl_inputs("esm"))) {
    if (item.level != Level::kGl || item.variant.find("linear, depths to 1") == std::string::npos) continue;
    const double limit = item.variant.starts_with("r16f") ? 11.09 : 88.72;
    EXPECT_NEAR(find_onsets(item, axis).broken->value / limit, 1.0, 0.02) << item.variant;
  }
}

}  // namespace
}  // namespace shadowbench::stress
