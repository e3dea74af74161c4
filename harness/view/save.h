#pragma once

#include <filesystem>
#include <string>

#include "harness/view/view_state.h"

namespace shadowbench::view {

/// Brings the cameras and lights to what a scene file gives back, which takes directions as unit vectors. Of settings
/// that were settled, saved files show the very same, bit for bit; of others a direction may differ in the last digit.
/// Throws Error(kInput) for values that no scene file takes.
void settle(ViewSettings& settings);

/// Writes the scene that the state shows to a scene file: with its cameras and lights, and a bare model's floor. The
/// file appears whole or not at all. Throws Error(kUsage) for a file that is no .toml, that the scene was loaded from,
/// or that is a built-in scene's, Error(kInput) where the scene's own file can no longer be read, Error(kOutput).
void save_scene(const ViewState& state, const std::filesystem::path& file);

/// Where save_experiment() puts the scene: "a.scene.toml" beside "a.toml".
std::filesystem::path scene_beside(const std::filesystem::path& experiment);

/// Writes the experiment that is to lie at `file`, with its scene beside it: `shadowbench run` on it draws what the
/// state shows. The options are those of the state, but for how it is measured. The filters of both sides are its
/// cells, with every parameter; truth is traced in any case, so that a side that shows it adds none.
std::string write_experiment(const ViewState& state, options::RunOptions options, const std::filesystem::path& file);

/// Writes the experiment and its scene, which save_scene() does. Throws Error as save_scene().
void save_experiment(const ViewState& state, const std::filesystem::path& file);

}  // namespace shadowbench::view
