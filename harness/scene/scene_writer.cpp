#include "harness/scene/scene_writer.h"

#include <toml++/toml.h>

#include <string_view>
#include <utility>

#include "base/toml.h"
#include "harness/scene/complete.h"
#include "harness/scene/files/mesh_file.h"
#include "harness/scene/load.h"
#include "harness/scene/validate.h"

namespace shadowbench::scene {
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

/// The tables of [[key]], or the single [key].
std::vector<toml::table*> list_tables(toml::table& document, std::string_view key) {
  std::vector<toml::table*> tables;
  if (toml::table* single = document[key].as_table()) tables.push_back(single);
  if (toml::array* several = document[key].as_array())
    for (toml::node& each : *several)
      if (each.is_table()) tables.push_back(each.as_table());
  return tables;
}

/// A scene file's own tables, to lie elsewhere.
class MovedDocument {
 public:
  MovedDocument(const fs::path& source, const fs::path& file)
      : folder_(source.parent_path()), file_(file), document_(parse_toml_file(source)) {
    move_path(document_, "model");
    for (toml::table* object : list_tables(document_, "object")) move_path(*object, "file");
    for (toml::table* light : list_tables(document_, "light")) move_path(*light, "cookie");
  }

  toml::table& document() { return document_; }

  /// The cookies of its lights, in their order; empty for a light without one.
  std::vector<std::string> list_cookies() {
    std::vector<std::string> cookies;
    for (toml::table* light : list_tables(document_, "light"))
      cookies.push_back((*light)["cookie"].value_or(std::string()));
    return cookies;
  }

 private:
  fs::path folder_;
  fs::path file_;
  toml::table document_;

  void move_path(toml::table& table, std::string_view key) const {
    if (const auto path = table[key].value<std::string>())
      table.insert_or_assign(key, name_from(folder_ / *path, file_));
  }
};

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
  toml::table document;
  std::vector<std::string> cookies;
  if (is_mesh_file(shown.source)) {
    document = write_model(shown, file);
  } else {
    MovedDocument moved(shown.source, file);
    cookies = moved.list_cookies();
    document = std::move(moved.document());
  }
  toml::array cameras, lights;
  for (const Camera& camera : shown.cameras) cameras.push_back(write_camera(camera, shown.scene->origin_ws));
  for (std::size_t i = 0; i < shown.lights.size(); ++i) {
    toml::table light = write_light(shown.lights[i], shown.scene->origin_ws);
    if (find_cookie(shown.lights[i]) && i < cookies.size()) light.insert("cookie", cookies[i]);
    lights.push_back(std::move(light));
  }
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
  const auto read = [&](const TomlTable& table) {
    Light settled = checked_light(read_light(table), {});
    if (auto* spot = std::get_if<Spot>(&settled.kind)) spot->cookie = std::get<Spot>(light.kind).cookie;
    return settled;
  };
  return settle_by(
      light, "light '" + light.name + "'", [](const Light& each) { return write_light(each); }, read);
}

}  // namespace shadowbench::scene
