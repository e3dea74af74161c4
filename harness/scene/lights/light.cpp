#include "harness/scene/lights/light.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <glm/gtx/rotate_vector.hpp>

#include "filters/base/content_hash.h"
#include "filters/base/error.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"
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

std::string write_vector(const glm::vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

}  // namespace

glm::vec3 to_light(const Light& light, const glm::vec3& point_ws) {
  return std::visit(Each{[](const Sun& sun) { return -sun.direction_ws; },
                         [&](const auto& lamp) { return glm::normalize(lamp.position_ws - point_ws); }},
                    light.kind);
}

std::optional<Beam> find_beam(const Light& light) {
  return std::visit(Each{[](const Sun&) -> std::optional<Beam> { return std::nullopt; },
                         [](const auto& lamp) -> std::optional<Beam> { return make_beam(lamp); }},
                    light.kind);
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
  return std::visit(Each{[](const Sun& sun) {
                           return 2.0 * std::tan(0.5 * glm::radians(static_cast<double>(sun.angular_diameter_deg)));
                         },
                         [](const Spot& spot) { return diameter_of(spot); },
                         [](const PointLight& point) { return 2.0 * static_cast<double>(point.radius_m); }},
                    light.kind);
}

truth::AreaLight make_area_light(const Light& light) {
  return std::visit([](const auto& kind) { return make_area_light(kind); }, light.kind);
}

Light turn_light(Light light, const std::function<glm::vec3(const glm::vec3&)>& turn) {
  std::visit(Each{[&](Sun& sun) { sun.direction_ws = turn(sun.direction_ws); },
                  [&](Spot& spot) {
                    const glm::vec3 way = spot.target_ws - spot.position_ws;
                    spot.position_ws = spot.target_ws - glm::length(way) * turn(glm::normalize(way));
                  },
                  [&](PointLight& point) {
                    const float distance = glm::length(point.position_ws);
                    if (distance > 0.0f) point.position_ws = -distance * turn(-point.position_ws / distance);
                  }},
             light.kind);
  return light;
}

Light place_in_sky(Light light, double azimuth_deg, double elevation_deg) {
  const glm::vec3 direction(light_direction(azimuth_deg, elevation_deg));
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
  const std::string type = table.choice("type", {"directional", "spot", "point"}, "directional");
  std::vector<std::string> keys = type == "spot" ? spot_keys() : type == "point" ? point_keys() : sun_keys();
  keys.insert(keys.begin(), {"type", "name", "color", "intensity"});
  if (type == "directional") keys.insert(keys.end(), {"map_center", "map_width", "map_near", "map_far"});
  table.require_known_keys(keys);
  Light light;
  light.name = table.string("name", light.name);
  if (type == "spot")
    light.kind = read_spot(table);
  else if (type == "point")
    light.kind = read_point(table);
  else
    light.kind = read_sun(table);
  light.color = glm::vec3(table.vec3("color", kColor, glm::dvec3(1.0)));
  light.intensity = table.number_f("intensity", {0.0, 1000.0}, 1.0);
  light.map_window = read_map_window(table);
  return light;
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
  if (auto* spot = std::get_if<Spot>(&light.kind)) {
    const glm::vec3 ahead = spot->target_ws - spot->position_ws;
    const float distance = glm::dot(center_ws - spot->position_ws, ahead);
    if (distance > 0.0f) spot->target_ws = spot->position_ws + distance * ahead;
  }
  if (auto* point = std::get_if<PointLight>(&light.kind)) {
    const float distance = glm::distance(center_ws, point->position_ws);
    if (distance > 0.0f) point->reference_m = distance;
  }
  return light;
}

Light checked_light(Light light, const std::string& where) {
  light.kind = std::visit(Each{[&](const Sun& sun) -> LightKind { return checked_sun(sun, where); },
                               [&](const Spot& spot) -> LightKind { return checked_spot(spot, where); },
                               [&](const PointLight& point) -> LightKind { return checked_point(point, where); }},
                          light.kind);
  const bool shines = std::isfinite(light.color.r + light.color.g + light.color.b) &&
                      glm::all(glm::greaterThanEqual(light.color, glm::vec3(0.0f))) && std::isfinite(light.intensity) &&
                      light.intensity >= 0.0f;
  if (shines) return light;
  fail_input(fmt::format("the light has colour ({}, {}, {}), intensity {}", light.color.r, light.color.g, light.color.b,
                         light.intensity),
             where);
}

std::string describe_light(const Light& light) {
  return std::visit(
      Each{[](const Sun& sun) { return fmt::format("a sun of {:.3g} degrees", sun.angular_diameter_deg); },
           [](const Spot& spot) {
             const std::string size = spot.size_m.x > 0.0f
                                          ? fmt::format("{:.3g} x {:.3g}", spot.size_m.x, spot.size_m.y)
                                          : fmt::format("{:.3g}", 2.0f * spot.radius_m);
             return fmt::format("a spot light of {} m, {:.3g} m from its target", size,
                                glm::distance(spot.position_ws, spot.target_ws));
           },
           [](const PointLight& point) {
             return fmt::format("a point light, a sphere of {:.3g} m", 2.0f * point.radius_m);
           }},
      light.kind);
}

std::map<std::string, std::variant<double, std::string>> light_metadata(const Light& light) {
  using Metadata = std::map<std::string, std::variant<double, std::string>>;
  return std::visit(Each{[](const Sun& sun) {
                           return Metadata{
                               {"light_direction_ws", write_vector(sun.direction_ws)},
                               {"light_angular_diameter_deg", static_cast<double>(sun.angular_diameter_deg)}};
                         },
                         [](const Spot& spot) {
                           return Metadata{{"light_position_ws", write_vector(spot.position_ws)},
                                           {"light_target_ws", write_vector(spot.target_ws)},
                                           {"light_cone_deg", static_cast<double>(spot.cone_deg)},
                                           {"light_inner_cone_deg", static_cast<double>(spot.inner_cone_deg)},
                                           {"light_radius_m", static_cast<double>(spot.radius_m)},
                                           {"light_size_m", fmt::format("{} {}", spot.size_m.x, spot.size_m.y)}};
                         },
                         [](const PointLight& point) {
                           return Metadata{{"light_position_ws", write_vector(point.position_ws)},
                                           {"light_reference_m", static_cast<double>(point.reference_m)},
                                           {"light_radius_m", static_cast<double>(point.radius_m)}};
                         }},
                    light.kind);
}

std::vector<std::string> list_light_content(const Light& light) {
  const glm::vec3& c = light.color;
  std::vector<std::string> content = {std::visit(
      Each{[&](const Sun& sun) {
             const glm::vec3& d = sun.direction_ws;
             return fmt::format("{} {} {} {} {} {} {} {} {}", light.kind.index(), d.x, d.y, d.z, c.r, c.g, c.b,
                                light.intensity, sun.angular_diameter_deg);
           },
           [&](const Spot& spot) {
             return fmt::format(
                 "{} {} {} {} {} {} {} {} {}", light.kind.index(), write_vector(spot.position_ws),
                 write_vector(spot.target_ws), c.r, c.g, c.b, light.intensity, spot.radius_m,
                 fmt::format("{} {} {} {}", spot.cone_deg, spot.inner_cone_deg, spot.size_m.x, spot.size_m.y));
           },
           [&](const PointLight& point) {
             return fmt::format("{} {} {} {} {} {} {} {}", light.kind.index(), write_vector(point.position_ws), c.r,
                                c.g, c.b, light.intensity, point.radius_m, point.reference_m);
           }},
      light.kind)};
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
