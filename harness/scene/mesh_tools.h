#pragma once

#include <functional>
#include <glm/glm.hpp>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Applies an affine transform to a mesh.
/// Normals go through the inverse transpose; a mirroring transform (negative determinant) reverses the winding, so that
/// outward faces stay outward.
Mesh transform_mesh(Mesh mesh, const glm::dmat4& world_from_local);

/// The same with a transform for each vertex; a triangle is reversed as its first vertex is.
Mesh transform_mesh(Mesh mesh, const std::function<glm::dmat4(std::size_t vertex)>& world_from_local);

/// Adds the second mesh's triangles to the first, which keeps its name and material.
Mesh join_meshes(Mesh first, const Mesh& second);

/// Every triangle its own three vertices and its geometric normal.
/// Requires indices in range.
Mesh with_flat_normals(const Mesh& mesh);

/// Every corner the mean normal, weighted by area, of the faces around it that turn by less than `crease_deg`.
/// Corners belong together where their positions are equal. Where more than 64 faces meet, all of them count: to
/// compare each with each would take their square. Requires indices in range.
Mesh with_smooth_normals(const Mesh& mesh, double crease_deg);

/// Drops vertices that no triangle uses. Requires indices in range.
Mesh without_unused_vertices(Mesh mesh);

/// Whether a mesh encloses a volume: every edge belongs to two triangles that run along it in opposite directions.
/// Corners at the same place count as one; triangles without area are passed over. Only of such a mesh does something
/// stay in a shadow map when the faces towards the light are culled. Cost: one hash table entry per edge.
bool is_closed(const Mesh& mesh);

/// Returns twice the area of a triangle times its unit normal, computed in double precision.
glm::dvec3 area_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// The coordinate axis that is least parallel to a direction.
glm::dvec3 axis_least_parallel(const glm::dvec3& direction);

/// Makes a rectangle in the plane y = 0, centred on the origin and facing +y.
/// `size_m` is its extent along x and z; it has cells x cells quads, so that no triangle is a giant.
Mesh make_plane(glm::vec2 size_m, int cells);

/// Makes a box centred on the origin, its faces outward.
/// `cells` is the number of quads along its longest edge; the other edges get as many as keep the quads square.
Mesh make_box(glm::vec3 size_m, int cells);

/// Makes a closed sphere around the origin with smooth normals.
/// `segments` (at least 3) is the number of meridians; there are half as many parallels.
Mesh make_sphere(float radius_m, int segments);

/// How a cylinder is cut into triangles.
struct CylinderCells {
  int segments = 48;  ///< around the axis, at least 3
  int cells = 8;      ///< along the axis
};

/// Makes a closed cylinder around the y axis, centred on the origin, with smooth sides and flat caps.
Mesh make_cylinder(float radius_m, float height_m, CylinderCells cut);

/// The ways bars may run.
enum class BarDirection { kVertical, kHorizontal, kBoth };

/// A grid of thin bars in the plane z = 0, centred on the origin.
struct Bars {
  int count = 10;             ///< bars in each direction
  float bar_width_m = 0.04f;  ///< width and depth of a bar
  float spacing_m = 0.2f;     ///< from one bar's centre to the next one's
  float length_m = 2.0f;
  BarDirection direction = BarDirection::kVertical;
  int cells = 8;  ///< along a bar
};

/// Makes a grid of bars; where both directions cross, the horizontal bars are thinner, so that no faces coincide.
Mesh make_bars(const Bars& bars);

}  // namespace shadowbench::scene
