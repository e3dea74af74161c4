#pragma once

#include <string>

#include "filters/base/content_hash.h"
#include "harness/options/options.h"
#include "harness/scene/scene.h"

namespace shadowbench::run {

/// Names everything that a scene's cells are made from and their keys do not say: the program's commit, the
/// options of the run, and the scene itself with its geometry, textures, cameras and light. Not the OpenGL: see
/// CellRecord::machine.
std::string name_scene_content(const options::RunOptions& options, const scene::Scene& scene);

/// Names everything that one cell is made from: the above, and the filter's GLSL. Two cells of one key and one content
/// differ in their times, and by what another OpenGL rounds, alone.
std::string name_cell_content(const std::string& scene_content, const filters::FilterRequest& request);

/// Adds a cell to the name of several: planner and sweeps agree on it.
void add_cell(ContentHash& cells, const std::string& key, const std::string& content);

}  // namespace shadowbench::run
