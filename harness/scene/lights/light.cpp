#include "harness/scene/lights/light.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <glm/gtx/rotate_vector.hpp>

#include "filters/base/content_hash.h"
#include "filters/base/error.h"
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

/// How a kind is read from a scene file; listed in the order of LightKind.
struct KindReader {
  std::string_view type;
  const std::vector<std::string>& (*keys)();
  LightKind (*read)(const TomlTable& table);
};

const std::array<KindReader, 3>& list_readers() {
  static const std::array<KindReader, 3> readers = {
      {{"directional", sun_keys, [](const TomlTable& table) -> LightKind { return read_sun(table); }},
       {"spot", spot_keys, [](const TomlTable& table) -> LightKind { return read_spot(table); }},
       {"point", point_keys, [](const TomlTable& table) -> LightKind { return read_point(table); }}}};
  return readers;
}

}  // namespace

double write_number(float value) {
  const std::string text = fmt::format("{}", value);
  double number = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

std::vector<double> write_numbers(const glm::vec3& v) {
  return {write_number(v.x), write_number(v.y), write_number(v.z)};
}

std::string write_vector(const glm::vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

std::vector<LightNumber> list_coordinates(const std::string& name, glm::vec3& place_ws) {
  return {{name + " x", "m", &place_ws.x, 0.0f, -1.0f},
          {name + " y", "m", &place_ws.y, 0.0f, -1.0f},
          {name + " z", "m", &place_ws.z, 0.0f, -1.0f}};
}

std::vector<LightNumber> list_numbers(Light& light) {
  return std::visit([](auto& kind) { return list_numbers(kind); }, light.kind);
}

glm::vec3 to_light(const Light& light, const glm::vec3& point_ws) {
  return std::visit([&](const auto& kind) { return to_light(kind, point_ws); }, light.kind);
}

std::optional<Beam> find_beam(const Light& light) {
  return std::visit([](const auto& kind) { return find_beam(kind); }, light.kind);
}

const Texture* find_cookie(const Light& light) {
  const auto* spot = std::get_if<Spot>(&light.kind);
  return spot ? spot->cookie.get() : nullptr;
}

bool shines_on(const Light& light, const glm::vec3& point_ws) {
  const std::optional<Beam> beam = find_beam(light);
  return !beam || beam->cone_at(glm::dvec3(point_ws)) > 0.0;
}

double light_size(const Light& light) {
  return std::visit([](const auto& kind) { return light_size(kind); }, light.kind);
}

truth::AreaLight make_area_light(const Light& light) {
  return std::visit([](const auto& kind) { return make_area_light(kind); }, light.kind);
}

Light turn_light(Light light, const LightTurn& turn) {
  std::visit([&](auto& kind) { turn_light(kind, turn); }, light.kind);
  return light;
}

Light place_in_sky(Light light, const SkyAngles& place) {
  const glm::vec3 direction(light_direction(place.azimuth_deg, place.elevation_deg));
  return turn_light(std::move(light), [&](const glm::vec3&) { return direction; });
}

std::vector<Light> make_light_ring(const Light& first, int count) {
  assert(count >= 1);
  std::vector<Light> lights(1, first);
  for (int i = 1; i < count; ++i) {
    const double turn_rad = glm::radians(360.0 * i / count);
    lights.push_back(turn_light(first, [&](const glm::vec3& v) { return glm::rotateY(glm::dvec3(v), turn_rad); }));
  }
  return lights;
}

Light read_light(const TomlTable& table) {
  std::vector<std::string> types;
  for (const KindReader& each : list_readers()) types.emplace_back(each.type);
  const std::string type = table.choice("type", types, types.front());
  const KindReader& reader = *std::ranges::find(list_readers(), type, &KindReader::type);
  std::vector<std::string> keys = reader.keys();
  keys.insert(keys.begin(), {"type", "name", "color", "intensity"});
  table.require_known_keys(keys);
  Light light;
  light.name = table.string("name", light.name);
  light.kind = reader.read(table);
  light.color = glm::vec3(table.vec3("color", kColor, glm::dvec3(1.0)));
  light.intensity = table.number_f("intensity", {0.0, 1000.0}, 1.0);
  light.map_window = read_map_window(table);
  return light;
}

TomlEntries write_light(const Light& light) {
  TomlEntries entries = std::visit([](const auto& kind) { return write_light(kind); }, light.kind);
  if (!light.name.empty()) entries["name"] = light.name;
  entries["type"] = std::string(list_readers()[light.kind.index()].type);
  entries["color"] = write_numbers(light.color);
  entries["intensity"] = write_number(light.intensity);
  if (!light.map_window) return entries;
  const MapWindow& window = *light.map_window;
  entries["map_center"] = std::vector{window.center_ws.x, window.center_ws.y, window.center_ws.z};
  entries["map_width"] = window.width_m;
  if (!window.planes) return entries;
  entries["map_near"] = window.planes->near_m;
  entries["map_far"] = window.planes->far_m;
  return entries;
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

LightMetadata light_metadata(const Light& light) {
  return std::visit([](const auto& kind) { return light_metadata(kind); }, light.kind);
}

std::vector<std::string> list_light_content(const Light& light) {
  std::vector<std::string> content = {
      fmt::format("{} {} {} {}", light.kind.index(), write_vector(light.color), light.intensity,
                  std::visit([](const auto& kind) { return light_content(kind); }, light.kind))};
  if (const Texture* cookie = find_cookie(light)) {
    ContentHash texels;
    texels.add_values(std::span<const std::uint8_t>(cookie->rgba));
    content.push_back(fmt::format("cookie {} {} {}", cookie->width, cookie->height, texels.name()));
  }
  if (!light.map_window) return content;
  const MapWindow& w = *light.map_window;
  content.push_back(fmt::format("window {} {} {} {}", w.center_ws.x, w.center_ws.y, w.center_ws.z, w.width_m));
  if (w.planes) content.push_back(fmt::format("planes {} {}", w.planes->near_m, w.planes->far_m));
  return content;
}

}  // namespace shadowbench::scene
