#include "harness/scene/lights/light.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <glm/gtx/rotate_vector.hpp>

#include "filters/base/error.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/toml_reader.h"

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

}  // namespace

glm::vec3 to_light(const Light& light, const glm::vec3&) {
  return std::visit([](const Sun& sun) { return -sun.direction_ws; }, light.kind);
}

double penumbra_per_metre(const Light& light) {
  return std::visit(
      [](const Sun& sun) { return 2.0 * std::tan(0.5 * glm::radians(static_cast<double>(sun.angular_diameter_deg))); },
      light.kind);
}

truth::AreaLight make_area_light(const Light& light) {
  return std::visit([](const auto& kind) { return make_area_light(kind); }, light.kind);
}

Light turn_light(Light light, const std::function<glm::vec3(const glm::vec3&)>& turn) {
  std::visit([&](Sun& sun) { sun.direction_ws = turn(sun.direction_ws); }, light.kind);
  return light;
}

Light place_in_sky(Light light, double azimuth_deg, double elevation_deg) {
  std::visit([&](Sun& sun) { sun.direction_ws = glm::vec3(light_direction(azimuth_deg, elevation_deg)); }, light.kind);
  return light;
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
  std::vector<std::string> keys = {"type", "color", "intensity", "map_center", "map_width", "map_near", "map_far"};
  keys.insert(keys.end(), sun_keys().begin(), sun_keys().end());
  table.require_known_keys(keys);
  table.choice("type", {"directional"}, "directional");
  Light light;
  light.kind = read_sun(table);
  light.color = glm::vec3(table.vec3("color", kColor, glm::dvec3(1.0)));
  light.intensity = table.number_f("intensity", {0.0, 1000.0}, 1.0);
  light.map_window = read_map_window(table);
  return light;
}

std::optional<LightKind> make_gltf_light(std::string_view type, const glm::dmat4& world_from_node) {
  if (type == "directional") return Sun{glm::vec3(-world_from_node[2])};
  return std::nullopt;
}

Light checked_light(Light light, const std::string& where) {
  light.kind = std::visit([&](const Sun& sun) -> LightKind { return checked_sun(sun, where); }, light.kind);
  const bool shines = std::isfinite(light.color.r + light.color.g + light.color.b) &&
                      glm::all(glm::greaterThanEqual(light.color, glm::vec3(0.0f))) && std::isfinite(light.intensity) &&
                      light.intensity >= 0.0f;
  if (shines) return light;
  fail_input(fmt::format("the light has colour ({}, {}, {}), intensity {}", light.color.r, light.color.g, light.color.b,
                         light.intensity),
             where);
}

std::string describe_light(const Light& light) {
  return std::visit([](const Sun& sun) { return fmt::format("a sun of {:.3g} degrees", sun.angular_diameter_deg); },
                    light.kind);
}

std::map<std::string, std::variant<double, std::string>> light_metadata(const Light& light) {
  using Metadata = std::map<std::string, std::variant<double, std::string>>;
  return std::visit(
      [](const Sun& sun) {
        const glm::vec3& d = sun.direction_ws;
        return Metadata{{"light_direction_ws", fmt::format("{} {} {}", d.x, d.y, d.z)},
                        {"light_angular_diameter_deg", static_cast<double>(sun.angular_diameter_deg)}};
      },
      light.kind);
}

std::vector<std::string> list_light_content(const Light& light) {
  const glm::vec3& c = light.color;
  std::vector<std::string> content = {std::visit(
      [&](const Sun& sun) {
        const glm::vec3& d = sun.direction_ws;
        return fmt::format("{} {} {} {} {} {} {} {} {}", light.kind.index(), d.x, d.y, d.z, c.r, c.g, c.b,
                           light.intensity, sun.angular_diameter_deg);
      },
      light.kind)};
  if (!light.map_window) return content;
  const MapWindow& w = *light.map_window;
  content.push_back(fmt::format("window {} {} {} {}", w.center_ws.x, w.center_ws.y, w.center_ws.z, w.width_m));
  if (w.planes) content.push_back(fmt::format("planes {} {}", w.planes->near_m, w.planes->far_m));
  return content;
}

}  // namespace shadowbench::scene
