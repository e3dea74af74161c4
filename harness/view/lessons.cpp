#include "harness/view/lessons.h"

#include <utility>

#include "base/toml.h"
#include "harness/scene/load.h"
#include "harness/view/layers.h"
#include "harness/view/save.h"

namespace shadowbench::view {
namespace {

constexpr std::size_t kSentences = 3;
constexpr Range kMapSizes{16, 16384}, kZooms{1.0, 128.0}, kChannels{0, 4};

SharedSettings read_shared(const TomlTable& table) {
  return {table.strings("bias", std::vector<std::string>{}), table.string("fit", "tight")};
}

MapReading read_reading(const TomlTable& table) {
  table.require_known_keys({"place", "side", "zoom", "channel"});
  return {glm::vec3(table.vec3("place", kAnyNumber)),
          table.choose<std::size_t>("side", {{kSideNames[0], 0}, {kSideNames[1], 1}}, kSideNames[0]),
          table.number("zoom", kZooms, 1.0), static_cast<std::size_t>(table.integer("channel", kChannels, 0))};
}

TomlTable require_table(const TomlTable& table, const std::string& key) {
  if (auto found = table.table(key)) return *std::move(found);
  throw table.error(key, "a lesson must have a table '" + key + "'");
}

Lesson read_lesson(const TomlTable& table) {
  table.require_known_keys({"title", "text", "scene", "left", "right", "map_size", "bias", "fit", "layer", "divider",
                            "camera", "reading", "instead"});
  std::vector<std::string> layers;
  for (const Layer& layer : Layers::list()) layers.push_back(layer.id);
  Lesson lesson;
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
