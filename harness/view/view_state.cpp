#include "harness/view/view_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "base/toml.h"
#include "harness/options/experiment_file.h"
#include "harness/render/gbuffer.h"
#include "harness/run/run_plan.h"
#include "harness/scene/load.h"
#include "harness/view/layers.h"

namespace shadowbench::view {

Side make_side(const filters::Catalogue& catalogue, const std::string& text) {
  const bool truth = text == kTruthName;
  const std::vector<filters::FilterRequest> requests = catalogue.parse_requests(truth ? "none" : text);
  filters::refuse_light_widths(requests);
  if (requests.size() != 1)
    throw Error(ErrorKind::kUsage,
                fmt::format("'{}' names {} filters: a side shows one, or '{}'", text, requests.size(), kTruthName));
  return {requests.front(), truth};
}

ViewState make_view_state(options::RunOptions options, const std::string& scene_argument,
                          std::array<Side, kSides> sides) {
  ViewState state;
  state.options = std::move(options);
  state.scene_argument = scene_argument;
  state.scene = run::load_scene(state.options, scene_argument);
  state.cameras = state.scene.cameras;
  for (scene::Camera& camera : state.cameras) camera.light.clear();  // from each, any light is looked at
  state.lights = {state.scene.light};
  for (scene::Light& light : state.scene.other_lights) state.lights.push_back(std::move(light));
  state.scene.other_lights.clear();
  state.sides = std::move(sides);
  apply(state, state);
  return state;
}

void choose_light(ViewState& state, const std::string& name) {
  std::vector<std::string> names;
  for (const scene::Light& light : state.lights) names.push_back(light.name);
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    throw Error(ErrorKind::kUsage, fmt::format("--light-name: '{}' is no light of {}{}", name, state.scene.name,
                                               did_you_mean_or_known(name, names)));
  state.light = static_cast<std::size_t>(found - names.begin());
  const auto view = std::ranges::find_if(
      state.scene.cameras, [&](const scene::Camera& each) { return each.light.empty() || each.light == name; });
  state.camera = static_cast<std::size_t>(view - state.scene.cameras.begin());
  apply(state, state);
}

void apply(ViewState& state, ViewSettings settings) {
  std::vector<filters::FilterRequest>& listed = settings.options.filters;
  listed.clear();
  for (const Side& side : settings.sides) {
    if (side.truth) continue;
    if (listed.empty() || !filters::is_same(listed.front(), side.filter)) listed.push_back(side.filter);
  }
  static_cast<ViewSettings&>(state) = std::move(settings);
  state.scene.light = state.lights[state.light];
}

void set_fit(ViewSettings& settings, const std::string& text) {
  settings.options.fit = scene::parse_fit_rule(text);
  settings.options.fits = {settings.options.fit};
}

void set_bias(ViewSettings& settings, const std::vector<std::string>& texts) {
  settings.options.bias = render::parse_bias(texts);
  settings.options.bias_texts = texts;
}

glm::vec2 find_place(const ViewState& state, const glm::vec3& point_ws) {
  const double aspect = static_cast<double>(state.options.width) / static_cast<double>(state.options.height);
  const glm::vec4 clip =
      render::clip_from_world(state.active_camera(), state.scene.bounds(), aspect) * glm::vec4(point_ws, 1.0f);
  return glm::vec2(0.5f) + glm::vec2(0.5f, -0.5f) * glm::vec2(clip) / clip.w;
}

void check(const ViewSettings& settings) {
  render::require_drawable(settings.options.bias, settings.options.map);
  for (const Side& side : settings.sides)
    if (!side.truth) render::require_usable(settings.options.bias, side.filter.spec);
}

namespace {

namespace fs = std::filesystem;

fs::path find_source(const ViewState& state) {
  return scene::find_scene_file(state.scene_argument, state.options.resources.scenes);
}

bool is_same(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return fs::equivalent(a, b, missing);
}

/// Refuses a file that would take the place of a scene that others count on.
void require_free(const ViewState& state, const fs::path& file) {
  const auto refuse = [&](const char* why) { throw Error(ErrorKind::kUsage, why, file.string()); };
  if (file.extension() != ".toml") refuse("the name of a scene or an experiment must end in .toml");
  if (is_same(file, find_source(state))) refuse("the scene was loaded from this file: choose another name");
  const fs::path& scenes = state.options.resources.scenes;
  const fs::path folder = fs::absolute(file).parent_path();
  if (is_same(folder, scenes) || is_same(folder, scenes / "teaching"))
    refuse("this is the folder of the built-in scenes: choose another one");
}

std::string write_scene(const ViewState& state, const fs::path& file) {
  return scene::write_scene({find_source(state), &state.scene, state.cameras, state.lights}, file);
}

}  // namespace

void settle(ViewSettings& settings) {
  for (scene::Camera& camera : settings.cameras) camera = scene::settle(camera);
  for (scene::Light& light : settings.lights) light = scene::settle(light);
}

void save_scene(const ViewState& state, const fs::path& file) {
  require_free(state, file);
  write_text_file(file, write_scene(state, file));
}

fs::path scene_beside(const fs::path& experiment) {
  return experiment.parent_path() / (experiment.stem().string() + ".scene.toml");
}

std::string write_experiment(const ViewState& state, options::RunOptions options, const fs::path& file) {
  options.title = fmt::format("{}: {} and {}", state.scene.title, state.sides[0].label(), state.sides[1].label());
  options.scenes = {scene_beside(file).filename().string()};
  options.ground = false;  // the scene's file has the floor
  if (state.cameras.size() > 1) options.views = {state.active_camera().name};
  if (state.lights.size() > 1) options.light_names = {state.lights[state.light].name};
  options.sizes = {{options.width, options.height}};
  // An experiment without filters would take the default ones.
  if (options.filters.empty()) options.filters = {options.reference};
  options.filter_files.clear();
  for (filters::FilterRequest& request : options.filters) {
    request.set_by_user.clear();
    for (const auto& [name, value] : request.values) request.set_by_user.insert(name);
    if (!request.user_file) continue;
    const std::string name = scene::name_from(request.spec.path, file);
    if (std::ranges::count(options.filter_files, name) == 0) options.filter_files.push_back(name);
  }
  return options::write_experiment(options);
}

void save_experiment(const ViewState& state, const fs::path& file) {
  require_free(state, file);
  save_scene(state, scene_beside(file));
  write_text_file(file, write_experiment(state, state.options, file));
}

namespace {

constexpr std::size_t kSentences = 3;
constexpr Range kMapSizes{16, 16384}, kZooms{1.0, 128.0};

SharedSettings read_shared(const TomlTable& table) {
  return {table.strings("bias", std::vector<std::string>{}), table.string("fit", "tight")};
}

MapReading read_reading(const TomlTable& table) {
  table.require_known_keys({"place", "side", "zoom", "content"});
  return {glm::vec3(table.vec3("place", kAnyNumber)),
          table.choose<std::size_t>("side", {{kSideNames[0], 0}, {kSideNames[1], 1}}, kSideNames[0]),
          table.number("zoom", kZooms, 1.0),
          table.choice("content", {"depth", "channel 1", "channel 2", "channel 3", "channel 4", "variance"}, "depth")};
}

TomlTable require_table(const TomlTable& table, const std::string& key) {
  if (auto found = table.table(key)) return *std::move(found);
  throw table.error(key, "a lesson must have a table '" + key + "'");
}

Lesson read_lesson(const TomlTable& table) {
  table.require_known_keys({"name", "title", "text", "scene", "left", "right", "map_size", "bias", "fit", "layer",
                            "divider", "camera", "reading", "instead"});
  std::vector<std::string> layers;
  for (const Layer& layer : Layers::list()) layers.push_back(layer.id);
  Lesson lesson;
  lesson.name = table.string("name");
  lesson.title = table.string("title");
  lesson.sentences = table.strings("text");
  if (lesson.sentences.size() != kSentences) throw table.error("text", "a lesson has three sentences");
  lesson.scene = table.string("scene");
  lesson.sides = {table.string(kSideNames[0]), table.string(kSideNames[1])};
  lesson.map_size = table.integer("map_size", kMapSizes);
  lesson.settings = read_shared(table);
  lesson.layer = table.choice("layer", layers);
  lesson.divider = table.number_f("divider", {0.0, 1.0}, 0.5);
  lesson.reading = read_reading(require_table(table, "reading"));
  if (const auto camera = table.table("camera")) lesson.camera = scene::read_camera(*camera);
  if (const auto instead = table.table("instead")) {
    instead->require_known_keys({"title", "bias", "fit"});
    lesson.instead_title = instead->string("title");
    lesson.instead = read_shared(*instead);
  }
  return lesson;
}

/// Options with which a run would start, in the same program, with the same picture.
options::RunOptions begin_anew(const options::RunOptions& options) {
  options::RunOptions fresh;
  fresh.resources = options.resources;
  fresh.sizes = options.sizes;
  fresh.width = options.width;
  fresh.height = options.height;
  fresh.reference = options.reference;
  fresh.gpus = options.gpus;
  fresh.backend = options.backend;
  fresh.cache = options.cache;
  fresh.out = options.out;
  fresh.command = options.command;
  return fresh;
}

}  // namespace

std::vector<Lesson> read_lessons(const std::filesystem::path& file) {
  const TomlTable root = read_toml(file, "the lessons");
  root.require_known_keys({"lesson"});
  std::vector<Lesson> lessons;
  for (const TomlTable& table : root.tables("lesson")) lessons.push_back(read_lesson(table));
  return lessons;
}

void set_shared(ViewSettings& settings, const SharedSettings& shared) {
  set_bias(settings, shared.bias);
  set_fit(settings, shared.fit);
}

ViewState make_lesson_state(const Lesson& lesson, const options::RunOptions& options,
                            const filters::Catalogue& catalogue) {
  ViewState state = make_view_state(begin_anew(options), lesson.scene,
                                    {make_side(catalogue, lesson.sides[0]), make_side(catalogue, lesson.sides[1])});
  ViewSettings settings = state;
  settings.options.map_sizes = {lesson.map_size};
  set_shared(settings, lesson.settings);
  if (lesson.camera) settings.cameras[settings.camera] = *lesson.camera;
  settle(settings);
  check(settings);
  apply(state, std::move(settings));
  return state;
}

}  // namespace shadowbench::view
