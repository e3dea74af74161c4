#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/cli/command_line.h"

namespace shadowbench::cli {

/// The names that come with the program, which shells offer for options that take such a name.
using KnownNames = std::map<ValueKind, std::vector<std::string>>;

/// Writes a script that completes commands, options and their values in bash.
std::string make_bash_completion(const Command& program, const KnownNames& names);

/// Writes the same for zsh, as a file of its function path.
std::string make_zsh_completion(const Command& program, const KnownNames& names);

}  // namespace shadowbench::cli
