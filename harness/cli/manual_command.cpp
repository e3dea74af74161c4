#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <memory>
#include <sstream>

#include "base/atomic_file.h"
#include "filters/catalogue.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/options/experiment_file.h"
#include "harness/scene/load.h"

namespace shadowbench::cli {
namespace {

/// Writes a text so that troff changes none of its characters.
std::string escape(const std::string& text) {
  std::string escaped = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    switch (c) {
      case '\\': escaped += "\\e"; break;
      case '-': escaped += "\\-"; break;
      case '\'': escaped += "\\(aq"; break;
      case '`': escaped += "\\(ga"; break;
      case '^': escaped += "\\(ha"; break;
      case '~': escaped += "\\(ti"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

std::string bold(const std::string& text) { return "\\fB" + escape(text) + "\\fR"; }

std::string italic(const std::string& text) { return "\\fI" + escape(text) + "\\fR"; }

std::string write_head(const std::string& name, const std::string& title) {
  std::string upper = name;
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string line = title.substr(0, title.find_last_not_of('.') + 1);
  line.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(line.front())));
  return fmt::format(".TH {} 1 \"\" \"shadowbench {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", escape(upper),
                     SHADOWBENCH_VERSION, escape(name), escape(line));
}

std::string write_about(const std::string& about) {
  std::string page;
  std::istringstream text(about);
  for (std::string paragraph; std::getline(text, paragraph);)
    page += (paragraph.starts_with(' ') ? ".br\n" : ".PP\n") + escape(paragraph) + "\n";
  return page;
}

std::string write_option(const Option& option) {
  std::string name = option.is_argument() ? italic(option.name) : bold(option.name);
  if (option.opposite) name += ", " + bold("--no-" + option.name.substr(2));
  if (!option.is_flag() && !option.is_argument()) name += " " + italic(option.value_name());
  std::string help = option.help;
  if (option.only_choices) help += fmt::format("; one of {}", fmt::join(option.choices, ", "));
  if (const std::string text = option.default_value(); !text.empty()) help += fmt::format(" [default: {}]", text);
  return fmt::format(".TP\n{}\n{}\n", name, escape(help));
}

std::string write_synopsis(const std::string& name, const Command& command) {
  std::string synopsis = ".B " + escape(name) + "\n[" + italic("option") + "]...";
  for (const Option& option : command.options) {
    if (!option.required && !option.is_argument()) continue;
    const std::string word = option.is_argument() ? italic(option.name) + (option.is_repeatable() ? "..." : "")
                                                  : bold(option.name) + " " + italic(option.value_name());
    synopsis += option.required ? " " + word : " [" + word + "]";
  }
  return synopsis + "\n";
}

std::string write_options(const Command& command) {
  std::string page;
  for (const Option& option : command.options)
    if (!option.hidden) page += write_option(option);
  return page + ".TP\n" + bold("-h") + ", " + bold("--help") + "\nPrint this help and end.\n";
}

/// Writes the manual page shadowbench(1): what --help says, the commands, and where to read more.
std::string make_program_page(const Command& program) {
  std::string page = write_head(program.name, program.title);
  page += ".SH SYNOPSIS\n.B " + program.name + "\n" + italic("command") + " [" + italic("option") + "]...\n";
  page += ".SH DESCRIPTION\n" + write_about(program.about) + ".SH COMMANDS\n";
  for (const Command& command : program.commands)
    if (!command.hidden)
      page += fmt::format(".TP\n.BR {} (1)\n{}\n", escape(program.name + "-" + command.name), escape(command.title));
  page +=
      ".SH OPTIONS\n.TP\n.B \\-\\-version\nPrint the version and end.\n"
      ".SH ENVIRONMENT\n.TP\n.B SHADOWBENCH_ROOT\nThe folder whose filters, shaders, scenes and experiments are used "
      "in "
      "place of the program's own.\n.TP\n.B XDG_CACHE_HOME\nTraced images are kept in the folder shadowbench below it, "
      "else below \\(ti/.cache.\n";
  return page;
}

/// Writes the manual page of one command, such as shadowbench-run(1), from the text of its --help.
std::string make_command_page(const Command& program, const Command& command) {
  const std::string name = program.name + " " + command.name;
  std::string page = write_head(program.name + "-" + command.name, command.title) + ".SH SYNOPSIS\n";
  if (command.commands.empty()) {
    page += write_synopsis(name, command);
    if (!command.about.empty()) page += ".SH DESCRIPTION\n" + write_about(command.about);
    page += ".SH OPTIONS\n" + write_options(command);
  } else {
    page += ".B " + escape(name) + "\n" + italic("what") + " [" + italic("option") + "]...\n.SH DESCRIPTION\n" +
            escape(command.title) + ".\n";
    for (const Command& sub : command.commands)
      page += fmt::format(".SS {}\n{}.\n{}", escape(name + " " + sub.name), escape(sub.title), write_options(sub));
  }
  return page + ".SH SEE ALSO\n.BR " + program.name + " (1), where the exit codes stand\n";
}

/// The names that come with the program, which shells offer for options that take such a name.
using KnownNames = std::map<ValueKind, std::vector<std::string>>;

std::vector<std::string> list_values(const Option& option, const KnownNames& names) {
  const auto known = names.find(option.kind);
  return known == names.end() ? option.choices : known->second;
}

template <class Items>
std::string join_names(const Items& items) {
  std::vector<std::string> words;
  for (const auto& item : items)
    if (!item.hidden) words.push_back(item.name);
  return fmt::format("{}", fmt::join(words, " "));
}

std::string list_option_words(const Command& command) {
  std::string words = "--help";
  for (const Option& option : command.options) {
    if (option.hidden || option.is_argument()) continue;
    words += " " + option.name;
    if (option.opposite) words += " --no-" + option.name.substr(2);
  }
  return words;
}

std::string write_bash_values(const Option& option, const KnownNames& names) {
  return fmt::format("values='{}'; folders={}", fmt::join(list_values(option, names), " "),
                     option.kind == ValueKind::kFolder ? "yes" : "");
}

/// Writes the branch of a command that has options, called by the words `path`.
std::string write_bash_branch(const std::string& path, const Command& command, const KnownNames& names) {
  std::string branch = fmt::format("    '{}')\n      options='{}'\n", path, list_option_words(command));
  std::string cases;
  for (const Option& option : command.options)
    if (option.is_argument())
      branch += "      " + write_bash_values(option, names) + "\n";
    else if (!option.is_flag() && !option.hidden)
      cases += fmt::format("        {}) value=yes; {} ;;\n", option.name, write_bash_values(option, names));
  if (!cases.empty()) branch += "      case $before in\n" + cases + "      esac\n";
  return branch + "      ;;\n";
}

std::string quote_zsh(const std::string& text) {
  std::string quoted;
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return "'" + quoted + "'";
}

/// Writes a text so that zsh's _arguments takes its colons and brackets as text.
std::string escape_zsh(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == ':' || c == '[' || c == ']') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string write_zsh_action(const Option& option, const KnownNames& names) {
  const std::string values = fmt::format("{}", fmt::join(list_values(option, names), " "));
  switch (option.kind) {
    case ValueKind::kFile: return "_files";
    case ValueKind::kFolder: return "_files -/";
    case ValueKind::kFilters: return " _values -s , filter " + values;
    case ValueKind::kScene:
    case ValueKind::kExperiment: return " _shadowbench_name_or_file " + values;
    default: return values.empty() ? "" : "(" + values + ")";
  }
}

std::string write_zsh_option(const Option& option, const KnownNames& names) {
  const std::string value = ":" + option.value_name() + ":" + write_zsh_action(option, names);
  if (option.is_argument()) return quote_zsh((option.is_repeatable() ? "*" : "") + value);
  const std::string help = "[" + escape_zsh(option.help) + "]";
  if (!option.is_flag()) return quote_zsh((option.is_repeatable() ? "*" : "") + option.name + "=" + help + value);
  const std::string flag = quote_zsh(option.name + help);
  return option.opposite ? flag + " " + quote_zsh("--no-" + option.name.substr(2) + "[not: " + help.substr(1)) : flag;
}

std::string write_zsh_branch(const std::string& path, const Command& command, const KnownNames& names) {
  std::string branch = fmt::format("    '{}') _arguments '--help[print help]'", path);
  for (const Option& option : command.options)
    if (!option.hidden) branch += " \\\n      " + write_zsh_option(option, names);
  return branch + " ;;\n";
}

std::string write_zsh_commands(const Command& command) {
  std::string words;
  for (const Command& sub : command.commands)
    if (!sub.hidden) words += fmt::format(" {}", quote_zsh(sub.name + ":" + sub.title));
  return words;
}

/// Writes a script that completes commands, options and their values in bash.
std::string make_bash_completion(const Command& program, const KnownNames& names) {
  std::string groups, branches;
  for (const Command& command : program.commands) {
    if (command.hidden) continue;
    if (command.commands.empty()) {
      branches += write_bash_branch(command.name, command, names);
      continue;
    }
    groups += fmt::format("    {}) values='{}'; place=2 ;;\n", command.name, join_names(command.commands));
    for (const Command& sub : command.commands)
      branches += write_bash_branch(command.name + " " + sub.name, sub, names);
  }
  return fmt::format(R"(# Completion of {0} for bash, made from the description of its options.
_{0}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} path=${{COMP_WORDS[1]}}
  local options='--help --version' values='{1}' folders='' value='' place=1
  [[ $word == '=' ]] && word=''
  [[ $before == '=' ]] && before=${{COMP_WORDS[COMP_CWORD-2]}}
  if ((COMP_CWORD > 1)); then
    values=''
    case $path in
{2}    esac
    ((COMP_CWORD > place)) && {{ ((place == 2)) && path+=" ${{COMP_WORDS[2]}}"; values=''; }}
    case $path in
{3}    esac
  fi
  if [[ -z $value && $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ -n $folders ]]; then
    mapfile -t COMPREPLY < <(compgen -d -- "$word")
  else
    local last=${{word##*,}}
    mapfile -t COMPREPLY < <(compgen -P "${{word%"$last"}}" -W "$values" -- "$last")
  fi
}}
complete -o filenames -o bashdefault -o default -F _{0} {0}
)",
                     program.name, join_names(program.commands), groups, branches);
}

/// Writes the same for zsh, as a file of its function path.
std::string make_zsh_completion(const Command& program, const KnownNames& names) {
  std::string groups, branches;
  for (const Command& command : program.commands) {
    if (command.hidden) continue;
    if (command.commands.empty()) {
      branches += write_zsh_branch(command.name, command, names);
      continue;
    }
    groups +=
        fmt::format("    {})\n      commands=({})\n      place=3 ;;\n", command.name, write_zsh_commands(command));
    for (const Command& sub : command.commands) branches += write_zsh_branch(command.name + " " + sub.name, sub, names);
  }
  return fmt::format(R"(#compdef {0}
# Completion of {0} for zsh, made from the description of its options.
_{0}_name_or_file() {{
  compadd -- "$@"
  _files
}}

_{0}() {{
  local -a commands
  local place=2 chosen=$words[2]
  commands=({1})
  if ((CURRENT > 2)); then
    case $words[2] in
{2}    esac
  fi
  if ((CURRENT <= place)); then
    _describe command commands
    return
  fi
  ((place == 3)) && chosen="$words[2] $words[3]"
  words=("$chosen" "${{(@)words[place+1,-1]}}")
  ((CURRENT -= place - 1))
  case $chosen in
{3}  esac
}}

_{0} "$@"
)",
                     program.name, write_zsh_commands(program), groups, branches);
}

KnownNames list_known_names() {
  const options::Resources resources = options::find_resources();
  KnownNames names;
  for (const auto& scenes : {scene::list_scenes(resources.scenes), scene::list_teaching_scenes(resources.scenes)})
    for (const scene::SceneInfo& info : scenes) names[ValueKind::kScene].push_back(info.name);
  const filters::Catalogue catalogue(resources.filters);
  names[ValueKind::kFilters] = {"all"};
  for (const filters::FilterSpec& spec : catalogue.filters()) names[ValueKind::kFilters].push_back(spec.id);
  names[ValueKind::kExperiment] = options::list_experiments(resources.experiments);
  return names;
}

int write_manual(const Command& program, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const KnownNames names = list_known_names();
  write_text_file(folder / (program.name + ".1"), make_program_page(program));
  for (const Command& command : program.commands)
    if (!command.hidden)
      write_text_file(folder / (program.name + "-" + command.name + ".1"), make_command_page(program, command));
  write_text_file(folder / (program.name + ".bash"), make_bash_completion(program, names));
  write_text_file(folder / ("_" + program.name), make_zsh_completion(program, names));
  return 0;
}

}  // namespace

Command make_manual_command(const Command& program) {
  Command command{"manual", "Write manual pages and completions for the shells"};
  command.hidden = true;
  auto folder = std::make_shared<std::string>();
  command.add("DIR", folder.get(), "folder of the pages").names(ValueKind::kFolder).require();
  command.action = [folder, &program](const CommandLine&) { return write_manual(program, *folder); };
  return command;
}

}  // namespace shadowbench::cli
