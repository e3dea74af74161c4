#pragma once

#include <optional>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Where a scene is seen from, and where its sun stands.
struct ViewAngles {
  SkyAngles camera;
  SkyAngles sun;
};

/// Returns the first view to try of a scene of these bounds: from three quarters (along a scene much longer than wide)
/// and 24 degrees above. The sun is 50 degrees high, to the right of the view and a little to the front, so that
/// shadows fall to the left.
ViewAngles usual_view(const Bounds& bounds);

/// Whether a scene that is much longer than wide and high is seen from its long side, where it is a thin line.
bool would_be_thin(const Bounds& bounds, const SkyAngles& from);

/// Returns a camera that looks at the scene's meshes from a place around them, as near as it can while every vertex
/// stays inside a picture of the given width / height. Where `ground_y` is given, the shadows that the meshes throw on
/// that plane are inside as well.
/// Requires at least one vertex. Reads the meshes and the light of `scene` only.
Camera frame_camera(const Scene& scene, const SkyAngles& from, double aspect, std::optional<float> ground_y);

/// Returns the height of a floor just below the meshes: near enough to look like contact, far enough not to coincide.
float ground_height(const Scene& scene);

/// Returns the place of a floor at that height, under the meshes and the shadows that the scene's light throws on it.
Floor place_floor(const Scene& scene, float ground_y);

/// How many quads a floor has along each side.
inline constexpr int kFloorCells = 32;

/// Returns the mesh of a floor: that of a plane of this size and place in a scene file.
Mesh make_floor(const Floor& floor);

}  // namespace shadowbench::scene
