#include "harness/scene/scene_object.h"

#include <fmt/format.h>

#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <utility>

#include "harness/scene/primitives.h"

namespace shadowbench::scene {
namespace {

constexpr Range kCells{1, 512};
constexpr Range kSegments{3, 1024};
constexpr Range kCount{1, 10000};
constexpr Range kDegrees{-36000, 36000};

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
  const std::map<std::string, BarDirection> kDirections{
      {"vertical", BarDirection::kVertical}, {"horizontal", BarDirection::kHorizontal}, {"both", BarDirection::kBoth}};
  Bars bars;
  bars.count = object.integer("count", kCount);
  bars.bar_width_m = object.number_f("bar_width", kPositive);
  bars.spacing_m = object.number_f("spacing", kPositive);
  bars.length_m = object.number_f("length", kPositive);
  bars.direction = kDirections.at(object.choice("direction", {"vertical", "horizontal", "both"}, "vertical"));
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

}  // namespace

const std::vector<std::string>& common_object_keys() {
  static const std::vector<std::string> keys{"shape",          "name",   "material",     "casts_shadow",
                                             "may_cull_front", "center", "rotation_deg", "scale"};
  return keys;
}

const std::vector<std::string>& object_shapes() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, shape] : shapes()) all.push_back(name);
    all.emplace_back("model");
    return all;
  }();
  return names;
}

Mesh make_shape(const TomlTable& object) {
  const std::string name = object.choice("shape", object_shapes());
  const Shape& shape = shapes().at(name);
  std::vector<std::string> known = common_object_keys();
  known.insert(known.end(), shape.keys.begin(), shape.keys.end());
  object.require_known_keys(known);
  return shape.make(object);
}

glm::dmat4 world_from_object(const TomlTable& object) {
  const glm::dvec3 angles = glm::radians(object.vec3("rotation_deg", kDegrees, glm::dvec3(0.0)));
  glm::dmat4 world = glm::translate(glm::dmat4(1.0), object.vec3("center", kAnyNumber, glm::dvec3(0.0)));
  world = glm::rotate(world, angles.z, glm::dvec3(0.0, 0.0, 1.0));
  world = glm::rotate(world, angles.y, glm::dvec3(0.0, 1.0, 0.0));
  world = glm::rotate(world, angles.x, glm::dvec3(1.0, 0.0, 0.0));
  return glm::scale(world, read_scale(object));
}

}  // namespace shadowbench::scene
