#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/toml.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// How a scene is found and completed.
struct LoadOptions {
  std::filesystem::path scenes_folder;  ///< where the built-in scenes are
  bool ground = false;                  ///< put a floor under a bare model
  double aspect = 16.0 / 9.0;           ///< width / height of the picture that an automatic camera fills
  std::optional<SkyAngles> light{};     ///< put every light of the scene there
};

/// A built-in scene as it is listed.
struct SceneInfo {
  std::string name;  ///< what `load` takes
  std::string title;
  std::filesystem::path file;
};

/// Lists the built-in scenes by name. Throws kInput where the folder or a title cannot be read.
std::vector<SceneInfo> list_scenes(const std::filesystem::path& folder);

/// Lists the scenes of the folder `teaching` below: each shows one mistake, and runs only if it is named. Throws kInput
/// where the folder or a title cannot be read; a folder that is not there has no scenes.
std::vector<SceneInfo> list_teaching_scenes(const std::filesystem::path& folder);

/// Finds the file that load() loads. Throws kUsage and kInput as load() does.
std::filesystem::path find_scene_file(const std::string& name_or_path, const std::filesystem::path& scenes_folder);

/// Loads a built-in scene, or a teaching scene, by its name, or a .toml, .gltf, .glb or .obj file by its path, and
/// validates it.
///
/// A bare model uses its own cameras and lights; what it lacks is completed, as a scene file is that has no camera: see
/// complete(). `ground` adds a floor in a material of its own; scene files have their own objects, and ignore it
/// with a warning.
/// A scene file's model may be anywhere ("../models/tree.gltf"), but all that it refers to must lie in its own folder.
/// Throws kUsage for a name that is no scene, with the nearest one, or for another kind of file; kInput, with
/// "file:line" where that is known, for a file that is missing or does not hold what it must.
Scene load(const std::string& name_or_path, const LoadOptions& options);

/// Reads the [camera] of a scene file, relative to the scene's origin; its directions are not yet checked. Throws
/// kInput.
Camera read_camera(const TomlTable& table, const glm::dvec3& origin = glm::dvec3(0.0));

/// A scene as it is shown: that of a file, looked at and lit in another way.
struct ShownScene {
  std::filesystem::path source;  ///< the scene file or bare model
  const Scene* scene = nullptr;  ///< as it was loaded
  std::vector<Camera> cameras;
  std::vector<Light> lights;  ///< in the order of the source
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
