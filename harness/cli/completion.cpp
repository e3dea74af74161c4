#include "harness/cli/completion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace shadowbench::cli {
namespace {

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

}  // namespace

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

}  // namespace shadowbench::cli
