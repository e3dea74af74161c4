#pragma once

#include <string>
#include <vector>

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

/// Does what the command line asks for, whose first word is the program's name, and gives the exit code. A failure is
/// one message on standard error.
int run_program(const std::vector<std::string>& words);

/// Prints one message for one failure; nothing else in the program prints errors.
void print_error(const std::string& message);

/// Says that memory ran out, and gives the exit code.
int fail_memory();

}  // namespace shadowbench::cli
