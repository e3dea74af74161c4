// The probe draws what it is told, and the axes' GL cases break where theory says.

#include <gmock/gmock.h>

#include "filters/base/error.h"
#include "harness/stress/edge_scene.h"
#include "harness/stress/onset.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

ProbeScene make_scene() {
  ProbeScene scene;
  scene.size = 8;
  scene.depths.assign(64, 0.5f);
  scene.depths[3 * 8 + 2] = 0.25f;
  scene.receivers = {{scene.uv(2), scene.uv(3), 0.4f},
                     {scene.uv(3), scene.uv(2), 0.4f},
                     {scene.uv(2), scene.uv(3), 0.2f},
                     {scene.uv(0), scene.uv(0), 0.6f}};
  return scene;
}

TEST(GlProbe, ReceiversSeeTheTexelsTheyStandIn) {
  const StressContext context = make_gl_context("none");
  const ProbeResult result = make_gl_probe(context, context.filters[0])->look(make_scene(), context.filters[0].values);
  EXPECT_THAT(result.visibility, ::testing::ElementsAre(0.0, 1.0, 1.0, 0.0));
  EXPECT_EQ(result.broken_texels, 0);
}

TEST(GlProbe, EqualsTheModel_ForEveryFilterThatHasOne) {
  const StressContext context = make_gl_context("");
  for (const filters::FilterRequest& request : context.filters) {
    const EdgeScene edge = make_edge_scene(4, {{0.3f, 0.6f}});
    const ProbeResult gl = make_gl_probe(context, request)->look(edge.scene, request.values);
    const ProbeResult model = make_model_probe(context, request)->look(edge.scene, request.values);
    for (std::size_t i = 0; i < gl.visibility.size(); ++i)
      EXPECT_NEAR(gl.visibility[i], model.visibility[i], 1e-3) << request.spec.id << " " << i;
  }
}

TEST(GlProbe, TakesAnotherSceneAndOtherValues) {
  const StressContext context = make_gl_context("esm:radius=0");
  filters::ParamValues values = context.filters[0].values;
  const auto probe = make_gl_probe(context, context.filters[0]);
  EXPECT_EQ(probe->look(make_scene(), values).visibility.size(), 4u);
  EXPECT_EQ(probe->look(make_edge_scene(0, {{0.3f, 0.6f}}).scene, values).broken_texels, 0);
  values["c"] = 500.0;
  EXPECT_GT(probe->look(make_scene(), values).broken_texels, 0);
}

TEST(GlProbe, MapThatTheGlCannotGive_IsAnError_AndSoNotAvailable) {
  const StressContext context = make_gl_context("none");
  ProbeScene scene = make_scene();
  scene.size = context.renderer->context->info().max_texture_size * 2;
  Case item;
  item.observe = [probe = std::shared_ptr(make_gl_probe(context, context.filters[0])), scene,
                  values = context.filters[0].values](double) {
    probe->look(scene, values);
    return Observation{};
  };
  Axis axis;
  axis.range = {1.0, 2.0};
  EXPECT_NE(find_onsets(item, axis).not_available, "");
}

/// Every case of the first axes that runs on this GL keeps to its theory, or says why not.
TEST(Axes, GlCases_MeetTheirTheories) {
  const StressContext context = make_gl_context("vsm,esm");
  for (const char* id : {"esm-exponent", "vsm-cancellation"}) {
    const Axis axis = choose_axes(id)[0];
    for (const Case& item : axis.make_cases(context)) {
      if (item.level != Level::kGl) continue;
      const records::StressCase found = find_onsets(item, axis);
      EXPECT_EQ(found.not_available, "");
      for (const records::StressLimit& limit : compare(item, found, axis)) {
        EXPECT_NE(limit.agreement, records::StressAgreement::kDisagrees)
            << id << " " << item.variant << ": theory " << limit.onset.value_or(-1.0) << ", measured "
            << limit.measured.value_or(-1.0);
      }
    }
  }
}

/// Annen et al.: exp(c z) overflows at c = 88.72 in 32-bit and 11.09 in 16-bit floats, where depth reaches 1.
TEST(Axes, EsmOnGl_BreaksAtItsExponent) {
  const Axis axis = choose_axes("esm-exponent")[0];
  for (const Case& item : axis.make_cases(make_gl_context("esm"))) {
    if (item.level != Level::kGl || item.variant.find("linear, depths to 1") == std::string::npos) continue;
    const double limit = item.variant.starts_with("r16f") ? 11.09 : 88.72;
    EXPECT_NEAR(find_onsets(item, axis).broken->value / limit, 1.0, 0.02) << item.variant;
  }
}

}  // namespace
}  // namespace shadowbench::stress
