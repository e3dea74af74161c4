#include <chrono>
#include <thread>

#include "harness/run/float_images.h"
#include "harness/run/run_plan.h"
#include "harness/view/side_measurement.h"
#include "harness/view/view_state.h"
#include "harness/view/workbench.h"
#include "reference/metrics/error_stats.h"
#include "report/records/json_io.h"
#include "tests/harness/scene/gltf_parts.h"
#include "tests/harness/scene/same_scene.h"
#include "tests/harness/view/view_fixture.h"

namespace shadowbench::test {
namespace {

// What is saved from the window is what the window shows: loaded again, and run.

namespace fs = std::filesystem;

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
      EXPECT_TRUE(draw(state.options, loaded, loaded.cameras[state.camera], state.sides[side].filter).texels ==
                  draw(state, side).texels)
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
      EXPECT_TRUE(cell.visibility.texels == drawn.texels) << cell.label;
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

TEST_F(SaveTest, LightsOfEveryKind_Moved) {
  options::RunOptions options = make_options();
  options.range.behind_test = false;
  for (const auto& [scene, light] : {std::pair("cubes", ""), std::pair("lamp", ""), std::pair("three_lights", "spot"),
                                     std::pair("three_lights", "bulb")}) {
    SCOPED_TRACE(std::string(scene) + " " + light);
    view::ViewState state = view::make_view_state(options, scene, sides("vsm:radius=6", "tent3x3"));
    if (*light != '\0') view::choose_light(state, light);
    change(state, [&](view::ViewSettings& settings) {
      move(settings);
      settings.sides[0].filter.values["min_variance"] = 3.1e-5;
      if (auto* spot = std::get_if<scene::Spot>(&settings.lights[0].kind)) spot->cone_deg = 40.0f;  // below its inner
    });
    if (*light != '\0') EXPECT_EQ(state.scene.light.name, light);
    expect_same(state);
  }
  EXPECT_THAT(read_text(folder() / "e" / "shown.toml"), HasSubstr("behind_test = 'off'"));
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
  const auto refusal = [&](const fs::path& file) { return error_of([&] { view::save_scene(state, file); }).message(); };
  EXPECT_THAT(refusal(folder() / "." / "own.toml"), HasSubstr("loaded from this file"));
  fs::create_symlink(own, folder() / "link.toml");
  EXPECT_THAT(refusal(folder() / "link.toml"), HasSubstr("loaded from this file"));
  EXPECT_THAT(refusal(folder() / "built-in" / "new.toml"), HasSubstr("built-in scenes"));
  EXPECT_THAT(refusal(edge), HasSubstr("built-in scenes"));
  EXPECT_THAT(refusal(folder() / "scene.gltf"), HasSubstr("end in .toml"));
  EXPECT_EQ(refusal(folder() / "other.toml"), "no error");
  EXPECT_EQ(refusal(folder() / "other.toml"), "no error") << "what was saved may be saved again";
  EXPECT_THROW(view::save_experiment(state, own), Error);
  EXPECT_EQ(read_text(own), cubes);
  EXPECT_EQ(read_text(edge), cubes);
}

// Every lesson shows the fault that it names, by its metric, and reads the map where it lies.

using State = view::SideMeasurement::State;

class LessonsTest : public ViewTest {
 protected:
  static view::Lesson find(const std::string& name) {
    for (view::Lesson& lesson : view::read_lessons(options::find_resources().lessons))
      if (lesson.name == name) return lesson;
    ADD_FAILURE() << "there is no lesson '" << name << "'";
    return {};
  }

  view::ViewState make_state(const view::Lesson& lesson, bool instead = false, int width = 480) const {
    view::ViewState state = view::make_lesson_state(lesson, make_options(width, width * 9 / 16), filters::built_in());
    if (instead) change(state, [&](view::ViewSettings& settings) { set_shared(settings, lesson.instead); });
    state.options.attribution = false;
    return state;
  }

  /// What the window measures of a state, in a run of its own.
  static view::MeasuredSides measure(const view::ViewState& state) {
    view::SideMeasurement measurement(SHADOWBENCH_PROGRAM);
    measurement.start(state);
    for (int i = 0; i < 12000 && measurement.poll() == State::kRunning; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_EQ(measurement.poll(), State::kFinished) << measurement.text();
    return measurement.results();
  }

  static glm::ivec2 find_pixel(const view::ViewState& state, const glm::vec3& point_ws) {
    return glm::ivec2(find_place(state, point_ws) * glm::vec2(state.options.width, state.options.height));
  }
};

TEST_F(LessonsTest, Each_ReadsTheMapForAReceiverThatIsSeen) {
  for (const view::Lesson& lesson : view::read_lessons(options::find_resources().lessons)) {
    SCOPED_TRACE(lesson.title);
    const view::ViewState state = make_state(lesson);
    view::Stage stage(shared_renderer(), state.scene);
    stage.draw(state, view::Changes::all());
    const auto seen = stage.find_surface(find_pixel(state, lesson.reading.place_ws));
    ASSERT_TRUE(seen);
    EXPECT_LT(glm::distance(glm::vec3(*seen), lesson.reading.place_ws), 0.05f) << "something stands before it";
    ASSERT_NE(stage.passes(lesson.reading.side), nullptr);
    EXPECT_EQ(lesson.reading.content != "depth", stage.passes(lesson.reading.side)->encoded_format().has_value());
  }
}

/// One side of a lesson, as the window measures it.
struct MeasuredSide {
  const view::ViewState& state;
  const view::MeasuredSides& sides;
  std::size_t side;
  glm::ivec2 read_at;  ///< the pixel for which the lesson reads the map

  const records::CellRecord& cell() const { return sides.find_side(side)->record; }
  const images::Image& visibility() const { return sides.find_side(side)->visibility; }

  /// The width of the penumbra of the post's shadow this far from its foot: metres where an image is between 0 and 1.
  double penumbra_m(const images::Image& image, float away_m) const {
    const glm::vec3 foot_ws(1.75f, 0.0f, -0.85f);  // in ball.toml
    const glm::vec3 ahead = glm::normalize(-scene::to_light(state.scene.light, foot_ws) * glm::vec3(1, 0, 1));
    const glm::vec3 across(ahead.z, 0.0f, -ahead.x);
    constexpr float kReach_m = 0.6f, kStep_m = 0.001f;
    int between = 0;
    for (float aside_m = -kReach_m; aside_m < kReach_m; aside_m += kStep_m) {
      const glm::vec2 at = find_place(state, foot_ws + away_m * ahead + aside_m * across);
      const float value = *image.at(static_cast<int>(at.x * static_cast<float>(image.width)),
                                    static_cast<int>(at.y * static_cast<float>(image.height)));
      between += value > 0.1f && value < 0.9f;
    }
    return static_cast<double>(kStep_m) * between;
  }
};

using Value = std::optional<double>;

/// A number of a lesson's side, and what it is at least and at most. `instead`: with what the lesson has to try.
struct Lesson {
  const char* name;
  std::size_t side;
  bool instead;
  Value (*read)(const MeasuredSide&);
  double least, most;
};

TEST_F(LessonsTest, Each_ShowsItsFault_AndWhatEndsIt) {
  constexpr double kAny = std::numeric_limits<double>::infinity();
  constexpr float kNear_m = 0.4f, kFar_m = 2.5f;
  const auto acne = +[](const MeasuredSide& s) { return s.cell().artefact.acne; };
  const auto gap = +[](const MeasuredSide& s) { return s.cell().artefact.contact_gap; };
  const auto leak = +[](const MeasuredSide& s) { return s.cell().artefact.leak; };
  const auto seam = +[](const MeasuredSide& s) { return s.cell().artefact.seam; };
  const auto rmse = +[](const MeasuredSide& s) { return s.cell().error.rmse; };
  const auto overflow = +[](const MeasuredSide& s) -> Value { return s.cell().stability.overflow_texels; };
  // Where the map is read, all of the light is blocked.
  const auto lit = +[](const MeasuredSide& s) {
    const bool is_dark = *s.sides.truth.at(s.read_at.x, s.read_at.y) == 0.0f;
    return is_dark ? Value(*s.visibility().at(s.read_at.x, s.read_at.y)) : std::nullopt;
  };
  // The penumbra's width, by that of the true one, near its caster and far from it; and its growth between the two.
  const auto near = +[](const MeasuredSide& s) -> Value {
    return s.penumbra_m(s.visibility(), kNear_m) / s.penumbra_m(s.sides.truth, kNear_m);
  };
  const auto far = +[](const MeasuredSide& s) -> Value {
    return s.penumbra_m(s.visibility(), kFar_m) / s.penumbra_m(s.sides.truth, kFar_m);
  };
  const auto growth = +[](const MeasuredSide& s) -> Value {
    return s.penumbra_m(s.visibility(), kFar_m) / s.penumbra_m(s.visibility(), kNear_m);
  };
  std::map<std::pair<std::string, bool>, view::MeasuredSides> measured;
  for (const Lesson& each : {Lesson{"vsm-leak", 0, false, leak, 0.3, 1.0},
                             {"vsm-leak", 0, false, lit, 0.2, 1.0},
                             {"vsm-leak", 1, false, leak, 0.0, 0.05},
                             {"esm-overflow", 0, false, leak, 0.3, 1.0},
                             {"esm-overflow", 0, false, lit, 0.99, 1.0},
                             {"esm-overflow", 0, false, overflow, 1e4, kAny},
                             {"esm-overflow", 1, false, leak, 0.0, 0.05},
                             {"esm-overflow", 1, false, lit, 0.0, 0.05},
                             {"esm-overflow", 1, false, overflow, 0.0, 0.0},
                             {"pcss", 0, false, near, 4.0, kAny},
                             {"pcss", 0, false, growth, 0.7, 1.3},
                             {"pcss", 0, false, rmse, 0.04, 1.0},
                             {"pcss", 1, false, near, 0.0, 2.0},
                             {"pcss", 1, false, growth, 2.0, kAny},
                             {"pcss", 1, false, rmse, 0.0, 0.02},
                             {"width", 0, false, near, 0.0, 2.5},
                             {"width", 0, false, far, 0.0, 0.5},
                             {"width", 1, false, near, 4.0, kAny},
                             {"width", 1, false, far, 0.7, 1.3},
                             {"peter-panning", 0, false, gap, 0.5, 1.0},
                             {"peter-panning", 0, false, rmse, 0.03, 1.0},
                             {"peter-panning", 0, true, rmse, 0.0, 0.02},
                             {"peter-panning", 0, true, acne, 0.0, 0.05},
                             {"acne", 0, false, acne, 0.3, 1.0},
                             {"acne", 0, false, gap, 0.0, 0.05},
                             {"acne", 0, true, acne, 0.0, 0.05},
                             {"acne", 0, true, gap, 0.5, 1.0},
                             {"seams", 0, false, seam, 0.05, 1.0},
                             {"seams", 0, true, seam, 0.0, 0.025}}) {
    const auto [found, is_new] = measured.try_emplace({each.name, each.instead});
    const view::ViewState state = make_state(find(each.name), each.instead, 960);
    if (is_new) found->second = measure(state);
    const glm::ivec2 read_at = find_pixel(state, find(each.name).reading.place_ws);
    const double value = each.read({state, found->second, each.side, read_at}).value_or(-1.0);
    EXPECT_TRUE(each.least <= value && value <= each.most) << "not within " << each.least << " .. " << each.most;
  }
  for (const view::Lesson& lesson : view::read_lessons(options::find_resources().lessons))
    EXPECT_TRUE(measured.contains({lesson.name, false})) << lesson.name << " has no row";
}

// What a stage draws again, and what it compiles for that, when light or camera change.

struct Shown {
  const char* name;
  const char* scene;
  std::array<const char*, view::kSides> filters;
  std::vector<std::string> bias;
};

/// What both sides show.
using Images = std::array<std::vector<float>, 2>;

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
    return {stage.visibility(0, all).read_floats(1), stage.visibility(1, all).read_floats(1)};
  }

  static Images draw_anew(const view::ViewState& state) {
    view::Stage stage(shared_renderer(), state.scene);
    stage.draw(state, view::Changes::all());
    return read(stage, state);
  }

  /// Draws what has changed, which must show what a new stage does, and not what it showed before. Returns how many
  /// shaders that compiled.
  static int expect_redrawn(view::Stage& stage, const view::ViewState& state, const view::Changes& changes) {
    const Images before = read(stage, state);
    const int compiled = shared_renderer().shaders.compiled();
    stage.draw(state, changes);
    const int compiled_now = shared_renderer().shaders.compiled();
    const Images now = read(stage, state);
    EXPECT_EQ(now, draw_anew(state));
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NE(now[i], before[i]) << "nothing has moved";
    return compiled_now - compiled;
  }
};

class MovedLight : public StageTest, public ::testing::WithParamInterface<Shown> {};

TEST_P(MovedLight, CompilesNothing_AndShowsTheSameBitsAsANewStage) {
  view::ViewState state = make_state(GetParam());
  view::Stage stage(shared_renderer(), state.scene);
  stage.draw(state, view::Changes::all());
  for (int step = 0; step < 3; ++step) {
    SCOPED_TRACE(step);
    put_light(state, scene::turn_light(state.scene.light, [](const glm::vec3& way) {
                return glm::normalize(way + glm::vec3(0.05f, 0.0f, 0.0f));
              }));
    EXPECT_EQ(expect_redrawn(stage, state, {.light = true}), 0);
  }
  shared_renderer().context->require_no_gl_errors();
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
  view::Stage stage(shared_renderer(), state.scene);
  stage.draw(state, view::Changes::all());
  scene::Light sun = state.scene.light;
  sun.kind = scene::Sun{-scene::to_light(sun, glm::vec3(0.0f))};
  put_light(state, sun);
  expect_redrawn(stage, state, {.light = true});
}

TEST_F(StageTest, MovedCamera_ShowsTheSameBitsAsANewStage) {
  view::ViewState state = make_state({"", "cubes", {"vsm", "tent3x3"}, {}});
  view::Stage stage(shared_renderer(), state.scene);
  stage.draw(state, view::Changes::all());
  change(state, [](view::ViewSettings& settings) { settings.cameras[0].position_ws.y += 0.1f; });
  expect_redrawn(stage, state, {.camera = true});
}

}  // namespace
}  // namespace shadowbench::test
