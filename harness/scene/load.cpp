#include "harness/scene/load.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <new>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "base/toml.h"
#include "harness/scene/complete.h"
#include "harness/scene/files/mesh_file.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;

/// Scene files of a folder, by name.
std::vector<fs::path> scene_files(const fs::path& folder) {
  std::error_code failure;
  fs::directory_iterator entries(folder, failure);
  if (failure) fail_input("the folder of built-in scenes cannot be read: " + failure.message(), folder.string());
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : entries)
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<fs::path> teaching_files(const fs::path& folder) {
  const fs::path teaching = folder / "teaching";
  std::error_code ignored;
  return fs::is_directory(teaching, ignored) ? scene_files(teaching) : std::vector<fs::path>();
}

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool is_scene_file(const fs::path& file) { return is_mesh_file(file) || file.extension() == ".toml"; }

/// Finds the one scene that lies in a folder.
fs::path find_scene_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code failure;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failure))
    if (is_scene_file(entry.path()) && !is_folder(entry.path())) names.push_back(entry.path().filename().string());
  if (failure) fail_input("this folder cannot be read: " + failure.message(), folder.string());
  if (names.size() == 1) return folder / names.front();
  std::ranges::sort(names);
  const std::string found =
      names.empty() ? "no scene" : fmt::format("{} scenes: {}", names.size(), fmt::join(names, ", "));
  fail_input(fmt::format("this folder has {}; name a .toml, .gltf, .glb or .obj file", found), folder.string());
}

/// Finds a scene by its name, or in the folder of that name.
fs::path find_named(const std::string& name, const fs::path& folder) {
  std::vector<std::string> names;
  std::vector<fs::path> files = scene_files(folder);
  for (fs::path& file : teaching_files(folder)) files.push_back(std::move(file));
  for (const fs::path& file : files) {
    if (file.stem() == name) return file;
    names.push_back(file.stem().string());
  }
  if (is_folder(name)) return find_scene_in(name);
  const std::optional<std::string> nearest = nearest_name(name, names);
  const std::string hint = nearest ? fmt::format("did you mean '{}'?", *nearest)
                                   : fmt::format("built-in scenes: {}", fmt::join(names, ", "));
  throw Error(ErrorKind::kUsage, fmt::format("there is no scene '{}'; {}", name, hint));
}

/// A path has a folder or the extension of a file that can be loaded; anything else is a name.
bool is_path(const std::string& name_or_path) {
  return name_or_path.find('/') != std::string::npos || fs::path(name_or_path).has_extension();
}

Scene load_model(const fs::path& file, const LoadOptions& options, const glm::dvec3& origin = glm::dvec3(0.0)) {
  MeshFile model = import_mesh_file(file, origin);
  Scene scene;
  scene.origin_ws = origin;
  scene.name = file.stem().string();
  scene.cameras = std::move(model.cameras);
  const std::vector<Light> lights = model.lights;
  const std::vector<bool> aimed = model.aimed;
  scene.title = model.extras.title.value_or(scene.name);
  scene.background = model.extras.background.value_or(scene.background);
  scene = add_mesh_file(std::move(scene), std::move(model));
  if (const glm::dvec3 way = find_way_off(scene.bounds()); way != glm::dvec3(0.0))
    return load_model(file, options, origin + way);
  scene = validate_geometry(std::move(scene), file.string());
  const Bounds bounds = scene.bounds();
  for (std::size_t i = 0; i < lights.size(); ++i)
    scene.other_lights.push_back(aimed[i] ? lights[i] : aim_light(lights[i], 0.5f * (bounds.min + bounds.max)));
  if (!lights.empty()) {
    scene.light = scene.other_lights.front();
    scene.other_lights.erase(scene.other_lights.begin());
  }
  return complete(std::move(scene), {lights.empty(), options.ground, options.aspect, options.light}, file.string());
}

Scene load_kind(const fs::path& file, const LoadOptions& options) {
  if (is_mesh_file(file)) return load_model(file, options);
  if (file.extension() != ".toml")
    throw Error(ErrorKind::kUsage, "this kind of file is no scene: use .toml, .gltf, .glb or .obj", file.string());
  Scene scene = load_scene(file, options.aspect, options.light);
  if (options.ground)
    scene.warnings.push_back("a floor is added to bare models only; this scene file has its own objects");
  return scene;
}

Scene load_file(const fs::path& file, const LoadOptions& options) {
  try {
    return load_kind(file, options);
  } catch (const std::bad_alloc&) {
    fail_input(
        "memory ran out while this scene was loaded; raise the limit (ulimit -v), or use a model with fewer "
        "vertices and smaller textures",
        file.string());
  }
}

std::vector<SceneInfo> with_titles(const std::vector<fs::path>& files) {
  std::vector<SceneInfo> scenes;
  for (const fs::path& file : files) scenes.push_back({file.stem().string(), read_scene_title(file), file});
  return scenes;
}

}  // namespace

std::vector<SceneInfo> list_scenes(const fs::path& folder) { return with_titles(scene_files(folder)); }

std::vector<SceneInfo> list_teaching_scenes(const fs::path& folder) { return with_titles(teaching_files(folder)); }

fs::path find_scene_file(const std::string& name_or_path, const fs::path& scenes_folder) {
  if (!is_path(name_or_path)) return find_named(name_or_path, scenes_folder);
  return is_folder(name_or_path) ? find_scene_in(name_or_path) : fs::path(name_or_path);
}

Scene load(const std::string& name_or_path, const LoadOptions& options) {
  return load_file(find_scene_file(name_or_path, options.scenes_folder), options);
}

namespace {

namespace fs = std::filesystem;

toml::array write_vec3(const glm::vec3& v) { return write_numbers(std::span(&v.x, 3)); }

/// Degrees that are read back as the same angle: few digits where these do.
double write_angle(float radians) {
  const double exact = glm::degrees(static_cast<double>(radians));
  const double brief = write_number(static_cast<float>(exact));
  return static_cast<float>(glm::radians(brief)) == radians ? brief : exact;
}

toml::table write_camera(const Camera& camera, const glm::dvec3& origin = glm::dvec3(0.0)) {
  toml::array target;
  for (int axis = 0; axis < 3; ++axis)
    target.push_back(write_number(camera.position_ws[axis]) + origin[axis] +
                     static_cast<double>(camera.forward_ws[axis]));
  toml::table table{{"name", camera.name},
                    {"position", write_place(camera.position_ws, origin)},
                    {"target", std::move(target)},
                    {"up", write_vec3(camera.up_ws)}};
  if (!camera.light.empty()) table.insert("light", camera.light);
  if (camera.orthographic_height_m > 0.0f)
    table.insert("orthographic_height", write_number(camera.orthographic_height_m));
  else
    table.insert("vertical_fov_deg", write_angle(camera.vertical_fov_rad));
  return table;
}

/// Reads what was written until it is what was written.
template <class Value, class Write, class Read>
Value settle_by(Value value, std::string title, const Write& write, const Read& read) {
  constexpr int kMostTurns = 4;  // one or two are needed
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const toml::table written = write(value);
    value = read(TomlTable(written, title));
    if (write(value) == written) break;
  }
  return value;
}

/// A scene file's own tables, to lie elsewhere.
toml::table move_document(const fs::path& source, const fs::path& file) {
  toml::table document = parse_toml_file(source);
  const auto move_path = [&](toml::table& table, std::string_view key) {
    if (const auto path = table[key].value<std::string>())
      table.insert_or_assign(key, name_from(source.parent_path() / *path, file));
  };
  move_path(document, "model");
  if (toml::table* object = document["object"].as_table()) move_path(*object, "file");
  if (toml::array* objects = document["object"].as_array())
    for (toml::node& each : *objects)
      if (each.is_table()) move_path(*each.as_table(), "file");
  return document;
}

/// A floor as the plane that make_floor() makes of it. Its place is written to the last digit of a double, since a
/// plane is moved in double precision.
toml::table write_floor(const Floor& floor, const glm::dvec3& origin, const std::string& material) {
  const glm::dvec3 center = glm::dvec3(floor.center_ws) + origin;
  return toml::table{{"shape", "plane"},
                     {"name", "ground"},
                     {"material", material},
                     {"size", write_numbers(std::span(&floor.size_m.x, 2))},
                     {"center", toml::array{center.x, center.y, center.z}},
                     {"cells", kFloorCells}};
}

toml::table write_model(const ShownScene& shown, const fs::path& file) {
  const Scene& scene = *shown.scene;
  toml::table document{
      {"title", scene.title}, {"background", write_vec3(scene.background)}, {"model", name_from(shown.source, file)}};
  if (!scene.floor) return document;
  const Material& material = scene.materials[static_cast<std::size_t>(scene.meshes.back().material)];
  document.insert("material", toml::array{toml::table{{"name", material.name},
                                                      {"color", write_vec3(glm::vec3(material.base_color))}}});
  document.insert("object", toml::array{write_floor(*scene.floor, scene.origin_ws, material.name)});
  return document;
}

}  // namespace

std::string name_from(const fs::path& file, const fs::path& from) {
  const fs::path written = fs::absolute(from).lexically_normal().parent_path();
  const fs::path real = fs::weakly_canonical(written);
  const fs::path place = fs::weakly_canonical(fs::absolute(file).parent_path()) / file.filename();
  const fs::path relative = place.lexically_relative(real);
  const bool is_elsewhere = relative.empty() || (real != written && *relative.begin() == "..");
  return (is_elsewhere ? place : relative).generic_string();
}

std::string write_scene(const ShownScene& shown, const fs::path& file) {
  toml::table document = is_mesh_file(shown.source) ? write_model(shown, file) : move_document(shown.source, file);
  toml::array cameras, lights;
  for (const Camera& camera : shown.cameras) cameras.push_back(write_camera(camera, shown.scene->origin_ws));
  for (const Light& light : shown.lights) lights.push_back(write_light(light, shown.scene->origin_ws));
  document.insert_or_assign("camera", std::move(cameras));
  document.insert_or_assign("light", std::move(lights));
  return write_toml(document);
}

Camera settle(const Camera& camera) {
  return settle_by(
      camera, "camera '" + camera.name + "'", [](const Camera& each) { return write_camera(each); },
      [](const TomlTable& table) { return checked_camera(read_camera(table), {}); });
}

Light settle(const Light& light) {
  return settle_by(
      light, "light '" + light.name + "'", [](const Light& each) { return write_light(each); },
      [](const TomlTable& table) { return checked_light(read_light(table), {}); });
}

}  // namespace shadowbench::scene
