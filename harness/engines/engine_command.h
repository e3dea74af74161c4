#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/engines/score_run.h"
#include "harness/options/experiment_file.h"

namespace shadowbench::engines {

/// Has renderers draw scenes of a run, and scores what they write. Each is a command of the shell that is given two
/// more words, a scene.json and the EXR file to write, and may leave a meta.json and a shadow_map.exr beside that.
///
/// `scene` and `view`: as in ScoreRequest, but that empty ones are all. A row that fails costs no other. Gives the
/// rows' records with what was found out. Throws Error(kInput) for the first failure, once the others are in the
/// report: a command that ends with another exit code than 0, is not done after `timeout_s`, or writes nothing.
std::vector<std::pair<records::CellRecord, std::vector<Finding>>> run_engines(
    RunScorer& scorer, const std::vector<options::Engine>& engines, const ScoreRequest& request, double timeout_s,
    options::Progress& progress);

}  // namespace shadowbench::engines
