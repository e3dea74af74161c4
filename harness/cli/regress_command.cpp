#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <memory>

#include "base/error.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/interruption.h"
#include "harness/cli/print.h"
#include "report/regress/regress.h"

namespace shadowbench::cli {
namespace {

struct RegressArguments {
  std::string run;
  std::string baseline;
  std::string filters;
  std::vector<std::string> scenes;
  std::string out;
  bool force = false;
  std::string junit;
  bool accept = false;
  bool remove_missing = false;
  bool json = false;
};

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  for (const std::string& name : split_list(text)) {
    const std::size_t begin = name.find_first_not_of(' ');
    if (begin != std::string::npos) names.push_back(name.substr(begin, name.find_last_not_of(' ') - begin + 1));
  }
  return names;
}

regress::RegressOptions make_regress_options(const RegressArguments& a, const std::vector<std::string>& words) {
  regress::RegressOptions options;
  options.run = find_results(a.run).parent_path();
  options.baseline = a.baseline;
  options.out = a.out.empty() ? options.run / "regress" : std::filesystem::path(a.out);
  options.force = a.force;
  options.selection = {split_names(a.filters), a.scenes};
  options.accept = a.accept;
  options.remove_missing = a.remove_missing;
  if (!a.junit.empty()) options.junit = a.junit;
  options.brief = isatty(STDOUT_FILENO) == 0;
  options.command = words;
  if (a.remove_missing && !a.accept) fail("--remove-missing changes the baseline: add --accept");
  return options;
}

int regress(const RegressArguments& arguments, const std::vector<std::string>& words) {
  const regress::RegressOptions options = make_regress_options(arguments, words);
  regress::RegressOutcome outcome;
  {
    const Interruption interruption(options.accept ? options.baseline : options.out, kStoppedAdvice);
    outcome = regress::run_regress(options);
  }
  if (arguments.json)
    fmt::print("{}", outcome.json);
  else
    print("{}", outcome.text);
  if (outcome.failure.empty()) return 0;
  throw Error(outcome.kind, outcome.failure);
}

}  // namespace

Command make_regress_command() {
  Command command{"regress", "Compare a run with a baseline: what changed, and is it still as accurate"};
  command.about =
      "Exit code 1: a cell is less accurate, changed, slower, extra, missing or unreadable. Compares visibility, "
      "errors, artefacts, attribution and costs; on the baseline's machine and OpenGL also times, as ratios to 'none'. "
      "BASELINE/baseline.toml has the tolerances and their reasons. Make the baseline's runs with --uncertainty, which "
      "records how far rounding or another seed can move each pixel.";
  auto a = std::make_shared<RegressArguments>();
  command.add("RUN", &a->run, "the report folder of a run").names(ValueKind::kFolder).require();
  command.add("--baseline", &a->baseline, "folder of the expected results").names(ValueKind::kFolder).require();
  command.add("--filters", &a->filters, "compare these filters only, ids with commas").names(ValueKind::kFilters);
  command.add("--scene", &a->scenes, "compare this scene only; repeatable").names(ValueKind::kScene);
  command.add("--accept", &a->accept, "update the baseline with the run's results");
  command.add("--remove-missing", &a->remove_missing,
              "with --accept: also remove cells from the baseline that the run lacks");
  command.add("--junit", &a->junit, "also write JUnit XML for a build server").names(ValueKind::kFile);
  command.add("--json", &a->json, "print JSON; it also goes to OUT/regress.json");
  command.add("--out", &a->out, "folder for regress.html, .md, .json and images (default 'regress' in RUN)")
      .names(ValueKind::kFolder);
  add_force_option(command, a->force);
  command.action = [a](const CommandLine& line) { return regress(*a, line.words()); };
  return command;
}

}  // namespace shadowbench::cli
