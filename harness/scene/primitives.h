#pragma once

#include "harness/scene/scene.h"

namespace shadowbench::scene {

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
