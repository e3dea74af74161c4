#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/options/run_options.h"

namespace CLI {
class App;  // its header is slow to compile: command_line.cpp alone includes it
}

namespace shadowbench::cli {

using options::Option;
using options::ValueKind;
using options::Variable;

/// A command line that was read.
class CommandLine {
 public:
  CommandLine(std::vector<std::string> words, CLI::App* parsed) : words_(std::move(words)), parsed_(parsed) {}

  /// All words, the program's name first.
  const std::vector<std::string>& words() const { return words_; }
  /// Whether the option, or argument, was given.
  bool has(const std::string& option) const;
  /// Sets an option to what else than the command line says, read and checked in the same way. Throws Error(kInput),
  /// with `where`, for a value that the option refuses.
  void set(const std::string& option, const std::vector<std::string>& values, const std::string& where) const;

 private:
  std::vector<std::string> words_;
  CLI::App* parsed_;
};

/// A command as it is parsed, helped with, documented and completed.
struct Command {
  std::string name;
  std::string title;
  std::string about = {};  ///< paragraphs, one a line; lines that begin with a space are kept as they are
  std::vector<std::string> examples = {};  ///< as typed in a shell
  bool hidden = false;
  std::vector<Option> options = {};
  std::vector<Command> commands = {};                  ///< one of them must be given, where there are any
  std::function<int(const CommandLine&)> action = {};  ///< what the command does; gives the exit code

  /// Adds an option. The reference holds until the next one is added.
  Option& add(std::string option, Variable variable, std::string help) {
    return options.emplace_back(Option{std::move(option), variable, std::move(help)});
  }
};

/// Reads the command line into the variables of the chosen command's options and does what that command does, or prints
/// help. Throws Error(kUsage) for words that no option takes, and what the action throws.
int run_command_line(const Command& program, const std::vector<std::string>& words);

}  // namespace shadowbench::cli
