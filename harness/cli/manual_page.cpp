#include "harness/cli/manual_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <sstream>

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

}  // namespace

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

}  // namespace shadowbench::cli
