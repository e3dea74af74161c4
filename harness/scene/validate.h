#pragma once

#include <string>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// No coordinate may be larger.
inline constexpr float kFarthest_m = 1e12f;

/// Checks that a scene can be rendered and measured, and repairs what has one sensible repair.
///
/// Throws kInput, at `where`, for: no triangles, an index out of range, a coordinate or normal that is not finite or
/// lies beyond 1e12 m, a light without direction, a camera without direction or with an impossible view. Drops
/// triangles without area and vertices that no triangle uses, replaces zero normals by the face's, and normalises
/// directions. Changes that are seen in the picture are noted in `warnings`.
Scene validate(Scene scene, const std::string& where);

/// The part of `validate` that concerns meshes and materials; code that frames or measures a scene relies on it.
Scene validate_geometry(Scene scene, const std::string& where);

/// The part of `validate` that concerns one camera.
Camera checked_camera(Camera camera, const std::string& where);

/// Whether a direction has unit length, but for the rounding of its floats. It then stays as it is: what was read,
/// written and read again is the same.
bool is_unit(const glm::dvec3& v);

/// Returns `v` with unit length. Throws kInput, naming `owner`, where it has no direction.
glm::vec3 unit_direction(const glm::vec3& v, const std::string& owner, const std::string& where);

}  // namespace shadowbench::scene
