#include "harness/scene/mesh_tools.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

namespace shadowbench::scene {
namespace {

/// The inverse transpose times the determinant, which also exists for flattened meshes.
glm::dmat3 cofactor_matrix(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

glm::vec3 normalize_or_keep_zero(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0.0 ? glm::vec3(v / length) : glm::vec3(0.0f);
}

/// An affine transform of positions and normals.
class VertexTransform {
 public:
  explicit VertexTransform(const glm::dmat4& world_from_local)
      : world_from_local_(world_from_local),
        side_(glm::determinant(glm::dmat3(world_from_local)) < 0.0 ? -1.0 : 1.0),
        normal_matrix_(side_ * cofactor_matrix(glm::dmat3(world_from_local))) {}

  bool mirrors() const { return side_ < 0.0; }

  Vertex operator()(Vertex vertex) const {
    vertex.position_ws = glm::vec3(world_from_local_ * glm::dvec4(glm::dvec3(vertex.position_ws), 1.0));
    vertex.normal_ws = normalize_or_keep_zero(normal_matrix_ * glm::dvec3(vertex.normal_ws));
    return vertex;
  }

 private:
  glm::dmat4 world_from_local_;
  double side_;
  glm::dmat3 normal_matrix_;
};

using Position = std::tuple<float, float, float>;

/// A triangle's normal times twice its area, and its unit normal, zero where it has no area.
struct FaceNormal {
  glm::dvec3 area_normal;
  glm::dvec3 normal;
};

std::vector<FaceNormal> face_normals(const Mesh& mesh) {
  std::vector<FaceNormal> faces;
  faces.reserve(mesh.indices.size() / 3);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const glm::dvec3 area =
        area_normal(mesh.vertices[mesh.indices[i]].position_ws, mesh.vertices[mesh.indices[i + 1]].position_ws,
                    mesh.vertices[mesh.indices[i + 2]].position_ws);
    faces.push_back({area, glm::dvec3(normalize_or_keep_zero(area))});
  }
  return faces;
}

/// Numbers the places of a mesh's vertices, the same for vertices at the same place.
std::vector<int> number_places(const Mesh& mesh) {
  std::map<Position, int> numbers;
  std::vector<int> places;
  for (const Vertex& vertex : mesh.vertices) {
    const glm::vec3 p = vertex.position_ws + 0.0f;  // -0 becomes 0
    places.push_back(numbers.emplace(Position(p.x, p.y, p.z), static_cast<int>(numbers.size())).first->second);
  }
  return places;
}

Mesh without_geometry(const Mesh& mesh) {
  Mesh copy;
  copy.name = mesh.name;
  copy.material = mesh.material;
  copy.casts_shadow = mesh.casts_shadow;
  return copy;
}

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

glm::dvec3 area_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
}

Mesh transform_mesh(Mesh mesh, const glm::dmat4& world_from_local) {
  const VertexTransform transform(world_from_local);
  for (Vertex& vertex : mesh.vertices) vertex = transform(vertex);
  if (!transform.mirrors()) return mesh;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}

Mesh transform_mesh(Mesh mesh, const std::function<glm::dmat4(std::size_t vertex)>& world_from_local) {
  std::vector<bool> mirrored;
  mirrored.reserve(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const VertexTransform transform(world_from_local(i));
    mesh.vertices[i] = transform(mesh.vertices[i]);
    mirrored.push_back(transform.mirrors());
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
    if (mirrored[mesh.indices[i]]) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}

Mesh join_meshes(Mesh first, const Mesh& second) {
  const auto offset = static_cast<std::uint32_t>(first.vertices.size());
  first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
  for (const std::uint32_t index : second.indices) first.indices.push_back(index + offset);
  return first;
}

Mesh with_flat_normals(const Mesh& mesh) {
  const std::vector<FaceNormal> faces = face_normals(mesh);
  Mesh flat = without_geometry(mesh);
  flat.vertices.reserve(mesh.indices.size());
  flat.indices.reserve(mesh.indices.size());
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    Vertex vertex = mesh.vertices[mesh.indices[i]];
    vertex.normal_ws = glm::vec3(faces[i / 3].normal);
    flat.vertices.push_back(vertex);
    flat.indices.push_back(static_cast<std::uint32_t>(i));
  }
  return flat;
}

Mesh with_smooth_normals(const Mesh& mesh, double crease_deg) {
  constexpr std::size_t kFewFaces = 64;
  const double crease_cosine = std::cos(glm::radians(crease_deg));
  const std::vector<FaceNormal> faces = face_normals(mesh);
  const auto position_of = [&](std::size_t corner) {
    const glm::vec3& p = mesh.vertices[mesh.indices[corner]].position_ws;
    return Position(p.x, p.y, p.z);
  };
  struct Meeting {
    std::vector<std::size_t> faces;
    glm::dvec3 sum{0.0};  ///< of all area normals
  };
  std::map<Position, Meeting> meetings;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    Meeting& meeting = meetings[position_of(i)];
    meeting.faces.push_back(i / 3);
    meeting.sum += faces[i / 3].area_normal;
  }

  Mesh smooth = with_flat_normals(mesh);
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const Meeting& meeting = meetings[position_of(i)];
    glm::dvec3 sum = meeting.sum;
    if (meeting.faces.size() <= kFewFaces) {
      sum = glm::dvec3(0.0);
      for (const std::size_t face : meeting.faces)
        if (glm::dot(faces[face].normal, faces[i / 3].normal) >= crease_cosine) sum += faces[face].area_normal;
    }
    if (glm::length(sum) > 0.0) smooth.vertices[i].normal_ws = glm::vec3(glm::normalize(sum));
  }
  return smooth;
}

Mesh without_unused_vertices(Mesh mesh) {
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), kUnused);
  std::vector<Vertex> used;
  used.reserve(std::min(mesh.vertices.size(), mesh.indices.size()));
  for (std::uint32_t& index : mesh.indices) {
    if (new_index[index] == kUnused) {
      new_index[index] = static_cast<std::uint32_t>(used.size());
      used.push_back(mesh.vertices[index]);
    }
    index = new_index[index];
  }
  mesh.vertices = std::move(used);
  return mesh;
}

bool is_closed(const Mesh& mesh) {
  const std::vector<int> places = number_places(mesh);
  std::map<std::pair<int, int>, int> balance;  // edges of lower to higher number count up, the others down
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const int corner[] = {places[mesh.indices[i]], places[mesh.indices[i + 1]], places[mesh.indices[i + 2]]};
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
    for (int k = 0; k < 3; ++k) {
      const int a = corner[k], b = corner[(k + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  return !balance.empty() &&
         std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

glm::dvec3 axis_least_parallel(const glm::dvec3& direction) {
  const glm::dvec3 size = glm::abs(direction);
  if (size.z <= size.x && size.z <= size.y) return {0.0, 0.0, 1.0};
  return size.x <= size.y ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
}

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
