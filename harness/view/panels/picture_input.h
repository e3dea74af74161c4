#pragma once

#include <glm/glm.hpp>

#include "harness/view/look.h"
#include "harness/view/window.h"
#include "harness/view/workbench.h"

namespace shadowbench::view {

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
