// What a stage draws again, and what it compiles for that, when light or camera change.

#include "harness/view/workbench.h"
#include "tests/harness/view/view_fixture.h"

namespace shadowbench::test {
namespace {

struct Shown {
  const char* name;
  const char* scene;
  std::array<const char*, view::kSides> filters;
  std::vector<std::string> bias;
};

/// What both sides show, and the distance to the blocker.
using Images = std::array<std::vector<float>, 3>;

class StageTest : public ViewTest {
 protected:
  view::ViewState make_state(const Shown& shown) const {
    view::ViewState state =
        view::make_view_state(make_options(96, 54), shown.scene, sides(shown.filters[0], shown.filters[1]));
    change(state, [&](view::ViewSettings& settings) { view::set_bias(settings, shown.bias); });
    return state;
  }

  static void put_light(view::ViewState& state, const scene::Light& light) {
    change(
        state, [&](view::ViewSettings& settings) { settings.lights[settings.light] = light; });
  }

  static Images read(view::Stage& stage, const view::ViewState& state) {
    const glm::ivec2 all(0, state.options.width);
    return {stage.visibility(0, all).read_floats(1), stage.visibility(1, all).read_floats(1),
            stage.blocker_distance(state).texels};
  }

  static Images draw_anew(const view::ViewState& state) {
    view::Stage stage(renderer(), state.scene);
    stage.draw(state, view::Changes::all());
    return read(stage, state);
  }
};

class MovedLight : public StageTest, public ::testing::WithParamInterface<Shown> {};

TEST_P(MovedLight, CompilesNothing_AndShowsTheSameBitsAsANewStage) {
  view::ViewState state = make_state(GetParam());
  view::Stage stage(renderer(), state.scene);
  stage.draw(state, view::Changes::all());
  Images before = read(stage, state);
  for (int step = 0; step < 3; ++step) {
    SCOPED_TRACE(step);
    put_light(state, scene::turn_light(state.scene.light, [](const glm::vec3& way) {
                return glm::normalize(way + glm::vec3(0.05f, 0.0f, 0.0f));
              }));
    const int compiled = renderer().shaders.compiled();
    stage.draw(state, {.light = true});
    const Images now = read(stage, state);
    EXPECT_EQ(renderer().shaders.compiled(), compiled);
    EXPECT_EQ(now, draw_anew(state));
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NE(now[i], before[i]) << "the light has not moved";
    before = now;
  }
  renderer().context->require_no_gl_errors();
}

INSTANTIATE_TEST_SUITE_P(Lights, MovedLight,
                         ::testing::Values(Shown{"Sun", "cubes", {"vsm", "tent3x3"}, {}},
                                           Shown{"Spot", "lamp", {"vsm", "tent3x3"}, {}},
                                           Shown{"SpotOwnPasses", "lamp", {"vsm_sat", "pcss"}, {}},
                                           Shown{"SpotMidpoint", "lamp", {"vsm", "none"}, {"midpoint"}},
                                           Shown{"Point", "lantern", {"vsm", "tent3x3"}, {}}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_F(StageTest, LightOfAnotherKind_ShowsTheSameBitsAsANewStage) {
  view::ViewState state = make_state({"", "lamp", {"vsm", "tent3x3"}, {}});
  view::Stage stage(renderer(), state.scene);
  stage.draw(state, view::Changes::all());
  read(stage, state);
  scene::Light sun = state.scene.light;
  sun.kind = scene::Sun{-scene::to_light(sun, glm::vec3(0.0f))};
  put_light(state, sun);
  stage.draw(state, {.light = true});
  EXPECT_EQ(read(stage, state), draw_anew(state));
}

TEST_F(StageTest, MovedCamera_ShowsTheSameBitsAsANewStage) {
  view::ViewState state = make_state({"", "cubes", {"vsm", "tent3x3"}, {}});
  view::Stage stage(renderer(), state.scene);
  stage.draw(state, view::Changes::all());
  const Images before = read(stage, state);
  change(state, [](view::ViewSettings& settings) { settings.cameras[0].position_ws.y += 0.1f; });
  stage.draw(state, {.camera = true});
  const Images now = read(stage, state);
  for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NE(now[i], before[i]) << "the camera has not moved";
  EXPECT_EQ(now, draw_anew(state));
}

}  // namespace
}  // namespace shadowbench::test
