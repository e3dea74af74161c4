#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// A scene as it is shown: that of a file, looked at and lit in another way.
struct ShownScene {
  std::filesystem::path source;  ///< the scene file or bare model
  const Scene* scene = nullptr;  ///< as it was loaded
  std::vector<Camera> cameras;
  std::vector<Light> lights;  ///< in the order of the source, whose cookies they keep
};

/// Writes the scene file that is to lie at `file` and shows the scene: the source's own tables, or the model and its
/// floor, with these cameras and lights. Paths are relative to the file wherever they lead to the same place, so that
/// what a model refers to stays beside it. Comments of the source are lost.
/// Throws Error(kInput) where the source cannot be read.
std::string write_scene(const ShownScene& shown, const std::filesystem::path& file);

/// Give the camera and the light that are read where these are written: their directions become unit vectors, and stay
/// as they are from then on.
/// Throws Error(kInput) for values that a scene file does not take.
Camera settle(const Camera& camera);
Light settle(const Light& light);

/// Names a file in another one that is to lie at `from`: its relative path, or the absolute one where a symbolic link
/// would lead the relative one elsewhere. The file itself may be a link, which is not followed.
std::string name_from(const std::filesystem::path& file, const std::filesystem::path& from);

}  // namespace shadowbench::scene
