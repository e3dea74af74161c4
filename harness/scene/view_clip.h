#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// The corners of the scene's triangles after cutting them at the sides of what a camera sees, in world space; empty
/// where it sees nothing. Surfaces behind others are kept. `aspect` is width / height of the picture.
///
/// A perspective camera sees nothing behind itself; an orthographic one is not cut along its direction.
/// Cost: one pass over the triangles, in double.
/// Source: Sutherland and Hodgman 1974, Reentrant Polygon Clipping, CACM 17(1).
std::vector<glm::dvec3> list_visible_corners(const Scene& scene, const Camera& camera, double aspect);

}  // namespace shadowbench::scene
