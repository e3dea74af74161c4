#pragma once

#include "harness/options/options.h"
#include "harness/options/progress.h"

namespace shadowbench::bias {

/// Draws the first scene of the options, from its first camera, with every filter under every mode of bias, from none
/// to eight times the theoretical amount, and writes bias.html, .md, .csv and a picture grid per mode into the output
/// folder. Rounds and bias of the options are not used. Requires one scene, one map size, and filters that have scalar
/// models. Throws Error as run_experiment, and Error(kInput) where there is nothing to take a theoretical amount from.
/// Cost: one lookup per mode, filter and amount; the truth of the view, traced once and kept.
void run_bias_sweep(const options::RunOptions& options, options::Progress& progress);

}  // namespace shadowbench::bias
