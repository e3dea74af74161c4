#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "base/error.h"
#include "base/text.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/terminal.h"
#include "harness/scene/load.h"
#include "harness/stress/axis.h"
#include "harness/stress/bias_sweep.h"
#include "harness/tune/tune_filters.h"
#include "harness/tune/tune_scene.h"

namespace shadowbench::cli {
namespace {

struct BiasArguments : PictureArguments {
  std::string scene = "fence";  ///< among the built-in scenes, this one has receivers for acne and for contact gaps
  bool ground = false;
  std::vector<std::string> light_names, filter_files;
};

int sweep_bias(const BiasArguments& arguments) {
  options::RunOptions options;
  options.phases = 1;  // no error is averaged
  take_picture_options(arguments, options);
  options.scenes = {arguments.scene};
  options.ground = arguments.ground;
  options.light_names = arguments.light_names;
  options.filter_files = arguments.filter_files;
  filters::Catalogue catalogue(options.resources.filters);
  catalogue.add_user_files(options.filter_files);
  options.filters = parse_filters(catalogue, arguments.filters, options.filter_files);
  filters::refuse_light_widths(options.filters);
  require_distinct(options.filters);
  print_presets(options.filters);
  options.attribution = false;
  work_with_progress(options.out, [&](options::Progress& progress) { stress::run_bias_sweep(options, progress); });
  print("report: {}\n", (options.out / "bias.html").string());
  return 0;
}

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
  options.resources = options::find_resources();
  options.backend = parse_name<gl::Backend>(arguments.backend, "GL back end");
  options.out = arguments.out;
  options.force = arguments.force;
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

constexpr int kLargestBudget = 10000;

struct TuneArguments : PictureArguments {
  std::vector<std::string> scenes;
  bool ground = false;
  std::vector<std::string> filter_files;
  std::string metric = "rmse";
  std::string budget = "80";
  std::string light;
  std::vector<std::string> bias;
  std::uint32_t seed = 1;
};

int parse_budget(const std::string& text) {
  const int budget = parse_count(text, "--budget");
  if (budget > kLargestBudget)
    fail(fmt::format("--budget: {} is out of range: choose 1 .. {}", budget, kLargestBudget));
  return budget;
}

void choose_tuned_filters(options::RunOptions& options, const TuneArguments& arguments) {
  if (!arguments.filter_files.empty()) {
    fail(
        fmt::format("--filter-file: only built-in filters are tuned, and {} would run in this process, where an "
                    "endless loop ends all; add it as CONTRIBUTING says",
                    arguments.filter_files.front()));
  }
  options.filters = filters::Catalogue(options.resources.filters).parse_requests(arguments.filters);
  filters::refuse_light_widths(options.filters);
  print_presets(options.filters);
  for (const filters::FilterRequest& request : options.filters) render::require_usable(options.bias, request.spec);
}

tune::TuneOptions make_tune_options(const TuneArguments& arguments) {
  tune::TuneOptions options;
  options::RunOptions& run = options.run;
  run.phases = 1;  // each view is drawn through one place of the map
  options.metric = tune::find_tune_metric(arguments.metric).name;
  options.budget = parse_budget(arguments.budget);
  take_picture_options(arguments, run);
  if (const std::size_t colon = arguments.fit.find(':'); colon != std::string::npos)
    for (const auto& [key, value] : split_assignments(arguments.fit.substr(colon + 1), "--fit"))
      options.fixed_keys.insert(key);
  run.bias = render::parse_bias(arguments.bias);
  run.bias_texts = arguments.bias;
  render::require_drawable(run.bias, run.map);
  choose_tuned_filters(run, arguments);
  run.scenes = arguments.scenes.empty() ? list_builtin_scenes(run.resources) : arguments.scenes;
  options.skip_scenes = arguments.scenes.empty();
  run.ground = arguments.ground;
  if (!arguments.light.empty()) run.light = parse_light(arguments.light);
  run.seed = arguments.seed;
  run.attribution = false;
  return options;
}

int tune(const TuneArguments& arguments) {
  const tune::TuneOptions options = make_tune_options(arguments);
  const std::string found = work_with_progress(
      options.run.out, [&](options::Progress& progress) { return tune::tune_filters(options, progress); });
  print("{}parameters: {}\n", found, (options.run.out / "tuned.json").string());
  return 0;
}

std::string describe_tuning() {
  return fmt::format(
      "Searches split and blend of cascades (but what --fit sets), then every numeric parameter with a range (but "
      "those that --filters sets, and const ones) for the least mean of the metric over the training views of all "
      "scenes, then scores default and found parameters on views that the "
      "search has not seen. The views are made of each scene's first camera, turned about the vertical axis through "
      "the point it looks at (the point of its central ray that is nearest to the middle of the scene's bounds), or "
      "about itself where it stands within these bounds, and "
      "of its light, turned in azimuth; in degrees:\n"
      "  training: {}\n  unseen:   {}\n"
      "The found parameters are kept only where they gain more on unseen views than the truth's standard error (for "
      "flip, leak and acne: more than nothing); else the default stays. Writes tuned.json, for 'run --tuned', "
      "tune.html and "
      ".md, and every setting that was tried to evaluations.csv. The budget limits the search alone; to find the range "
      "of "
      "each parameter in which the error stays within 10 % of the best takes some 25 settings more.",
      tune::describe_tune_views(true), tune::describe_tune_views(false));
}

}  // namespace

Command make_bias_command() {
  Command command{"bias", "Find the depth bias to ship: sweep every mode over its amount"};
  command.about =
      "Draws the scene's first view under each of its lights with each filter and each bias mode of 'run --help-all', "
      "at 0 to 8 times the theoretical amount. Writes bias.html (the bias to ship, charts of acne and contact gap), "
      "bias.csv, bias.json and images. In the folder 'bias' of a report it adds the bias to that report's answer.";
  auto a = std::make_shared<BiasArguments>();
  a->size = "960x540";
  a->out = "report/out/bias";
  add_scene_option(command, a->scene);
  add_as_run(command, "--ground", &a->ground);
  add_as_run(command, "--light-name", &a->light_names);
  add_builtin_filters_option(command, a->filters);
  add_as_run(command, "--filter-file", &a->filter_files);
  add_picture_options(command, *a);
  add_drawing_options(command, *a);
  command.action = [a](const CommandLine&) { return sweep_bias(*a); };
  return command;
}

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
  command.add("--seed", &a->seed, "seed of random rotations");
  add_backend_option(command, a->backend);
  command.add("--cache", &a->cache, "").gone("'stress' traces nothing that could be kept");
  command.add("--out", &a->out, "folder of the report").names(ValueKind::kFolder);
  add_force_option(command, a->force);
  command.action = [a](const CommandLine& line) { return stress_filters(*a, line.words()); };
  return command;
}

Command make_tune_command() {
  Command command{"tune", "Find the best parameters of filters, and how much they matter"};
  command.about = describe_tuning();
  auto a = std::make_shared<TuneArguments>();
  a->size = "480x270";
  a->out = "report/out/tune";
  command.add("--filters", &a->filters, "filters with fixed parameters, such as vsm:store=rg16f,esm")
      .names(ValueKind::kFilters)
      .also_called("--filter")
      .never_empty("at least one filter to tune, such as vsm (see 'list filters')")
      .require();
  command.add("--filter-file", &a->filter_files, "").hide();
  const std::vector<std::string> metrics = tune::list_tune_metrics();
  command.add("--metric", &a->metric,
              fmt::format("error to minimise: {} (see 'list metrics')", fmt::join(metrics, ", ")));
  add_as_run(command, "--scene", &a->scenes);
  add_as_run(command, "--ground", &a->ground);
  add_picture_options(command, *a);
  command.add("--budget", &a->budget, "settings to try per filter");
  command.add("--light", &a->light,
              "AZIMUTH,ELEVATION in degrees, where the light stands in every scene before it is turned");
  command.add("--bias", &a->bias, "depth bias as for 'run'; repeatable");
  command.add("--seed", &a->seed, "seed of random rotations and rays");
  add_drawing_options(command, *a);
  command.action = [a](const CommandLine&) { return tune(*a); };
  return command;
}

}  // namespace shadowbench::cli
