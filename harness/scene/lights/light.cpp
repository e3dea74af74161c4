#include "harness/scene/lights/light.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/gtx/rotate_vector.hpp>

#include "base/bytes.h"
#include "base/error.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {
namespace {

std::optional<MapWindow> read_map_window(const TomlTable& table) {
  if (!table.has("map_width")) {
    for (const char* key : {"map_center", "map_near", "map_far"})
      if (table.has(key)) throw table.error(key, fmt::format("'{}' in [light] needs 'map_width'", key));
    return std::nullopt;
  }
  MapWindow window;
  window.center_ws = table.vec3("map_center", kAnyNumber);
  window.width_m = table.number("map_width", kPositive);
  if (!table.has("map_near") && !table.has("map_far")) return window;
  const MapWindow::Planes planes{table.number("map_near", kAnyNumber), table.number("map_far", kAnyNumber)};
  if (!(planes.far_m - planes.near_m >= kPositive.min)) {
    throw table.error("map_far", fmt::format("'map_far' in [light] is {}: it must lie beyond 'map_near', which is {}",
                                             planes.far_m, planes.near_m));
  }
  window.planes = planes;
  return window;
}

/// How kinds are read from a scene file, in the order of LightKind.
const std::vector<std::pair<std::string, LightKind (*)(const TomlTable&)>>& list_readers() {
  static const std::vector<std::pair<std::string, LightKind (*)(const TomlTable&)>> readers = {
      {"directional", [](const TomlTable& table) -> LightKind { return read_sun(table); }},
      {"spot", [](const TomlTable& table) -> LightKind { return read_spot(table); }},
      {"point", [](const TomlTable& table) -> LightKind { return read_point(table); }}};
  return readers;
}

std::vector<LightNumber> list_numbers(Light& light) {
  return std::visit([](auto& kind) { return list_numbers(kind); }, light.kind);
}

}  // namespace

toml::array write_place(const glm::vec3& place_ws, const glm::dvec3& origin) {
  toml::array written;
  for (int axis = 0; axis < 3; ++axis) written.push_back(write_number(place_ws[axis]) + origin[axis]);
  return written;
}

std::string write_vector(const glm::vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

void require_light_keys(const TomlTable& table, const std::vector<std::string>& own) {
  table.require_known_keys({"type", "name", "color", "intensity"}, own);
}

std::vector<LightSlider> list_sliders(Light& light) {
  constexpr const char* kAxes[][3] = {{""}, {" u", " v"}, {" x", " y", " z"}};
  std::vector<LightSlider> sliders;
  for (const NumberRole role : {NumberRole::kSize, NumberRole::kAngle, NumberRole::kPlace}) {
    for (const LightNumber& number : list_numbers(light)) {
      const bool moves = number.slider || role == NumberRole::kPlace;
      if (number.role != role || !number.is_used || !moves) continue;
      std::string name = number.key.substr(0, number.key.find("_deg"));
      std::ranges::replace(name, '_', ' ');
      for (std::size_t i = 0; i < number.values.size(); ++i)
        sliders.push_back({name + kAxes[number.values.size() - 1][i], role == NumberRole::kAngle ? "degrees" : "m",
                           &number.values[i], number.slider});
    }
  }
  return sliders;
}

glm::vec3 to_light(const Light& light, const glm::vec3& point_ws) {
  return std::visit([&](const auto& kind) { return to_light(kind, point_ws); }, light.kind);
}

std::optional<Beam> find_beam(const Light& light) {
  return std::visit([](const auto& kind) { return find_beam(kind); }, light.kind);
}

bool shines_on(const Light& light, const glm::vec3& point_ws) {
  const std::optional<Beam> beam = find_beam(light);
  return !beam || beam->cone_at(glm::dvec3(point_ws)) > 0.0;
}

double light_size(const Light& light) {
  return std::visit([](const auto& kind) { return light_size(kind); }, light.kind);
}

double penumbra_width(const Light& light, const glm::vec3& receiver_ws, double occluder_m) {
  const std::optional<Beam> beam = find_beam(light);
  if (!beam) return light_size(light) * occluder_m;
  const double distance = glm::length(glm::dvec3(receiver_ws) - beam->position_ws);
  return light_size(light) * occluder_m / (distance - occluder_m) * beam->reference_m / distance;
}

truth::AreaLight make_area_light(const Light& light) {
  return std::visit([](const auto& kind) { return make_area_light(kind); }, light.kind);
}

Light turn_light(Light light, const LightTurn& turn) {
  std::visit([&](auto& kind) { turn_light(kind, turn); }, light.kind);
  return light;
}

Light turn_about_vertical(const Light& light, double angle_rad) {
  return turn_light(
      light, [&](const glm::vec3& v) { return glm::rotateY(glm::dvec3(v), angle_rad); });
}

Light place_in_sky(Light light, const SkyAngles& place) {
  const glm::vec3 direction(light_direction(place.azimuth_deg, place.elevation_deg));
  return turn_light(std::move(light), [&](const glm::vec3&) { return direction; });
}

Light read_light(const TomlTable& table, const glm::dvec3& origin) {
  Light light;
  light.kind = table.choose("type", list_readers(), "directional")(table);
  for (const LightNumber& number : list_numbers(light)) {
    if (number.role != NumberRole::kPlace) continue;
    const glm::vec3 place(table.vec3(number.key, kAnyNumber) - origin);
    std::copy_n(&place.x, 3, number.values.begin());
  }
  light.name = table.string("name", light.name);
  light.color = glm::vec3(table.vec3("color", kColor, glm::dvec3(1.0)));
  light.intensity = table.number_f("intensity", {0.0, 1000.0}, 1.0);
  light.map_window = read_map_window(table);
  if (light.map_window) light.map_window->center_ws -= origin;
  return light;
}

toml::table write_light(Light light, const glm::dvec3& origin) {
  if (auto* spot = std::get_if<Spot>(&light.kind))
    spot->inner_cone_deg = std::min(spot->inner_cone_deg, spot->cone_deg);
  toml::table table{{"type", list_readers()[light.kind.index()].first},
                    {"color", write_numbers(std::span(&light.color.x, 3))},
                    {"intensity", write_number(light.intensity)}};
  for (const LightNumber& number : list_numbers(light)) {
    if (!number.is_used) continue;
    if (number.role == NumberRole::kPlace)
      table.insert(number.key, write_place(glm::vec3(number.values[0], number.values[1], number.values[2]), origin));
    else if (number.values.size() > 1)
      table.insert(number.key, write_numbers(number.values));
    else
      table.insert(number.key, write_number(number.values.front()));
  }
  if (!light.name.empty()) table.insert("name", light.name);
  if (!light.map_window) return table;
  const MapWindow& window = *light.map_window;
  const glm::dvec3 center = window.center_ws + origin;
  table.insert("map_center", toml::array{center.x, center.y, center.z});
  table.insert("map_width", window.width_m);
  if (!window.planes) return table;
  table.insert("map_near", window.planes->near_m);
  table.insert("map_far", window.planes->far_m);
  return table;
}

std::optional<LightKind> make_gltf_light(std::string_view type, const glm::dmat4& world_from_node,
                                         double inner_cone_rad, double outer_cone_rad) {
  const glm::dvec3 ahead = -glm::dvec3(world_from_node[2]), position(world_from_node[3]);
  if (type == "directional") return Sun{glm::vec3(ahead)};
  if (type == "point") return PointLight{.position_ws = glm::vec3(position)};
  if (type != "spot") return std::nullopt;
  const auto full_deg = [](double half_rad) { return static_cast<float>(2.0 * glm::degrees(half_rad)); };
  return Spot{.position_ws = glm::vec3(position),
              .target_ws = glm::vec3(position + glm::normalize(ahead)),
              .cone_deg = std::min(full_deg(outer_cone_rad), kWidestCone_deg),
              .inner_cone_deg = std::min(full_deg(inner_cone_rad), kWidestCone_deg)};
}

GltfLight describe_gltf_light(const Light& light) {
  GltfLight made;
  made.type = list_readers()[light.kind.index()].first;
  const auto half_rad = [](float full_deg) { return glm::radians(0.5 * static_cast<double>(full_deg)); };
  if (const auto* sun = std::get_if<Sun>(&light.kind)) made.direction_ws = glm::dvec3(sun->direction_ws);
  if (const auto beam = find_beam(light)) {
    made.position_ws = beam->position_ws;
    made.direction_ws = beam->axis_ws;
  }
  if (const auto* spot = std::get_if<Spot>(&light.kind)) {
    made.outer_cone_rad = half_rad(spot->cone_deg);
    made.inner_cone_rad = half_rad(std::min(spot->inner_cone_deg, spot->cone_deg));
  }
  return made;
}

toml::table list_gltf_extras(const Light& light) {
  toml::table extras = write_light(light);
  for (const char* key : {"type", "name", "color", "direction", "position"}) extras.erase(key);
  return extras;
}

Light with_gltf_extras(const Light& light, const toml::table& extras, const std::string& where,
                       const glm::dvec3& origin) {
  toml::table table = write_light(light, origin);
  if (extras.contains("size")) table.erase("radius");
  for (const auto& [key, value] : extras) table.insert_or_assign(key.str(), value);
  return read_light(TomlTable(std::move(table), "the extras of a light", {.file = where}), origin);
}

Light aim_light(Light light, const glm::vec3& center_ws) {
  std::visit([&](auto& kind) { aim_light(kind, center_ws); }, light.kind);
  return light;
}

Light checked_light(Light light, const std::string& where) {
  light.kind = std::visit([&](const auto& kind) -> LightKind { return checked_light(kind, where); }, light.kind);
  const bool shines = std::isfinite(light.color.r + light.color.g + light.color.b) &&
                      glm::all(glm::greaterThanEqual(light.color, glm::vec3(0.0f))) && std::isfinite(light.intensity) &&
                      light.intensity >= 0.0f;
  if (shines) return light;
  fail_input(fmt::format("the light has colour ({}, {}, {}), intensity {}", light.color.r, light.color.g, light.color.b,
                         light.intensity),
             where);
}

std::string describe_light(const Light& light) {
  return std::visit([](const auto& kind) { return describe_light(kind); }, light.kind);
}

LightMetadata light_metadata(Light light) {
  constexpr const char* kUnits[] = {"_ws", "_ws", "_m", "_m", ""};  // of NumberRole; an angle's key names its own
  LightMetadata metadata;
  for (const LightNumber& number : list_numbers(light)) {
    auto& said = metadata["light_" + number.key + kUnits[static_cast<int>(number.role)]];
    if (number.values.size() > 1)
      said = fmt::format("{}", fmt::join(number.values, " "));
    else
      said = static_cast<double>(number.values.front());
  }
  return metadata;
}

std::vector<std::string> list_light_content(Light light) {
  std::string text = fmt::format("{} {} {}", light.kind.index(), write_vector(light.color), light.intensity);
  for (const LightNumber& number : list_numbers(light)) text += fmt::format(" {}", fmt::join(number.values, " "));
  std::vector<std::string> content = {std::move(text)};
  if (!light.map_window) return content;
  const MapWindow& w = *light.map_window;
  content.push_back(fmt::format("window {} {} {} {}", w.center_ws.x, w.center_ws.y, w.center_ws.z, w.width_m));
  if (w.planes) content.push_back(fmt::format("planes {} {}", w.planes->near_m, w.planes->far_m));
  return content;
}

}  // namespace shadowbench::scene
