#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;  // its header is slow to compile: command_line.cpp alone includes it
}

namespace shadowbench::cli {

/// What the value of an option names, as far as a shell can complete it.
enum class ValueKind { kOther, kFile, kFolder, kScene, kFilters, kExperiment };

/// Where the value of an option is stored. Flags are bool; an int counts how often a flag was given, --no-FLAG as -1.
using Variable = std::variant<bool*, int*, std::string*, std::optional<std::string>*, std::vector<std::string>*,
                              double*, std::optional<double>*, std::uint32_t*>;

/// One option of a command. A vector takes one value each time that the option is given.
struct Option {
  std::string name;  ///< "--scene"; a name without dashes is an argument without an option
  Variable variable;
  std::string help;
  ValueKind kind = ValueKind::kOther;
  std::vector<std::string> choices = {};  ///< what the value may be, as far as that can be listed
  bool only_choices = false;              ///< any other value is refused
  bool required = false;
  bool hidden = false;          ///< the help does not show it
  bool opposite = false;        ///< the flag can be taken back with --no-FLAG
  std::string not_empty = {};   ///< what to give in place of an empty value, which no option takes
  std::string other_name = {};  ///< a spelling that is understood, and that the help does not show

  Option& names(ValueKind what) { return kind = what, *this; }
  /// Refuses all values but these.
  Option& one_of(std::vector<std::string> values) { return only_choices = true, such_as(std::move(values)); }
  /// These values are offered; who reads the option judges the others.
  Option& such_as(std::vector<std::string> values) { return choices = std::move(values), *this; }
  Option& require() { return required = true, *this; }
  Option& hide() { return hidden = true, *this; }
  Option& with_opposite() { return opposite = true, *this; }
  Option& also_called(std::string what) { return other_name = std::move(what), *this; }
  Option& never_empty(std::string what) { return not_empty = std::move(what), *this; }

  bool is_flag() const { return variable.index() < 2; }
  bool is_argument() const { return name.front() != '-'; }
  bool is_repeatable() const { return std::holds_alternative<std::vector<std::string>*>(variable); }
  /// The word that stands for the value in help texts, such as "FILE".
  std::string value_name() const;
  /// The value before the command line is read; empty where there is none.
  std::string default_value() const;
};

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
  /// Paragraphs, one a line; lines that begin with a space are kept as they are.
  std::string about = {};
  bool hidden = false;
  std::vector<Option> options = {};
  std::vector<std::string>* rest = nullptr;            ///< takes the words after `--`; null: there may be none
  std::vector<Command> commands = {};                  ///< one of them must be given, where there are any
  std::function<int(const CommandLine&)> action = {};  ///< what the command does; gives the exit code

  /// Adds an option. The reference holds until the next one is added.
  Option& add(std::string option, Variable variable, std::string help) {
    return options.emplace_back(Option{std::move(option), variable, std::move(help)});
  }
};

/// Reads the command line into the variables of the chosen command's options and does what that command does, or prints
/// help. Throws Error(kUsage) for words that no option takes, and what the action throws.
int run_command_line(const Command& program, int argc, char** argv);

}  // namespace shadowbench::cli
