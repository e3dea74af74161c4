#include <fmt/format.h>

#include <memory>

#include "filters/base/error.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/interruption.h"
#include "harness/cli/progress_bar.h"
#include "harness/stress/run_stress.h"

namespace shadowbench::cli {
namespace {

struct StressArguments {
  std::string filters;
  std::vector<std::string> filter_files;
  std::string axes;
  std::vector<std::string> ranges;
  bool list = false;
  std::uint32_t seed = 1;
  std::string backend = "auto";
  std::string cache;
  bool no_cache = false;
  std::string out = "report/out/stress";
};

stress::StressOptions make_options(const StressArguments& arguments, const std::vector<std::string>& words) {
  if (!arguments.filter_files.empty()) {
    throw Error(ErrorKind::kUsage, fmt::format("--filter-file: {} has no scalar model to be held against, so only "
                                               "built-in filters are stressed; add it as CONTRIBUTING says",
                                               arguments.filter_files.front()));
  }
  stress::StressOptions options;
  options.resources = options::find_resources();
  options.filters = filters::Catalogue(options.resources.filters).parse_requests(arguments.filters);
  require_distinct(options.filters);
  options.axes = arguments.axes;
  options.ranges = arguments.ranges;
  options.seed = arguments.seed;
  options.backend = gl::parse_backend(arguments.backend);
  options.cache = choose_cache(arguments.cache, arguments.no_cache);
  options.out = arguments.out;
  options.command = words;
  return options;
}

int stress_filters(const StressArguments& arguments, const std::vector<std::string>& words) {
  const stress::StressOptions options = make_options(arguments, words);
  if (arguments.list) {
    fmt::print("{}", stress::describe_axes(options.filters));
    return 0;
  }
  stress::StressOutcome outcome;
  {
    const Interruption interruption(options.out, kStoppedAdvice);
    const std::unique_ptr<options::Progress> progress = make_progress();
    outcome = stress::run_stress(options, *progress);
  }
  fmt::print("{}report: {}\n", outcome.text, (options.out / "stress.html").string());
  return outcome.disagreements > 0 ? static_cast<int>(ErrorKind::kLimit) : 0;
}

void add_stress_options(CLI::App& command, StressArguments& a) {
  command.add_option("--filters", a.filters, "built-in filters with parameters (default: all; see 'list filters')");
  command.add_option("--filter-file", a.filter_files, "")->group("");
  command.add_option("--axes", a.axes, "axes, separated by commas (default: all; see --list)");
  command.add_option("--range", a.ranges, "AXIS=LO,HI in place of an axis' own range; may be repeated")
      ->allow_extra_args(false);
  command.add_flag("--list", a.list, "list the axes and end");
  command.add_option("--seed", a.seed, "of random rotations and of the truth's rays")->capture_default_str();
  command.add_option("--gl", a.backend, "OpenGL context: auto, osmesa, egl or glfw")->capture_default_str();
  command.add_option("--cache", a.cache, "folder that keeps traced images for later runs (default: as 'run')");
  command.add_flag("--no-cache", a.no_cache, "trace everything, keep nothing");
  command.add_option("--out", a.out, "folder of the report")->capture_default_str();
}

}  // namespace

void add_stress_command(CLI::App& app, Action& action, const std::vector<std::string>& words) {
  CLI::App* command =
      app.add_subcommand("stress", "Drive filters to where their numbers break, and hold the limits against theory");
  command->footer(
      "Along each axis every case is ok, degraded (an error over the axis' bound) or broken (NaN, infinity, all lit, "
      "all dark, or falling\n"
      "where it must rise). The first value of each is found to 1 % and compared with theory. Writes stress.html, .md, "
      ".json\n"
      "and .csv, with a chart for each axis. Exit code 1: a limit is not what theory says, and nothing explains it.");
  auto a = std::make_shared<StressArguments>();
  add_stress_options(*command, *a);
  command->callback([&action, a, words] { action = [a, words] { return stress_filters(*a, words); }; });
}

}  // namespace shadowbench::cli
