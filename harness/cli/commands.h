#pragma once

#include "harness/cli/command_line.h"

namespace shadowbench::cli {

// One function for each command of the program.

Command make_run_command();
Command make_merge_command();
Command make_list_command();
Command make_diff_command();
Command make_bias_command();
Command make_advise_command();
Command make_tune_command();
Command make_stress_command();
Command make_regress_command();
Command make_export_command();
Command make_score_command();
Command make_view_command();

/// Makes the command that compiles passes for a GPU, in a process that a crash of the driver may end. Only a run needs
/// it, so that help does not show it.
Command make_gpu_facts_command();

}  // namespace shadowbench::cli
