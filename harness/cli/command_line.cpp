#include "harness/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <set>
#include <type_traits>

#include "base/error.h"
#include "base/text.h"
#include "report/document/markdown.h"

namespace shadowbench::cli {
namespace {

constexpr std::size_t kColumns = 100, kIndent = 26;

/// Breaks paragraphs into lines of kColumns, which begin after the indent; those that begin with a space stay.
std::string wrap(const std::string& text, std::size_t indent = 0) {
  std::vector<std::string> lines;
  for (const std::string& paragraph : split_list(text, "\n"))
    lines.push_back(paragraph.starts_with(' ') ? paragraph : document::wrap(paragraph, kColumns, indent, indent));
  return fmt::format("{}", fmt::join(lines, "\n" + std::string(indent, ' ')));
}

/// Lays out the help: examples first, descriptions beside the options.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter(const Command& command, bool show_rare) : examples_(command.examples) {
    column_width(12);
    for (const Option& option : command.options)
      if (option.rare && !show_rare) left_out_.insert(option.name);
  }

  std::string make_usage(const CLI::App* app, std::string name) const override {
    std::string usage = CLI::Formatter::make_usage(app, std::move(name));
    if (!examples_.empty()) usage += fmt::format("\nExamples:\n  {}\n", fmt::join(examples_, "\n  "));
    return usage;
  }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::string help = CLI::Formatter::make_help(app, std::move(name), mode);
    for (std::size_t at = 0; (at = help.find("\n\n\n", at)) != std::string::npos;) help.erase(at, 1);
    while (help.ends_with("\n\n")) help.pop_back();
    return help;
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    if (left_out_.contains(option->get_name())) return {};
    std::string name = "  " + make_option_name(option, is_positional) + make_option_opts(option);
    if (const auto negation = name.find("{false}"); negation != std::string::npos) name.erase(negation, 7);
    const bool fits = name.size() + 2 <= kIndent;
    name += fits ? std::string(kIndent - name.size(), ' ') : '\n' + std::string(kIndent, ' ');
    return name + wrap(make_option_desc(option), kIndent) + '\n';
  }

 private:
  std::vector<std::string> examples_;
  std::set<std::string> left_out_;
};

std::string check_value(const Option& option, const std::string& value) {
  if (!option.instead.empty()) fail(fmt::format("{} is gone: {}", option.name, option.instead));
  if (value.empty())
    return "a value is missing: give " + (!option.not_empty.empty() ? option.not_empty
                                          : option.required         ? "one"
                                                                    : "one, or leave the option out");
  if (option.is_flag())
    return value == "true" || value == "false" ? "" : fmt::format("takes no value but true or false, not '{}'", value);
  if (!option.choices.empty() && std::ranges::find(option.choices, value) == option.choices.end())
    return fmt::format("'{}' must be one of {}", value, fmt::join(option.choices, ", "));
  return {};
}

void add_option(CLI::App& app, const Option& option) {
  const auto add = [&](auto* variable) -> CLI::Option* {
    using Value = std::remove_pointer_t<decltype(variable)>;
    const std::string flag = option.opposite ? option.name + ",!--no-" + option.name.substr(2) : option.name;
    if constexpr (std::is_same_v<Value, bool>)
      return app.add_flag(flag, *variable, option.help);
    else if constexpr (std::is_same_v<Value,
                                      int>)  // CLI11 2.4 would set a flag that was not given to 0, and check that
      return app.add_flag_function(
          flag, [variable](std::int64_t count) { *variable = static_cast<int>(count); }, option.help);
    else
      return app.add_option(option.name, *variable, option.help);
  };
  CLI::Option* parsed = std::visit(add, option.variable);
  if (option.required) parsed->required();
  parsed->group(option.hidden ? "" : option.group);
  parsed->check([&option](const std::string& value) { return check_value(option, value); }, std::string());
  if (option.is_flag()) return;
  parsed->option_text(option.value_name() + (option.is_repeatable() ? " ..." : ""));
  if (option.is_repeatable() && !option.is_argument()) parsed->allow_extra_args(false);
  const std::string initial = option.default_value();
  if (initial.empty()) return;
  parsed->default_str(initial);
  if (option.help.find("(default") == std::string::npos)
    parsed->description(fmt::format("{} (default {})", option.help, initial));
}

struct Chosen {
  const Command* command = nullptr;
  CLI::App* parsed = nullptr;
};

void add_command(CLI::App& app, const Command& command, bool show_rare, Chosen& chosen) {
  app.formatter(std::make_shared<HelpFormatter>(command, show_rare));
  app.footer(wrap(command.about));  // an empty one too: else that of the program is inherited
  if (command.hidden) app.group("");
  app.set_help_flag();
  for (const Option& option : command.options) add_option(app, option);
  const bool has_rare = std::ranges::any_of(command.options, &Option::rare);
  app.set_help_flag("-h,--help,--help-all",
                    has_rare ? "Print the help; --help-all: with every option" : "Print the help")
      ->group(command.options.empty() ? "Options" : command.options.back().group);
  for (const Command& sub : command.commands)
    add_command(*app.add_subcommand(sub.name, sub.title), sub, show_rare, chosen);
  if (!command.commands.empty()) app.require_subcommand(1);
  if (command.action) app.callback([&] { chosen = {&command, &app}; });
}

/// What does the work of a command that is gone, for one version.
const std::map<std::string, std::string> kInstead = {
    {"flicker", "'shadowbench run', which measures it in every cell, as error.flicker"},
    {"submit", "harness/slurm.sh (share/doc/shadowbench/slurm.sh where it is installed)"},
    {"status", "squeue, which shows the jobs of harness/slurm.sh"}};

/// Finds the command that the words name. Throws Error(kUsage) for a word that is none, where a command must come.
const Command& find_command(const Command& program, const std::vector<std::string>& words) {
  const Command* command = &program;
  std::string path = program.name;
  for (std::size_t i = 1; i < words.size() && !command->commands.empty() && !words[i].starts_with('-'); ++i) {
    const auto found = std::ranges::find(command->commands, words[i], &Command::name);
    if (found == command->commands.end()) {
      if (const auto gone = kInstead.find(words[i]); gone != kInstead.end())
        throw Error(ErrorKind::kUsage, fmt::format("'{} {}' is gone: use {}", path, words[i], gone->second));
      std::vector<std::string> known;
      for (const Command& each : command->commands)
        if (!each.hidden) known.push_back(each.name);
      throw Error(ErrorKind::kUsage, fmt::format("there is no command '{} {}'{}; see '{} --help'", path, words[i],
                                                 did_you_mean_or_known(words[i], known), path));
    }
    command = &*found;
    path += " " + command->name;
  }
  return *command;
}

/// Puts the options' own names in place of their other spellings, so that nothing else knows of these. The parser takes
/// the words in reverse order, without the program's name.
std::vector<std::string> list_parser_words(const Command& command, const std::vector<std::string>& words) {
  std::vector<std::string> own(words.rbegin(), std::prev(words.rend()));
  for (std::string& word : own)
    for (const Option& option : command.options)
      if (!option.other_name.empty() && word.substr(0, word.find('=')) == option.other_name)
        word.replace(0, option.other_name.size(), option.name);
  return own;
}

}  // namespace

bool CommandLine::has(const std::string& option) const { return parsed_->count(option) > 0; }

void CommandLine::set(const std::string& option, const std::vector<std::string>& values,
                      const std::string& where) const {
  CLI::Option* parsed = parsed_->get_option(option);
  try {
    if (parsed->get_items_expected_max() > 1)
      for (const std::string& value : values) parsed->add_result(value);
    else
      parsed->add_result(fmt::format("{}", fmt::join(values, ",")));
    parsed->run_callback();
  } catch (const CLI::Error& error) {
    throw Error(ErrorKind::kInput, error.what(), where);
  } catch (const Error& error) {
    throw Error(ErrorKind::kInput, error.message(), where);
  }
}

int run_command_line(const Command& program, const std::vector<std::string>& words) {
  CLI::App app(program.title, program.name);
  Chosen chosen;
  add_command(app, program, std::ranges::count(words, "--help-all") > 0, chosen);
  app.set_version_flag("--version", program.name + " " SHADOWBENCH_VERSION, "Print the version and exit");
  const Command& command = find_command(program, words);
  try {
    app.parse(list_parser_words(command, words));
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::kUsage, fmt::format("{}; see 'shadowbench --help'", error.what()));
  }
  return chosen.command->action(CommandLine(words, chosen.parsed));
}

}  // namespace shadowbench::cli
