#include "harness/scene/load.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtx/component_wise.hpp>
#include <map>
#include <new>
#include <set>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/text.h"
#include "harness/scene/complete.h"
#include "harness/scene/files/mesh_file.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

/// The most corners that the shapes of one scene may have, three per triangle: about 4 million triangles.
constexpr std::size_t kMostShapeCorners = std::size_t{3} << 22;
constexpr Range kFovDeg{0.01, 179.0};
constexpr Range kCells{1, 512};
constexpr Range kSegments{3, 1024};
constexpr Range kCount{1, 10000};
constexpr Range kDegrees{-36000, 36000};
constexpr Range kOpacity{0.0, 1.0};

/// One shape: the keys it reads beside the common ones, and how it is made.
struct Shape {
  std::vector<std::string> keys;
  std::function<Mesh(const TomlTable&)> make;
};

/// Throws where all bars together would have too many triangles, judged by one of them.
void require_few_corners(Bars bars, const TomlTable& object) {
  const int count = std::exchange(bars.count, 1);
  const std::size_t corners = make_bars(bars).indices.size() * static_cast<std::size_t>(count);
  if (corners <= kMostShapeCorners) return;
  throw object.error(
      "count", fmt::format("the {} bars in {} would have {} triangles; shapes may have {}: lower 'count' or 'cells'",
                           count, object.title(), corners / 3, kMostShapeCorners / 3));
}

Mesh make_bars_of(const TomlTable& object) {
  Bars bars;
  bars.count = object.integer("count", kCount);
  bars.bar_width_m = object.number_f("bar_width", kPositive);
  bars.spacing_m = object.number_f("spacing", kPositive);
  bars.length_m = object.number_f("length", kPositive);
  bars.direction = object.choose<BarDirection>(
      "direction",
      {{"vertical", BarDirection::kVertical}, {"horizontal", BarDirection::kHorizontal}, {"both", BarDirection::kBoth}},
      "vertical");
  bars.cells = object.integer("cells", kCells, bars.cells);
  if (bars.spacing_m <= bars.bar_width_m) {
    throw object.error("spacing", fmt::format("'spacing' in {} must be more than 'bar_width', {}, but is {}",
                                              object.title(), bars.bar_width_m, bars.spacing_m));
  }
  require_few_corners(bars, object);
  return make_bars(bars);
}

Mesh make_cylinder_of(const TomlTable& object) {
  const CylinderCells cut{object.integer("segments", kSegments, 48), object.integer("cells", kCells, 8)};
  return make_cylinder(object.number_f("radius", kPositive), object.number_f("height", kPositive), cut);
}

const std::map<std::string, Shape>& shapes() {
  static const std::map<std::string, Shape> all{
      {"plane",
       {{"size", "cells"},
        [](const TomlTable& o) {
          return make_plane(glm::vec2(o.vec2("size", kPositive)), o.integer("cells", kCells, 16));
        }}},
      {"box",
       {{"size", "cells"},
        [](const TomlTable& o) {
          return make_box(glm::vec3(o.vec3("size", kPositive)), o.integer("cells", kCells, 8));
        }}},
      {"sphere",
       {{"radius", "segments"},
        [](const TomlTable& o) {
          return make_sphere(o.number_f("radius", kPositive), o.integer("segments", kSegments, 96));
        }}},
      {"cylinder", {{"radius", "height", "segments", "cells"}, make_cylinder_of}},
      {"bars", {{"count", "bar_width", "spacing", "length", "direction", "cells"}, make_bars_of}}};
  return all;
}

glm::dvec3 read_scale(const TomlTable& object) {
  constexpr Range kScale{-1e6, 1e6};
  const glm::dvec3 scale = object.has("scale") && object.find("scale")->as<double>()
                               ? glm::dvec3(object.number("scale", kScale))
                               : object.vec3("scale", kScale, glm::dvec3(1.0));
  if (scale.x * scale.y * scale.z != 0.0) return scale;
  throw object.error("scale", fmt::format("'scale' in {} must not be 0", object.title()));
}

/// Refuses the keys of an [[object]] that neither all have nor one of its shape.
void require_object_keys(const TomlTable& object, const std::vector<std::string>& own) {
  object.require_known_keys(
      {"shape", "name", "material", "casts_shadow", "may_cull_front", "center", "rotation_deg", "scale"}, own);
}

/// The shapes that an [[object]] may have, "model" included.
std::vector<std::string> object_shapes() {
  std::vector<std::string> all;
  for (const auto& [name, shape] : shapes()) all.push_back(name);
  all.emplace_back("model");
  return all;
}

/// Makes the mesh of an [[object]] that is not a model, in its own space.
Mesh make_shape(const TomlTable& object) {
  const Shape& shape = shapes().at(object.string("shape"));
  require_object_keys(object, shape.keys);
  return shape.make(object);
}

/// The transform that scale, then rotation_deg (about x, then y, then z), then center describe.
glm::dmat4 world_from_object(const TomlTable& object) {
  const glm::dvec3 angles = glm::radians(object.vec3("rotation_deg", kDegrees, glm::dvec3(0.0)));
  glm::dmat4 world = glm::translate(glm::dmat4(1.0), object.vec3("center", kAnyNumber, glm::dvec3(0.0)));
  world = glm::rotate(world, angles.z, glm::dvec3(0.0, 0.0, 1.0));
  world = glm::rotate(world, angles.y, glm::dvec3(0.0, 1.0, 0.0));
  world = glm::rotate(world, angles.x, glm::dvec3(1.0, 0.0, 0.0));
  return glm::scale(world, read_scale(object));
}

/// Builds a scene from its tables; materials come before the objects that use them.
class SceneBuilder {
 public:
  SceneBuilder(const TomlTable& root, std::filesystem::path file, const glm::dvec3& origin = glm::dvec3(0.0))
      : root_(root), file_(std::move(file)) {
    scene_.origin_ws = origin;
  }

  Scene build(const Completion& completion) {
    root_.require_known_keys({"title", "background", "model", "camera", "light", "material", "object"});
    scene_.name = file_.stem().string();
    scene_.title = root_.string("title");
    scene_.background = glm::vec3(root_.vec3("background", kColor, glm::dvec3(scene_.background)));
    add_lights(root_.tables("light"));
    for (const TomlTable& table : root_.tables("material")) add_material(table);
    if (root_.has("model"))
      scene_ = add_mesh_file(std::move(scene_), import_mesh_file(root_.file("model"), scene_.origin_ws));
    for (const TomlTable& table : root_.tables("object")) add_object(table);
    for (const TomlTable& table : root_.tables("camera")) add_camera(table);
    if (const glm::dvec3 way = find_way_off(scene_.bounds()); way != glm::dvec3(0.0))
      return SceneBuilder(root_, file_, scene_.origin_ws + way).build(completion);
    scene_ = validate_geometry(std::move(scene_), file_.string());
    return complete(std::move(scene_), completion, file_.string());
  }

 private:
  void take_name(const std::string& name, const std::string& kind, const TomlTable& table) {
    if (!names_[kind].insert(name).second)
      throw table.error("name", fmt::format("two {} have the name '{}'", kind, name));
  }

  void add_camera(const TomlTable& table) {
    const Camera camera = read_camera(table, scene_.origin_ws);
    take_name(camera.name, "cameras", table);
    const std::set<std::string>& lights = names_["lights"];
    if (!camera.light.empty() && !lights.contains(camera.light))
      throw table.error("light", fmt::format("there is no light '{}'{}", camera.light,
                                             did_you_mean_or_known(camera.light, {lights.begin(), lights.end()})));
    scene_.cameras.push_back(camera);
  }

  void add_lights(const std::vector<TomlTable>& tables) {
    if (tables.empty()) throw root_.error("light", "the scene has no [light]");
    for (const TomlTable& table : tables) {
      scene_.other_lights.push_back(read_light(table, scene_.origin_ws));
      const std::string& name = scene_.other_lights.back().name;
      if (tables.size() > 1 && name.empty())
        throw table.error("name", table.title() + " has no 'name': of several lights each needs one");
      take_name(name, "lights", table);
    }
    scene_.light = std::move(scene_.other_lights.front());
    scene_.other_lights.erase(scene_.other_lights.begin());
  }

  void add_material(const TomlTable& table) {
    table.require_known_keys({"name", "color", "opacity"});
    Material material;
    material.name = table.string("name");
    material.base_color = glm::vec4(table.vec3("color", kColor), table.number("opacity", kOpacity, 1.0));
    if (material.base_color.a < 1.0f) material.alpha_mode = AlphaMode::kBlend;
    take_name(material.name, "materials", table);
    scene_.materials.push_back(material);
    named_materials_.push_back(material.name);
  }

  void add_object(const TomlTable& table) {
    const bool is_model = table.choice("shape", object_shapes()) == "model";
    glm::dmat4 world = glm::translate(glm::dmat4(1.0), -scene_.origin_ws) * world_from_object(table);
    MeshFile model;
    if (!is_model) {
      model.meshes.push_back(make_counted_shape(table));
    } else {
      // What the scene's origin is to the model, which may lie far from its own.
      const glm::dvec3 origin(scene_.origin_ws != glm::dvec3(0.0) ? glm::inverse(world)[3] : glm::dvec4(0.0));
      model = read_model_object(table, origin);
      world = glm::translate(world, origin);
      model.rounding_m *= glm::compMax(glm::abs(read_scale(table)));
    }
    for (Mesh& mesh : model.meshes) {
      mesh = transform_mesh(std::move(mesh), world);
      mesh.casts_shadow = table.boolean("casts_shadow", true);
      mesh.may_cull_front = table.boolean("may_cull_front", true);
      if (!is_model || table.has("name")) mesh.name = table.string("name", table.title());
    }
    if (is_model && !table.has("material")) {
      scene_ = add_mesh_file(std::move(scene_), std::move(model));
      return;
    }
    const int material = material_of(table);
    for (Mesh& mesh : model.meshes) {
      mesh.material = material;
      scene_.meshes.push_back(std::move(mesh));
    }
  }

  /// Makes a shape, unless all shapes together have too many triangles: a short file can ask for any number.
  Mesh make_counted_shape(const TomlTable& table) {
    Mesh mesh = make_shape(table);
    corner_count_ += mesh.indices.size();
    if (corner_count_ <= kMostShapeCorners) return mesh;
    throw table.error("shape",
                      fmt::format("with {} the scene's shapes have more than {} triangles; lower 'cells' or 'segments'",
                                  table.title(), kMostShapeCorners / 3));
  }

  static MeshFile read_model_object(const TomlTable& table, const glm::dvec3& origin) {
    require_object_keys(table, {"file"});
    return import_mesh_file(table.file("file"), origin);
  }

  /// The index of the object's material; objects without one share a grey default.
  int material_of(const TomlTable& table) {
    if (!table.has("material")) return default_material();
    const std::string name = table.string("material");
    for (std::size_t i = 0; i < named_materials_.size(); ++i)
      if (named_materials_[i] == name) return static_cast<int>(i);
    throw table.error("material", fmt::format("{} has the unknown material '{}'{}", table.title(), name,
                                              did_you_mean(name, named_materials_)));
  }

  int default_material() {
    if (default_material_ < 0) {
      default_material_ = static_cast<int>(scene_.materials.size());
      scene_.materials.push_back({.name = "default"});
    }
    return default_material_;
  }

  const TomlTable& root_;
  std::filesystem::path file_;
  Scene scene_;
  std::map<std::string, std::set<std::string>> names_;  ///< of each kind of things
  std::vector<std::string> named_materials_;            ///< the first of the scene's materials
  int default_material_ = -1;
  std::size_t corner_count_ = 0;
};

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
  const TomlTable root = read_toml(file, "the scene");
  Scene scene = SceneBuilder(root, file).build({.aspect = options.aspect, .light = options.light});
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
  for (const fs::path& file : files)
    scenes.push_back({file.stem().string(), read_toml(file, "the scene").string("title"), file});
  return scenes;
}

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

Camera read_camera(const TomlTable& table, const glm::dvec3& origin) {
  table.require_known_keys({"name", "light", "position", "target", "up", "vertical_fov_deg", "orthographic_height"});
  Camera camera;
  camera.name = table.string("name", camera.name);
  camera.light = table.string("light", "");
  const glm::dvec3 position = table.vec3("position", kAnyNumber);
  const glm::dvec3 ahead = table.vec3("target", kAnyNumber) - position;
  if (glm::length(ahead) == 0.0) throw table.error("target", "the camera's target is its position");
  camera.position_ws = glm::vec3(position - origin);
  camera.forward_ws = glm::vec3(is_unit(ahead) ? ahead : glm::normalize(ahead));
  camera.up_ws = glm::vec3(table.vec3("up", kAnyNumber, glm::dvec3(0.0, 1.0, 0.0)));
  if (!table.has("orthographic_height")) {
    camera.vertical_fov_rad = static_cast<float>(glm::radians(table.number("vertical_fov_deg", kFovDeg, 45.0)));
    return camera;
  }
  if (table.has("vertical_fov_deg"))
    throw table.error("orthographic_height",
                      table.title() + " has both a 'vertical_fov_deg' and an 'orthographic_height': give one");
  camera.orthographic_height_m = table.number_f("orthographic_height", kPositive);
  return camera;
}

std::vector<SceneInfo> list_scenes(const fs::path& folder) { return with_titles(scene_files(folder)); }

std::vector<SceneInfo> list_teaching_scenes(const fs::path& folder) { return with_titles(teaching_files(folder)); }

fs::path find_scene_file(const std::string& name_or_path, const fs::path& scenes_folder) {
  if (!is_path(name_or_path)) return find_named(name_or_path, scenes_folder);
  return is_folder(name_or_path) ? find_scene_in(name_or_path) : fs::path(name_or_path);
}

Scene load(const std::string& name_or_path, const LoadOptions& options) {
  return load_file(find_scene_file(name_or_path, options.scenes_folder), options);
}

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
