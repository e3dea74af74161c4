#pragma once

#include <string>
#include <vector>

#include "harness/measure/scene_measurement.h"
#include "harness/options/options.h"
#include "harness/scene/scene.h"

namespace shadowbench::run {

/// A scene as one picture size frames it, and one fit its light's map, with what the command line called it.
struct PlannedScene {
  options::RunOptions options;  ///< of the run, with one picture size and one fit
  std::string argument;         ///< name or path
  scene::Scene scene;
  std::size_t place = 0;  ///< of the scene in this picture size; its lights and fits share it
};

/// The cells of one view through one shadow map that this run is to hold.
struct PlannedTask {
  std::size_t scene = 0;              ///< index into RunPlan::scenes
  measure::SceneTask task;            ///< its filters are those still to be measured
  std::vector<std::string> keys;      ///< of all its cells, measured or not
  std::vector<std::string> contents;  ///< of those still to be measured; names of all that a cell is made from
};

/// What a run is to measure, in the order of its records: picture size, scene, light, fit, view, map size, filter.
struct RunPlan {
  std::vector<PlannedScene> scenes;
  std::vector<PlannedTask> tasks;
  int cells = 0;         ///< of the whole experiment, other shards' included
  int own_cells = 0;     ///< of this shard
  int finished = 0;      ///< of those, found in the report folder
  std::string settings;  ///< names all cells of the experiment, whatever draws them: shards of one experiment agree
};

/// Loads the scenes and lays out the run. A cell counts as finished where the report folder holds one of its key, its
/// content and this OpenGL, whose GL_RENDERER is `renderer`; with grids, which need every image of their view, only
/// where all of the view's cells are finished. Throws Error for a scene that cannot be loaded, a view that no scene
/// has, scenes or cells of one name, a shard of nothing.
RunPlan make_plan(const options::RunOptions& options, const std::string& renderer);

/// Names all that the truth of a view depends on, and its picture's size: geometry, textures, light and camera.
std::string name_view(const PlannedScene& planned, const scene::Camera& camera);

/// Loads a scene as a run wants it: framed for the picture's shape, with the floor and the light that were asked for.
/// Throws Error as scene::load().
scene::Scene load_scene(const options::RunOptions& options, const std::string& argument);

/// The scene under each of its lights that was asked for, by itself; all where none was named, none where it has none
/// of these.
std::vector<scene::Scene> list_lit_scenes(const options::RunOptions& options, const scene::Scene& scene);

/// Throws Error(kUsage): no scene has a light that was asked for.
[[noreturn]] void fail_unknown_light(const options::RunOptions& options);

/// Loads all of a run's scenes, in its order. Throws Error as load_scene(), and Error(kUsage) where two have one name.
std::vector<scene::Scene> load_scenes(const options::RunOptions& options);

/// What the user is to know of one light's scene before it is measured: the warnings of loading, which other lights of
/// the scene repeat, and whether its light shows nothing.
std::vector<std::string> list_scene_warnings(const options::RunOptions& options, const scene::Scene& scene);

}  // namespace shadowbench::run
