#pragma once

#include <string>
#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::tune {

/// A way to look at a scene other than its own: from elsewhere, or under another light.
struct TuneView {
  double camera_turn_deg = 0.0;  ///< of the first camera, about the vertical axis through find_pivot()
  double light_turn_deg = 0.0;   ///< added to the light's azimuth
  bool training = false;         ///< parameters are chosen by it; else they are only scored on it

  /// Names the turn: "camera +20", "light -15", "as it is".
  std::string name() const;
};

/// The views that every scene is tuned on and scored on: the one list of them.
const std::vector<TuneView>& tune_views();

/// Says in words which views those are.
std::string describe_tune_views(bool training);

/// The point of a camera's central ray that is nearest to the middle of the scene's bounds; where that lies
/// behind the camera, the middle itself. Of a camera that stands within the bounds its own place: elsewhere it might
/// stand in a wall, or beside the ground.
glm::vec3 find_pivot(const scene::Scene& scene, const scene::Camera& camera);

/// A camera turned about the vertical axis through a point; positive turns it as an azimuth grows, from +z to +x.
scene::Camera turn_camera(const scene::Camera& camera, const glm::vec3& pivot_ws, double degrees);

/// The scene under its light turned, with one camera for each of the views, in their order, named for them.
/// Requires that all views turn the light alike.
scene::Scene turn_scene(const scene::Scene& scene, const std::vector<TuneView>& views);

}  // namespace shadowbench::tune
