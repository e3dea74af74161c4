#include "harness/scene/primitives.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

/// A rectangle that faces cross(edge_u, edge_v).
struct Patch {
  glm::vec3 corner;
  glm::vec3 edge_u;
  glm::vec3 edge_v;
  int cells_u;
  int cells_v;
};

/// Adds the two triangles of a quad whose corners a, b, c, d run counter-clockwise.
Mesh append_quad(Mesh mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
  return mesh;
}

Mesh append_patch(Mesh mesh, const Patch& patch) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const glm::vec3 normal = glm::normalize(glm::cross(patch.edge_u, patch.edge_v));
  for (int j = 0; j <= patch.cells_v; ++j) {
    for (int i = 0; i <= patch.cells_u; ++i) {
      const glm::vec2 uv(static_cast<float>(i) / static_cast<float>(patch.cells_u),
                         static_cast<float>(j) / static_cast<float>(patch.cells_v));
      mesh.vertices.push_back({patch.corner + uv.x * patch.edge_u + uv.y * patch.edge_v, normal, uv});
    }
  }
  const auto row = static_cast<std::uint32_t>(patch.cells_u + 1);
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(patch.cells_v); ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = first + j * row + i;
      mesh = append_quad(std::move(mesh), a, a + 1, a + 1 + row, a + row);
    }
  }
  return mesh;
}

int cells_along(float edge_m, float longest_m, int cells) {
  return std::max(1, static_cast<int>(std::lround(static_cast<float>(cells) * edge_m / longest_m)));
}

/// A point on the unit circle in the xz-plane; step 0 is +z, a quarter turn is +x.
glm::vec3 circle_point(int step, int segments) {
  const double angle = 2.0 * std::numbers::pi * (step % segments) / segments;
  return {static_cast<float>(std::sin(angle)), 0.0f, static_cast<float>(std::cos(angle))};
}

Mesh append_cylinder_side(Mesh mesh, float radius_m, float height_m, CylinderCells cut) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i <= cut.cells; ++i) {
    const float v = static_cast<float>(i) / static_cast<float>(cut.cells);
    for (int j = 0; j <= cut.segments; ++j) {
      const glm::vec3 outward = circle_point(j, cut.segments);
      const float u = static_cast<float>(j) / static_cast<float>(cut.segments);
      mesh.vertices.push_back({outward * radius_m + glm::vec3(0.0f, (0.5f - v) * height_m, 0.0f), outward, {u, v}});
    }
  }
  const auto row = static_cast<std::uint32_t>(cut.segments + 1);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(cut.cells); ++i) {
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t a = first + i * row + j;
      mesh = append_quad(std::move(mesh), a, a + row, a + row + 1, a + 1);
    }
  }
  return mesh;
}

/// Adds the top (side = 1) or the bottom (side = -1) of a cylinder.
Mesh append_cap(Mesh mesh, float radius_m, float height_m, int segments, float side) {
  const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
  const glm::vec3 middle(0.0f, 0.5f * side * height_m, 0.0f);
  const glm::vec3 normal(0.0f, side, 0.0f);
  mesh.vertices.push_back({middle, normal, glm::vec2(0.5f)});
  for (int j = 0; j < segments; ++j) {
    const glm::vec3 rim = circle_point(j, segments);
    mesh.vertices.push_back({middle + rim * radius_m, normal, glm::vec2(rim.x, rim.z) * 0.5f + 0.5f});
  }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(segments); ++j) {
    const std::uint32_t here = centre + 1 + j;
    const std::uint32_t next = centre + 1 + (j + 1) % static_cast<std::uint32_t>(segments);
    mesh.indices.insert(mesh.indices.end(), {centre, side > 0.0f ? here : next, side > 0.0f ? next : here});
  }
  return mesh;
}

Mesh move_by(Mesh mesh, glm::vec3 offset) {
  for (Vertex& vertex : mesh.vertices) vertex.position_ws += offset;
  return mesh;
}

}  // namespace

Mesh make_plane(glm::vec2 size_m, int cells) {
  const glm::vec3 corner(-0.5f * size_m.x, 0.0f, 0.5f * size_m.y);
  return append_patch({}, {corner, {size_m.x, 0.0f, 0.0f}, {0.0f, 0.0f, -size_m.y}, cells, cells});
}

Mesh make_box(glm::vec3 size_m, int cells) {
  const float longest = std::max({size_m.x, size_m.y, size_m.z});
  Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const bool positive = face % 2 == 0;
    const int u = (axis + (positive ? 1 : 2)) % 3;
    const int v = (axis + (positive ? 2 : 1)) % 3;
    Patch patch{-0.5f * size_m, glm::vec3(0.0f), glm::vec3(0.0f), cells_along(size_m[u], longest, cells),
                cells_along(size_m[v], longest, cells)};
    patch.edge_u[u] = size_m[u];
    patch.edge_v[v] = size_m[v];
    if (positive) patch.corner[axis] += size_m[axis];
    mesh = append_patch(std::move(mesh), patch);
  }
  return mesh;
}

Mesh make_sphere(float radius_m, int segments) {
  const int rings = std::max(2, segments / 2);
  Mesh mesh;
  for (int i = 0; i <= rings; ++i) {
    const double polar = std::numbers::pi * i / rings;
    const float v = static_cast<float>(i) / static_cast<float>(rings);
    const bool pole = i == 0 || i == rings;
    for (int j = 0; j <= segments; ++j) {
      glm::vec3 outward = circle_point(j, segments) * (pole ? 0.0f : static_cast<float>(std::sin(polar)));
      outward.y = static_cast<float>(std::cos(polar));
      mesh.vertices.push_back({outward * radius_m, outward, {static_cast<float>(j) / static_cast<float>(segments), v}});
    }
  }
  const auto row = static_cast<std::uint32_t>(segments + 1);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(rings); ++i) {
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      const std::uint32_t a = i * row + j;
      const std::uint32_t below = a + row;
      if (i + 1 < static_cast<std::uint32_t>(rings)) mesh.indices.insert(mesh.indices.end(), {a, below, below + 1});
      if (i > 0) mesh.indices.insert(mesh.indices.end(), {a, below + 1, a + 1});
    }
  }
  return mesh;
}

Mesh make_cylinder(float radius_m, float height_m, CylinderCells cut) {
  Mesh mesh = append_cylinder_side({}, radius_m, height_m, cut);
  mesh = append_cap(std::move(mesh), radius_m, height_m, cut.segments, 1.0f);
  return append_cap(std::move(mesh), radius_m, height_m, cut.segments, -1.0f);
}

Mesh make_bars(const Bars& bars) {
  constexpr float kCrossingThickness = 0.8f;
  const bool vertical = bars.direction != BarDirection::kHorizontal;
  const bool horizontal = bars.direction != BarDirection::kVertical;
  const float thin = bars.bar_width_m * (vertical && horizontal ? kCrossingThickness : 1.0f);
  const Mesh upright = make_box({bars.bar_width_m, bars.length_m, bars.bar_width_m}, bars.cells);
  const Mesh level = make_box({bars.length_m, thin, thin}, bars.cells);
  Mesh mesh;
  for (int i = 0; i < bars.count; ++i) {
    const float offset = (static_cast<float>(i) - 0.5f * static_cast<float>(bars.count - 1)) * bars.spacing_m;
    if (vertical) mesh = join_meshes(std::move(mesh), move_by(upright, {offset, 0.0f, 0.0f}));
    if (horizontal) mesh = join_meshes(std::move(mesh), move_by(level, {0.0f, offset, 0.0f}));
  }
  return mesh;
}

}  // namespace shadowbench::scene
