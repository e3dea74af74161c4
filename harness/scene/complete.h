#pragma once

#include <optional>
#include <string>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// What a scene gets beside its geometry.
struct Completion {
  bool needs_sun = false;            ///< it has no light
  bool ground = false;               ///< put a floor under it
  double aspect = 16.0 / 9.0;        ///< width / height of the picture that a chosen camera fills
  std::optional<SkyAngles> light{};  ///< put every light there
};

/// Returns a checked scene that has all it lacked: a sun and a camera by choose_view(), where it has none, which a note
/// names, and a floor. Cameras and lights that the scene has, and a place that was asked for, stay as they are.
///
/// Requires validated geometry. Throws kInput, at `where`, as validate() does.
Scene complete(Scene scene, const Completion& completion, const std::string& where);

}  // namespace shadowbench::scene
