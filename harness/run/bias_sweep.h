#pragma once

#include "harness/run/options.h"
#include "harness/run/progress.h"

namespace shadowbench::run {

/// Draws the first scene of the options, from its first camera, with every filter under every mode of bias, from none
/// to eight times the theoretical amount, and writes bias.html, bias.csv and a picture grid per mode into the output
/// folder. Rounds and bias of the options are not used. Requires one scene, one map size, and filters that have scalar
/// models. Throws Error as run_experiment, and Error(kInput) where there is nothing to take a theoretical amount from.
/// Cost: one lookup per mode, filter and amount; the truth of the view, traced once and kept.
void run_bias_sweep(const RunOptions& options, Progress& progress);

}  // namespace shadowbench::run
