// What is saved from the window is what the window shows: loaded again, and run.

#include <gmock/gmock.h>

#include "base/error.h"
#include "harness/run/float_images.h"
#include "harness/run/scene_loading.h"
#include "harness/view/save.h"
#include "report/records/json_io.h"
#include "tests/harness/scene/gltf_parts.h"
#include "tests/harness/scene/same_scene.h"
#include "tests/harness/view/view_fixture.h"

namespace shadowbench::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SaveTest : public ViewTest {
 protected:
  /// Moves what can be moved, by what is no round number.
  static void move(view::ViewSettings& settings) {
    for (scene::Camera& camera : settings.cameras) {
      camera.position_ws += 0.07f * glm::length(camera.position_ws) * glm::vec3(0.31f, 0.17f, -0.23f);
      camera.forward_ws = glm::normalize(camera.forward_ws + glm::vec3(0.013f, -0.031f, 0.017f));
      camera.vertical_fov_rad *= 1.01f;
    }
    for (scene::Light& light : settings.lights)
      light = scene::turn_light(
          light, [](const glm::vec3& v) { return glm::normalize(v + glm::vec3(0.1234f, -0.05f, -0.0777f)); });
  }

  /// Saves the scene and loads it: the same triangles, cameras and lights, and the same images through both sides.
  void expect_same_scene(const view::ViewState& state) const {
    const fs::path file = folder() / "saved" / "again.toml";
    view::save_scene(state, file);
    scene::Scene loaded = run::load_scene(state.options, file.string());
    expect_same_geometry(loaded, state.scene);
    expect_views(loaded, state.cameras, state.lights);
    loaded.light = list_lights(loaded)[state.light];
    loaded.other_lights.clear();
    for (std::size_t side = 0; side < view::kSides; ++side)
      EXPECT_EQ(count_different(draw(state.options, loaded, loaded.cameras[state.camera], state.sides[side].filter),
                                draw(state, side)),
                0u)
          << side;
  }

  /// Saves the experiment and runs it: its cells are the sides, with the very images that these draw.
  void expect_same_run(const view::ViewState& state) const {
    view::save_experiment(state, folder() / "e" / "shown.toml");
    const Outcome outcome = run("run e/shown.toml --grids --out out --no-truth --rounds 1 --phases 2");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err << read_text(folder() / "e" / "shown.toml");
    const records::Results results = records::read_results(folder() / "out" / "results.json");
    EXPECT_THAT(results.run.experiment.title, HasSubstr(state.scene.title));
    ASSERT_EQ(results.cells.size(), state.options.filters.size());
    images::ExrFile exr = images::read_exr(folder() / "out" / results.cells.front().images.exr.value());
    for (std::size_t i = 0; i < results.cells.size(); ++i) {
      const filters::FilterRequest& request = state.options.filters[i];
      EXPECT_EQ(results.cells[i].filter, request.spec.id);
      EXPECT_EQ(results.cells[i].view, state.active_camera().name);
      measure::MeasuredCell cell;
      cell.label = results.cells[i].images.parts.value();
      run::take_float_images(cell, exr.parts);
      const images::Image drawn = draw(state.options, state.scene, state.active_camera(), request);
      EXPECT_EQ(count_different(cell.visibility, drawn), 0u) << cell.label;
      const auto [least, most] = std::ranges::minmax(drawn.texels);
      EXPECT_LT(least, 0.3f) << "there is shadow";
      EXPECT_GT(most, 0.9f) << "there is light";
    }
  }

  void expect_same(const view::ViewState& state) const {
    expect_same_scene(state);
    expect_same_run(state);
  }
};

TEST_F(SaveTest, CubesUnderAnotherSun) {
  view::ViewState state = view::make_view_state(make_options(), "cubes", sides("vsm:radius=6", "tent3x3"));
  change(state, [&](view::ViewSettings& settings) {
    move(settings);
    settings.sides[0].filter.values["min_variance"] = 3.1e-5;
  });
  expect_same(state);
}

TEST_F(SaveTest, SpotLight) {
  options::RunOptions options = make_options();
  options.range.behind_test = false;
  view::ViewState state = view::make_view_state(options, "lamp", sides("vsm:radius=6", "tent3x3"));
  change(state, move);
  expect_same(state);
  EXPECT_THAT(read_text(folder() / "e" / "shown.toml"), HasSubstr("behind_test = 'off'"));
}

TEST_F(SaveTest, SpotLightNarrowerThanItsInnerCone) {
  view::ViewState state = view::make_view_state(make_options(), "lamp", sides("tent3x3", "none"));
  change(state, [](view::ViewSettings& settings) { std::get<scene::Spot>(settings.lights[0].kind).cone_deg = 40.0f; });
  expect_same(state);
}

TEST_F(SaveTest, OneOfThreeLights) {
  view::ViewState state = view::make_view_state(make_options(), "three_lights", sides("vsm:radius=6", "tent3x3"));
  for (const std::size_t light : {1u, 2u}) {
    change(state, [&](view::ViewSettings& settings) {
      settings.light = light;
      move(settings);
    });
    expect_same(state);
  }
}

TEST_F(SaveTest, ALightChosenByItsName_Shines) {
  view::ViewState state = view::make_view_state(make_options(), "three_lights", sides("vsm:radius=6", "tent3x3"));
  view::choose_light(state, "spot");
  EXPECT_EQ(state.scene.light.name, "spot");
  EXPECT_EQ(state.lights[state.light].name, "spot");
}

TEST_F(SaveTest, BareModelOnItsFloor_ThroughTheSecondCamera) {
  scene::GltfParts parts;
  parts.more = R"(, "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}},
      {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1.3, "znear": 0, "zfar": 10}}])";
  parts.nodes = R"([{"mesh": 0}, {"camera": 0, "translation": [0.5, 0.4, 4]},
      {"camera": 1, "translation": [0.5, 0.9, 4], "rotation": [-0.1, 0.2, 0, 0.97]}])";
  parts.scenes = R"([{"nodes": [0, 1, 2]}])";
  write("data.bin", parts.buffer);
  const fs::path model = write("quad.gltf", scene::gltf_of(parts));
  options::RunOptions options = make_options();
  options.ground = true;
  view::ViewState state = view::make_view_state(options, model.string(), sides("vsm:radius=6", "tent3x3"));
  ASSERT_TRUE(state.scene.floor.has_value());
  for (const std::size_t camera : {0u, 1u}) {
    change(state, [&](view::ViewSettings& settings) {
      settings.camera = camera;
      settings.cameras[0].position_ws += glm::vec3(0.013f, 0.7f, -0.017f);
      settings.cameras[0].forward_ws = glm::normalize(glm::vec3(0.013f, -0.2f, -1.0f));
    });
    expect_same(state);
  }
}

TEST_F(SaveTest, EverySettingOfTheMapAndTheLookup) {
  options::RunOptions options = make_options();
  options.map = {GL_DEPTH_COMPONENT16, {false, 30.0}};
  options.range = {filters::Border::kEdge, false, true};
  options.seed = 17;
  view::ViewState state = view::make_view_state(options, "edge", sides("poisson:radius=3", "tent3x3"));
  change(state, [&](view::ViewSettings& settings) {
    view::set_bias(settings, {"constant:depth=1e-4", "slope:texels=0.7"});
  });
  expect_same(state);
  options = make_options();
  options.map.curve = {true, 1e5};
  options.snap = true;
  options.pad_texels = 13.0;
  state = view::make_view_state(options, "cubes", sides("none", "tent3x3"));
  for (const char* fit : {"cascades:count=3,split=0.37", "view"}) {
    change(state, [&](view::ViewSettings& settings) { view::set_fit(settings, fit); });
    expect_same(state);
  }
}

TEST_F(SaveTest, OneFilterTwice_AndAUsersOwn) {
  view::ViewState state = view::make_view_state(make_options(), "cubes", sides("vsm:radius=2", "vsm:radius=9"));
  expect_same_run(state);
  const fs::path own = write("filters/own.glsl", read_text(user_filter("clamped_reference.glsl")));
  change(state, [&](view::ViewSettings& settings) {
    settings.sides[0].filter = request("own", own);
    settings.sides[1].filter = settings.sides[0].filter;
  });
  ASSERT_EQ(state.options.filters.size(), 1u);
  expect_same_run(state);
  EXPECT_THAT(read_text(folder() / "e" / "shown.toml"), HasSubstr("'../filters/own.glsl'"));
}

TEST_F(SaveTest, TruthIsNoCell_AndTwoTruthsMakeARunAllTheSame) {
  view::ViewState state = view::make_view_state(make_options(), "cubes", sides("tent3x3", "none"));
  change(state, [&](view::ViewSettings& settings) { settings.sides[1].truth = true; });
  expect_same_run(state);
  change(state, [&](view::ViewSettings& settings) { settings.sides[0].truth = true; });
  view::save_experiment(state, folder() / "truths.toml");
  ASSERT_EQ(run("run truths.toml --grids --out out --no-truth --rounds 1 --phases 2").exit_code, 0);
  EXPECT_EQ(records::read_results(folder() / "out" / "results.json").cells.size(), 1u);
}

TEST_F(SaveTest, NoFileIsWrittenOverAScene) {
  options::RunOptions options = make_options();
  const std::string cubes = read_text(options.resources.scenes / "cubes.toml");
  options.resources.scenes = folder() / "built-in";
  const fs::path edge = write("built-in/teaching/edge.toml", cubes), own = write("own.toml", cubes);
  const view::ViewState state = view::make_view_state(options, own.string(), sides("tent3x3", "none"));
  const auto refusal = [&](const fs::path& file) {
    try {
      view::save_scene(state, file);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      return error.message();
    }
    return std::string("none");
  };
  EXPECT_THAT(refusal(folder() / "." / "own.toml"), HasSubstr("loaded from this file"));
  fs::create_symlink(own, folder() / "link.toml");
  EXPECT_THAT(refusal(folder() / "link.toml"), HasSubstr("loaded from this file"));
  EXPECT_THAT(refusal(folder() / "built-in" / "new.toml"), HasSubstr("built-in scenes"));
  EXPECT_THAT(refusal(edge), HasSubstr("built-in scenes"));
  EXPECT_THAT(refusal(folder() / "scene.gltf"), HasSubstr("end in .toml"));
  EXPECT_EQ(refusal(folder() / "other.toml"), "none");
  EXPECT_EQ(refusal(folder() / "other.toml"), "none") << "what was saved may be saved again";
  EXPECT_THROW(view::save_experiment(state, own), Error);
  EXPECT_EQ(read_text(own), cubes);
  EXPECT_EQ(read_text(edge), cubes);
}

}  // namespace
}  // namespace shadowbench::test
