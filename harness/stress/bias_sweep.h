#pragma once

#include "harness/options/options.h"

namespace shadowbench::stress {

/// Draws the first scene of the options under each of its lights that they name, from its first camera, with every
/// filter under every mode of bias, from none to eight times the theoretical amount, and writes bias.html, .md, .csv,
/// .json and a picture grid per light and mode into the output folder. Rounds and bias of the options are not used.
/// Requires one scene and one map size. A light that gives nothing to take a theoretical amount from has no answer,
/// which the page says. Throws Error as run_experiment, Error(kInput) where no light has one, and Error(kUsage) where
/// none has a name that was asked for. Cost: one lookup per light, mode, filter and amount; the truth of the view,
/// traced once for each light and kept.
void run_bias_sweep(const options::RunOptions& options, options::Progress& progress);

}  // namespace shadowbench::stress
