#pragma once

#include <glm/glm.hpp>

#include "harness/scene/scene.h"
#include "harness/view/view_state.h"
#include "harness/view/window.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

// How the mouse and the keys move a camera and a light. Angles in radians, lengths in metres; a camera that was moved
// stands upright (+y), and looks nowhere straighter up or down than 89 degrees.

/// Turns a camera about a point that it goes on to show at the same place: to the right, and up over it.
scene::Camera orbit(scene::Camera camera, const glm::vec3& pivot_ws, float right_rad, float up_rad);

/// Turns a camera where it stands: to the right, and up.
scene::Camera look_around(scene::Camera camera, float right_rad, float up_rad);

/// Moves a camera along its own axes: right, up, ahead.
scene::Camera fly(scene::Camera camera, const glm::vec3& way_m);

/// Moves a camera towards a point until its distance is `factor` times what it was; an orthographic one shows so much
/// more or less.
scene::Camera approach(scene::Camera camera, const glm::vec3& pivot_ws, float factor);

/// Where a light stands in the sky, seen from what it goes round.
scene::SkyAngles find_in_sky(const scene::Light& light);

/// Moves a light across the sky by so many degrees; not beyond straight above or below.
scene::Light move_in_sky(const scene::Light& light, double azimuth_deg, double elevation_deg);

/// What the mouse and the flying keys do to the picture: they move the divider, the camera and the light.
class PictureInput {
 public:
  PictureInput(Workbench& bench, const Window& window) : bench_(bench), window_(window) {}

  /// Takes a frame's input; `seconds` have passed since the last one.
  void take(const PicturePlace& place, Look& look, double seconds);

  /// Whether a key moves the camera, so that frames must follow one another without any event.
  bool is_flying() const { return is_flying_; }

 private:
  enum class Grip { kNone, kDivider, kOrbit, kLook, kShift, kLight };

  Workbench& bench_;
  const Window& window_;
  Grip grip_ = Grip::kNone;
  bool is_flying_ = false;
  glm::vec3 pivot_ws_{0.0f};

  Grip find_grip(const PicturePlace& place, const Look& look, const glm::vec2& pointer) const;
  void drag(const PicturePlace& place, Look& look, const glm::vec2& pointer, const glm::vec2& by);
  void fly_by_keys(double seconds);
  void set_camera(const scene::Camera& camera);

  /// The receiver under a place of the picture, or the scene's centre where there is none.
  glm::vec3 find_pivot(const glm::vec2& pixel) const;
};

}  // namespace shadowbench::view
