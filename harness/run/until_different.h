#pragma once

#include <string>

#include "harness/options/options.h"
#include "harness/options/progress.h"

namespace shadowbench::run {

/// Runs an experiment with 8 phases of the map's grid or those that are asked for, and again with twice as many, until
/// the RMSEs of the two filters of `options.until_different` are told apart over all places, or 64 phases are done.
/// Since it looks up to four times, each time is held to 98 % rather than 95 % (Pocock 1977, Group Sequential Methods
/// in the Design and Analysis of Clinical Trials, Biometrika 64(2)). Returns what it found, as a sentence. Throws
/// Error as run_experiment().
std::string run_until_different(options::RunOptions options, options::Progress& progress);

}  // namespace shadowbench::run
