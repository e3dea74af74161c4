#pragma once

#include <optional>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Returns a camera that looks at the scene's meshes from three quarters (along a scene much longer than wide) and
/// slightly from above, as near as it can while every vertex stays inside a picture of the given width / height.
/// Where `ground_y` is given, the shadows that the meshes throw on that plane are inside as well.
/// Requires at least one vertex. Reads the meshes and the light of `scene` only.
Camera frame_camera(const Scene& scene, double aspect, std::optional<float> ground_y);

/// Returns the sun of a scene of these bounds that has none: 50 degrees high, from the right of frame_camera's view and
/// a little from the front, so that shadows fall to the left.
Light make_default_sun(const Bounds& bounds);

/// Returns the height of a floor just below the meshes: near enough to look like contact, far enough not to coincide.
float ground_height(const Scene& scene);

/// Returns a floor at that height, under the meshes and the shadows that the scene's light throws on it.
Mesh make_ground(const Scene& scene, float ground_y);

}  // namespace shadowbench::scene
