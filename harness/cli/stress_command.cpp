#include <fmt/format.h>

#include <memory>

#include "base/error.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/print.h"
#include "harness/cli/progress_bar.h"
#include "harness/stress/run_stress.h"

namespace shadowbench::cli {
namespace {

struct StressArguments : DrawingArguments {
  std::string filters;
  std::vector<std::string> filter_files;
  std::string axes;
  std::vector<std::string> ranges;
  bool list = false;
  std::uint32_t seed = 1;
};

stress::StressOptions make_stress_options(const StressArguments& arguments, const std::vector<std::string>& words) {
  if (!arguments.filter_files.empty()) {
    fail(
        fmt::format("--filter-file: {} has no scalar model to be held against, so only built-in filters are stressed; "
                    "add it as CONTRIBUTING says",
                    arguments.filter_files.front()));
  }
  stress::StressOptions options;
  take_drawing_options(arguments, options);
  options.filters = parse_builtin_filters(arguments.filters, options.resources);
  options.axes = arguments.axes;
  options.ranges = arguments.ranges;
  options.seed = arguments.seed;
  options.command = words;
  return options;
}

int stress_filters(const StressArguments& arguments, const std::vector<std::string>& words) {
  const stress::StressOptions options = make_stress_options(arguments, words);
  if (arguments.list) {
    print("{}", stress::describe_axes(options.filters));
    return 0;
  }
  const stress::StressOutcome outcome = work_with_progress(
      options.out, [&](options::Progress& progress) { return stress::run_stress(options, progress); });
  print("{}report: {}\n", outcome.text, (options.out / "stress.html").string());
  return outcome.disagreements > 0 ? static_cast<int>(ErrorKind::kLimit) : 0;
}

}  // namespace

Command make_stress_command() {
  Command command{"stress", "Find where filters break numerically, and compare with theory"};
  command.about =
      "Along each axis a case is ok, degraded (error over the axis' bound) or broken (NaN, infinity, all lit, all "
      "dark, or not monotonic). The first value of each is found to 1 % and compared with theory. Writes stress.html, "
      ".md, .json and .csv. Exit code 1: an unexplained difference from theory.";
  auto a = std::make_shared<StressArguments>();
  a->out = "report/out/stress";
  add_builtin_filters_option(command, a->filters);
  command.add("--filter-file", &a->filter_files, "").hide();
  command.add("--axes", &a->axes, "axes, separated by commas (default all; see --list)");
  command.add("--range", &a->ranges, "AXIS=LOW,HIGH instead of the axis' range; repeatable");
  command.add("--list", &a->list, "list the axes and end");
  command.add("--seed", &a->seed, "seed of random rotations and of the truth's rays");
  add_drawing_options(command, *a);
  command.action = [a](const CommandLine& line) { return stress_filters(*a, line.words()); };
  return command;
}

}  // namespace shadowbench::cli
