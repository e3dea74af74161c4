// The one entry of the module that the command line loads when a run begins: the image libraries behind it take 0.2 s
// to load, which `list` and `--help` should not pay.

#include "harness/run/run_experiment.h"

extern "C" void shadowbench_run_experiment(const shadowbench::run::RunOptions& options,
                                           shadowbench::run::Progress& progress) {
  shadowbench::run::run_experiment(options, progress);
}
