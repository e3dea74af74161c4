#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "harness/measure/scene_assets.h"
#include "harness/options/options.h"
#include "harness/run/run_plan.h"

namespace shadowbench::engines {

/// Version of scene.json; README.md says what its keys are.
inline constexpr int kSceneVersion = 1;

/// What another renderer needs to know of a view beside the model: picture, camera and light, as `scene.json` has them.
/// Metres, degrees; right-handed with +y up.
nlohmann::ordered_json describe_view(const run::PlannedScene& planned, const scene::Camera& camera);

/// One of its `maps`: the window of each layer of a light's map, as a camera that engines know, or else as a matrix.
nlohmann::ordered_json describe_map(const run::PlannedScene& planned, int map_size,
                                    const std::vector<scene::LightFrustum>& layers);

/// Writes `<scene>.glb` and `scene.json` into a folder. Throws Error(kOutput).
void write_exported_scene(const std::filesystem::path& folder, const run::PlannedScene& planned,
                          const scene::Camera& camera, const nlohmann::ordered_json& description);

/// What was written, and what the user was told of it.
struct ExportedScenes {
  std::vector<std::filesystem::path> folders;
  std::vector<std::string> warnings;
};

/// Writes a folder for each scene, light, view and picture size of a run: OUT/<stem>/<scene>.glb and scene.json, with
/// the map of every fit and size. Tells the warnings of a run of these scenes. Throws Error as make_plan(), and
/// Error(kOutput).
ExportedScenes export_scenes(const options::RunOptions& options, options::Progress& progress);

}  // namespace shadowbench::engines
