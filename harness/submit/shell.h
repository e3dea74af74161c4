#pragma once

#include <string>
#include <vector>

namespace shadowbench::submit {

/// Writes words as a POSIX shell reads them: what is not plain stands in single quotes.
std::string quote_words(const std::vector<std::string>& words);

/// How a command of a shell ended.
struct ShellOutcome {
  int exit_code = 0;  ///< 127: there is no such command
  std::string text;   ///< what it wrote, to standard output and standard error, without the last newline
};

/// Runs a command in a shell, and waits for it. Throws Error(kOutput) where no process can be started.
ShellOutcome run_shell(const std::string& command);

}  // namespace shadowbench::submit
