#pragma once

#include <string>
#include <vector>

namespace shadowbench::cli {

/// Does what the command line asks for, whose first word is the program's name, and gives the exit code. A failure is
/// one message on standard error.
int run_program(const std::vector<std::string>& words);

/// Prints one message for one failure; nothing else in the program prints errors.
void print_error(const std::string& message);

/// Says that memory ran out, and gives the exit code.
int fail_memory();

}  // namespace shadowbench::cli
