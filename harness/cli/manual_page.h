#pragma once

#include <string>

#include "harness/cli/command_line.h"

namespace shadowbench::cli {

/// Writes the manual page shadowbench(1): what --help says, the commands, and where to read more.
std::string make_program_page(const Command& program);

/// Writes the manual page of one command, such as shadowbench-run(1), from the text of its --help.
std::string make_command_page(const Command& program, const Command& command);

}  // namespace shadowbench::cli
