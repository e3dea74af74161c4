#include "harness/scene/lights/light.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <glm/gtx/rotate_vector.hpp>
#include <limits>
#include <numbers>
#include <span>

#include "base/error.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {
namespace {

constexpr double kLeastCone_deg = 0.1;

template <class... Cases>
struct Overloads : Cases... {
  using Cases::operator()...;
};

/// Calls the case of the light's kind.
template <class AnyLight, class... Cases>
auto by_kind(AnyLight& light, Cases... cases) {
  return std::visit(Overloads<Cases...>{cases...}, light.kind);
}

/// What a number of a light is. It tells the unit that a picture's metadata write behind its name, and the order of the
/// window's sliders: sizes, angles, places.
enum class NumberRole { kDirection, kPlace, kSize, kReach, kAngle };

/// A number of a light, or those of a vector. Scene files, metadata, names of cells and sliders say what the list of
/// its kind has.
struct LightNumber {
  std::string key;  ///< in a scene file: "cone_deg"
  NumberRole role;
  std::span<float> values;        ///< of the light that was asked
  std::optional<Range> slider{};  ///< what it may be set to; a place may be anything
  bool is_used = true;            ///< else the light has another in its place, a size for a radius
};

/// All numbers of a light.
std::vector<LightNumber> list_numbers(Light& light) {
  using Numbers = std::vector<LightNumber>;
  return by_kind(
      light,
      [](Sun& sun) {
        return Numbers{{"direction", NumberRole::kDirection, {&sun.direction_ws.x, 3}},
                       {"angular_diameter_deg", NumberRole::kAngle, {&sun.angular_diameter_deg, 1}, Range{0.0, 20.0}}};
      },
      [](Spot& spot) {
        const bool flat = spot.is_rectangle();
        return Numbers{{"position", NumberRole::kPlace, {&spot.position_ws.x, 3}},
                       {"target", NumberRole::kPlace, {&spot.target_ws.x, 3}},
                       {"radius", NumberRole::kSize, {&spot.radius_m, 1}, Range{0.0, 1.0}, !flat},
                       {"cone_deg", NumberRole::kAngle, {&spot.cone_deg, 1}, Range{1.0, double{kWidestCone_deg}}},
                       {"inner_cone_deg", NumberRole::kAngle, {&spot.inner_cone_deg, 1}},
                       {"size", NumberRole::kSize, {&spot.size_m.x, 2}, Range{0.01, 2.0}, flat}};
      },
      [](PointLight& point) {
        return Numbers{{"position", NumberRole::kPlace, {&point.position_ws.x, 3}},
                       {"radius", NumberRole::kSize, {&point.radius_m, 1}, Range{0.0, 1.0}},
                       {"reference", NumberRole::kReach, {&point.reference_m, 1}}};
      });
}

Beam make_beam(const Spot& spot) {
  const glm::dvec3 way = glm::dvec3(spot.target_ws) - glm::dvec3(spot.position_ws);
  const auto half_cosine = [](float degrees) { return std::cos(0.5 * glm::radians(static_cast<double>(degrees))); };
  return {glm::dvec3(spot.position_ws), glm::normalize(way), half_cosine(spot.inner_cone_deg),
          half_cosine(spot.cone_deg), glm::length(way)};
}

/// Without an edge; its axis says nothing, unless it is a face's of a cube.
Beam make_beam(const PointLight& point, const glm::dvec3& axis = {0.0, -1.0, 0.0}) {
  constexpr double kEveryCosine = -2.0;
  return {glm::dvec3(point.position_ws), axis, kEveryCosine, kEveryCosine, static_cast<double>(point.reference_m)};
}

Beam make_face_beam(const PointLight& point, int face) {
  glm::dvec3 axis(0.0);
  axis[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
  return make_beam(point, axis);
}

AxisExtent find_extent_of_faces(const PointLight& point, const Scene& scene, double tangent) {
  AxisExtent extent;
  for (int face = 0; face < kCubeFaces; ++face)
    extent = extent.joined(find_extent(scene, look_along(make_face_beam(point, face)), tangent));
  return extent;
}

/// Depth is the distance: what is nearest along an axis is at least as far away, and no point is farther than a corner.
AxisExtent find_distances(const PointLight& point, const Scene& scene) {
  AxisExtent extent = find_extent_of_faces(point, scene, 1.0);
  for (const Mesh& mesh : scene.meshes)
    for (const Vertex& vertex : mesh.vertices)
      extent.farthest =
          std::max(extent.farthest, static_cast<double>(glm::distance(vertex.position_ws, point.position_ws)));
  return extent;
}

std::vector<LightFrustum> fit_paraboloids(const PointLight& point, const Scene& scene, const FitRequest& request) {
  const AxisExtent distances = find_distances(point, scene);
  std::vector<LightFrustum> halves;
  for (int half = 0; half < kHalfSpheres; ++half) {
    constexpr int kUp = 2, kDown = 3;
    LightFrustum fit = fit_perspective(make_face_beam(point, half == 0 ? kDown : kUp), 1.0, distances, request);
    fit.shape = MapShape::kParaboloid;
    fit.uv_depth_from_world = glm::mat4(fit.light_from_world);
    fit.paraboloid.radius = 0.5 * count_used_texels(request) / request.map_size;
    fit.paraboloid.center += request.shift_texels / static_cast<double>(request.map_size);
    fit.texel_size_ws = 2.0 * static_cast<double>(point.reference_m) / (fit.paraboloid.radius * request.map_size);
    fit.width_ws = fit.texel_size_ws * request.map_size;
    fit.layer = half;
    fit.share = HalfSphere{half == 1};
    halves.push_back(std::move(fit));
  }
  return halves;
}

std::vector<LightFrustum> fit_point(const PointLight& point, const Scene& scene, const FitRequest& request) {
  if (request.mode == FitMode::kParaboloid) return fit_paraboloids(point, scene, request);
  const double tangent = pad_tangent(1.0, request);
  const AxisExtent extent = find_extent_of_faces(point, scene, tangent);
  std::vector<LightFrustum> faces;
  for (int face = 0; face < kCubeFaces; ++face) {
    faces.push_back(fit_perspective(make_face_beam(point, face), tangent, extent, request));
    faces.back().layer = face;
    faces.back().share = CubeFace{face};
  }
  return faces;
}

std::vector<LightFrustum> fit_spot(const Spot& spot, const Scene& scene, const FitRequest& request) {
  const Beam beam = make_beam(spot);
  const double tangent = pad_tangent(std::tan(0.5 * glm::radians(static_cast<double>(spot.cone_deg))), request);
  return {fit_perspective(beam, tangent, find_extent(scene, look_along(beam), tangent), request)};
}

/// Refuses the keys of a [light] that neither all lights have nor one of this kind.
void require_light_keys(const TomlTable& table, const std::vector<std::string>& own) {
  table.require_known_keys({"type", "name", "color", "intensity"}, own);
}

PointLight read_point(const TomlTable& table) {
  require_light_keys(table, {"position", "radius", "reference"});
  PointLight point;
  point.position_ws = glm::vec3(table.vec3("position", kAnyNumber));
  point.radius_m = table.number_f("radius", {0.0, 1000.0}, static_cast<double>(point.radius_m));
  point.reference_m = table.number_f("reference", kPositive, 1.0);
  return point;
}

Spot read_spot(const TomlTable& table) {
  require_light_keys(table, {"position", "target", "cone_deg", "inner_cone_deg", "radius", "size"});
  Spot spot;
  spot.position_ws = glm::vec3(table.vec3("position", kAnyNumber));
  spot.target_ws = glm::vec3(table.vec3("target", kAnyNumber));
  const double cone_deg = table.number("cone_deg", {kLeastCone_deg, double{kWidestCone_deg}}, 60.0);
  spot.cone_deg = static_cast<float>(cone_deg);
  spot.inner_cone_deg = table.number_f("inner_cone_deg", {0.0, cone_deg}, 0.75 * cone_deg);
  spot.radius_m = table.number_f("radius", {0.0, 1000.0}, static_cast<double>(spot.radius_m));
  if (table.has("size")) {
    if (table.has("radius")) throw table.error("size", "[light] has both a 'radius' and a 'size': give one");
    spot.size_m = glm::vec2(table.vec2("size", kPositive));
    spot.radius_m = 0.0f;
  }
  if (spot.position_ws == spot.target_ws)
    throw table.error("target", "'target' in [light] is where the light stands: it has no direction");
  return spot;
}

glm::dvec3 read_sun_direction(const TomlTable& table) {
  const bool by_angles = table.has("azimuth_deg") || table.has("elevation_deg");
  if (table.has("direction") == by_angles) {
    throw table.error("direction",
                      "[light] needs a direction: either 'direction', or 'azimuth_deg' and 'elevation_deg'");
  }
  if (by_angles) {
    const double azimuth = table.number("azimuth_deg", {-360.0, 360.0});
    return light_direction(azimuth, table.number("elevation_deg", {-90.0, 90.0}));
  }
  const glm::dvec3 direction = table.vec3("direction", kAnyNumber);
  if (glm::length(direction) > 0.0) return direction;
  throw table.error("direction", "the light has no direction: 'direction' is [0, 0, 0]");
}

Sun read_sun(const TomlTable& table) {
  require_light_keys(table, {"direction", "azimuth_deg", "elevation_deg", "angular_diameter_deg", "map_center",
                             "map_width", "map_near", "map_far"});
  const glm::vec3 direction(read_sun_direction(table));
  return {direction, table.number_f("angular_diameter_deg", {0.0, 90.0}, Sun().angular_diameter_deg)};
}

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

}  // namespace

bool Spot::is_rectangle() const { return size_m.x > 0.0f && size_m.y > 0.0f; }

double Beam::cone_at(const glm::dvec3& point_ws) const {
  const glm::dvec3 way = point_ws - position_ws;
  const double cosine = glm::dot(way, axis_ws) / std::max(glm::length(way), std::numeric_limits<double>::min());
  const double ramp = std::clamp((cosine - cos_outer) / std::max(cos_inner - cos_outer, 1e-4), 0.0, 1.0);
  return ramp * ramp;
}

toml::array write_place(const glm::vec3& place_ws, const glm::dvec3& origin) {
  toml::array written;
  for (int axis = 0; axis < 3; ++axis) written.push_back(write_number(place_ws[axis]) + origin[axis]);
  return written;
}

std::string write_vector(const glm::vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

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

glm::dvec3 light_direction(double azimuth_deg, double elevation_deg) {
  const double azimuth = glm::radians(azimuth_deg);
  const double elevation = glm::radians(elevation_deg);
  return -glm::dvec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                     std::cos(elevation) * std::cos(azimuth));
}

glm::vec3 to_light(const Light& light, const glm::vec3& point_ws) {
  return by_kind(
      light, [](const Sun& sun) { return -sun.direction_ws; },
      [&](const auto& lamp) { return glm::normalize(lamp.position_ws - point_ws); });
}

std::optional<Beam> find_beam(const Light& light) {
  return by_kind(
      light, [](const Sun&) { return std::optional<Beam>(); },
      [](const auto& lamp) { return std::optional(make_beam(lamp)); });
}

bool shines_on(const Light& light, const glm::vec3& point_ws) {
  const std::optional<Beam> beam = find_beam(light);
  return !beam || beam->cone_at(glm::dvec3(point_ws)) > 0.0;
}

double light_size(const Light& light) {
  return by_kind(
      light,
      [](const Sun& sun) { return 2.0 * std::tan(0.5 * glm::radians(static_cast<double>(sun.angular_diameter_deg))); },
      [](const Spot& spot) {
        if (!spot.is_rectangle()) return 2.0 * static_cast<double>(spot.radius_m);
        const double area = static_cast<double>(spot.size_m.x) * static_cast<double>(spot.size_m.y);
        return 2.0 * std::sqrt(area / std::numbers::pi);
      },
      [](const PointLight& point) { return 2.0 * static_cast<double>(point.radius_m); });
}

double penumbra_width(const Light& light, const glm::vec3& receiver_ws, double occluder_m) {
  const std::optional<Beam> beam = find_beam(light);
  if (!beam) return light_size(light) * occluder_m;
  const double distance = glm::length(glm::dvec3(receiver_ws) - beam->position_ws);
  return light_size(light) * occluder_m / (distance - occluder_m) * beam->reference_m / distance;
}

truth::AreaLight make_area_light(const Light& light) {
  return by_kind(
      light,
      [](const Sun& sun) {
        return truth::AreaLight::make_sun(-glm::dvec3(sun.direction_ws), static_cast<double>(sun.angular_diameter_deg));
      },
      [](const Spot& spot) {
        const Beam beam = make_beam(spot);
        if (!spot.is_rectangle())
          return truth::AreaLight::make_disk(beam.position_ws, beam.axis_ws, static_cast<double>(spot.radius_m));
        const glm::dmat3 axes = glm::transpose(light_rotation(beam.axis_ws));
        return truth::AreaLight::make_rectangle(beam.position_ws, 0.5 * static_cast<double>(spot.size_m.x) * axes[0],
                                                0.5 * static_cast<double>(spot.size_m.y) * axes[1]);
      },
      [](const PointLight& point) {
        return truth::AreaLight::make_sphere(glm::dvec3(point.position_ws), static_cast<double>(point.radius_m));
      });
}

Light turn_light(Light light, const LightTurn& turn) {
  by_kind(
      light, [&](Sun& sun) { sun.direction_ws = turn(sun.direction_ws); },
      [&](Spot& spot) {
        const glm::vec3 way = spot.target_ws - spot.position_ws;
        spot.position_ws = spot.target_ws - glm::length(way) * turn(glm::normalize(way));
      },
      [&](PointLight& point) {
        const float distance = glm::length(point.position_ws);
        if (distance > 0.0f) point.position_ws = -distance * turn(-point.position_ws / distance);
      });
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
  by_kind(
      light, [](Sun&) {},
      [&](Spot& spot) {
        const glm::vec3 ahead = spot.target_ws - spot.position_ws;
        const float distance = glm::dot(center_ws - spot.position_ws, ahead);
        if (distance > 0.0f) spot.target_ws = spot.position_ws + distance * ahead;
      },
      [&](PointLight& point) {
        const float distance = glm::distance(center_ws, point.position_ws);
        if (distance > 0.0f) point.reference_m = distance;
      });
  return light;
}

Light checked_light(Light light, const std::string& where) {
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) fail_input(what, where);
  };
  by_kind(
      light,
      [&](Sun& sun) {
        sun.direction_ws = unit_direction(sun.direction_ws, "the light", where);
        require(sun.angular_diameter_deg >= 0.0f && sun.angular_diameter_deg < 180.0f,
                fmt::format("the light's angular diameter is {} degrees", sun.angular_diameter_deg));
      },
      [&](Spot& spot) {
        unit_direction(spot.target_ws - spot.position_ws, "the light", where);
        const double cone = static_cast<double>(spot.cone_deg);
        require(cone >= kLeastCone_deg && cone <= double{kWidestCone_deg} && spot.inner_cone_deg >= 0.0f &&
                    spot.inner_cone_deg <= spot.cone_deg && spot.radius_m >= 0.0f && std::isfinite(spot.radius_m) &&
                    glm::all(glm::greaterThanEqual(spot.size_m, glm::vec2(0.0f))) &&
                    std::isfinite(spot.size_m.x + spot.size_m.y),
                fmt::format("the spot light has a cone of {} degrees, {} within, and a radius of {} m: the cone must "
                            "lie within {} .. {}, and the inner one within it",
                            spot.cone_deg, spot.inner_cone_deg, spot.radius_m, kLeastCone_deg, kWidestCone_deg));
      },
      [&](PointLight& point) {
        const glm::vec3& p = point.position_ws;
        require(std::isfinite(p.x + p.y + p.z) && std::isfinite(point.radius_m) && point.radius_m >= 0.0f &&
                    std::isfinite(point.reference_m) && point.reference_m > 0.0f,
                fmt::format("the point light stands at ({}, {}, {}), with a radius of {} m and a reference of {} m: "
                            "the place must be finite, the radius 0 or more, the reference more than 0",
                            p.x, p.y, p.z, point.radius_m, point.reference_m));
      });
  require(std::isfinite(light.color.r + light.color.g + light.color.b) &&
              glm::all(glm::greaterThanEqual(light.color, glm::vec3(0.0f))) && std::isfinite(light.intensity) &&
              light.intensity >= 0.0f,
          fmt::format("the light has colour ({}, {}, {}), intensity {}", light.color.r, light.color.g, light.color.b,
                      light.intensity));
  return light;
}

std::string describe_light(const Light& light) {
  return by_kind(
      light, [](const Sun& sun) { return fmt::format("a sun of {:.3g} degrees", sun.angular_diameter_deg); },
      [](const Spot& spot) {
        const std::string size = spot.is_rectangle() ? fmt::format("{:.3g} x {:.3g}", spot.size_m.x, spot.size_m.y)
                                                     : fmt::format("{:.3g}", 2.0f * spot.radius_m);
        return fmt::format("a spot light of {} m, {:.3g} m from its target", size,
                           glm::distance(spot.position_ws, spot.target_ws));
      },
      [](const PointLight& point) {
        return fmt::format("a point light, a sphere of {:.3g} m", 2.0f * point.radius_m);
      });
}

int count_layers(const Light& light, const FitRule& rule) {
  return by_kind(
      light, [&](const Sun&) { return rule.mode == FitMode::kCascades && !light.map_window ? rule.cascades.count : 1; },
      [](const Spot&) { return 1; },
      [&](const PointLight&) { return rule.mode == FitMode::kParaboloid ? kHalfSpheres : kCubeFaces; });
}

std::vector<LightFrustum> fit_layers(const Scene& scene, const FitRequest& request) {
  const Light& light = request.light ? *request.light : scene.light;
  return by_kind(
      light,
      [&](const Sun& sun) { return fit_sun(sun, light.map_window ? &*light.map_window : nullptr, scene, request); },
      [&](const Spot& spot) { return fit_spot(spot, scene, request); },
      [&](const PointLight& point) { return fit_point(point, scene, request); });
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
