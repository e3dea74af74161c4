#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <tuple>

#include "filters/base/error.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/interruption.h"
#include "harness/cli/progress_bar.h"
#include "harness/scene/load.h"
#include "harness/tune/tune_filters.h"
#include "harness/tune/tune_metric.h"
#include "harness/tune/tune_views.h"

namespace shadowbench::cli {
namespace {

constexpr int kLargestBudget = 10000;

struct TuneArguments {
  std::vector<std::string> scenes;
  bool ground = false;
  std::string filters;
  std::vector<std::string> filter_files;
  std::string metric = "rmse";
  std::string map_size = "1024";
  std::string size = "480x270";
  std::string budget = "80";
  std::string light;
  std::vector<std::string> bias;
  std::uint32_t seed = 1;
  std::string backend = "auto";
  std::string cache;
  bool no_cache = false;
  std::string out = "report/out/tune";
};

int parse_budget(const std::string& text) {
  const int budget = parse_count(text, "--budget");
  if (budget > kLargestBudget)
    fail(fmt::format("--budget: {} is out of range: choose 1 .. {}", budget, kLargestBudget));
  return budget;
}

void add_filters(options::RunOptions& options, const TuneArguments& arguments) {
  if (!arguments.filter_files.empty()) {
    fail(
        fmt::format("--filter-file: only built-in filters are tuned, and {} would run in this process, where an "
                    "endless loop ends all; add it as CONTRIBUTING says",
                    arguments.filter_files.front()));
  }
  if (arguments.filters.empty()) fail("--filter: name at least one filter to tune, such as vsm (see 'list filters')");
  options.filters = filters::Catalogue(options.resources.filters).parse_requests(arguments.filters);
  for (const filters::FilterRequest& request : options.filters) render::require_usable(options.bias, request.spec);
}

tune::TuneOptions make_options(const TuneArguments& arguments) {
  tune::TuneOptions options;
  options::RunOptions& run = options.run;
  options.metric = tune::find_tune_metric(arguments.metric).name;
  options.budget = parse_budget(arguments.budget);
  run.resources = options::find_resources();
  run.bias = render::parse_bias(arguments.bias);
  run.bias_texts = arguments.bias;
  render::require_drawable(run.bias, run.map);
  add_filters(run, arguments);
  run.scenes = arguments.scenes.empty() ? list_builtin_scenes(run.resources) : arguments.scenes;
  options.skip_scenes = arguments.scenes.empty();
  run.ground = arguments.ground;
  run.map_sizes = {parse_count(arguments.map_size, "--map-size")};
  std::tie(run.width, run.height) = parse_picture_size(arguments.size);
  if (!arguments.light.empty()) run.light = parse_light(arguments.light);
  run.seed = arguments.seed;
  run.backend = gl::parse_backend(arguments.backend);
  run.attribution = false;
  run.cache = choose_cache(arguments.cache, arguments.no_cache);
  run.out = arguments.out;
  return options;
}

int tune(const TuneArguments& arguments) {
  const tune::TuneOptions options = make_options(arguments);
  std::string text;
  {
    const Interruption interruption(options.run.out, kStoppedAdvice);
    const std::unique_ptr<options::Progress> progress = make_progress();
    text = tune::tune_filters(options, *progress);
  }
  fmt::print("{}parameters: {}\n", text, (options.run.out / "tuned.json").string());
  return 0;
}

std::string describe_command() {
  return fmt::format(
      "Searches every numeric parameter with a range (but those that --filter sets, and const ones) for the least mean "
      "of the metric over\n"
      "the training views of all scenes, then scores default and found parameters on views that the search has not "
      "seen.\n"
      "Views, of each scene's first camera, turned about the vertical axis through the point it looks at (of its "
      "central ray, the\n"
      "one nearest to the middle of the scene's bounds), and of its light, turned in azimuth; degrees:\n"
      "  training: {}\n  unseen:   {}\n"
      "Kept are the found parameters only where the gain on unseen views is more than the truth's standard error (for "
      "flip, leak and\n"
      "acne: more than nothing), else the default. Writes tuned.json, for 'run --tuned', tune.html, .md, and every "
      "setting drawn to\n"
      "evaluations.csv. The budget is of the search; the good ranges (error within 10 % of the best, the other "
      "parameters at theirs)\n"
      "take some 25 settings more per parameter.",
      tune::describe_tune_views(true), tune::describe_tune_views(false));
}

void add_tune_options(CLI::App& command, TuneArguments& a) {
  command.add_option("--filter", a.filters, "filters with the parameters that stay fixed, such as vsm:store=rg16f,esm")
      ->required();
  command.add_option("--filter-file", a.filter_files, "")->group("");
  command
      .add_option(
          "--metric", a.metric,
          fmt::format("what to make small: {} (see 'list metrics')", fmt::join(tune::list_tune_metrics(), ", ")))
      ->capture_default_str();
  command
      .add_option(
          "--scene", a.scenes,
          "a built-in scene, or a .toml, .gltf, .glb or .obj file; may be repeated (default: all built-in scenes)")
      ->allow_extra_args(false);
  command.add_flag("--ground", a.ground, "put a floor under a bare model");
  command.add_option("--map-size", a.map_size, "texels along a side of the shadow map")->capture_default_str();
  command.add_option("--size", a.size, "picture size in pixels, WIDTHxHEIGHT")->capture_default_str();
  command.add_option("--budget", a.budget, "settings that the search draws of each filter")->capture_default_str();
  command.add_option("--light", a.light,
                     "AZIMUTH,ELEVATION in degrees, where the light stands in every scene before it is turned");
  command.add_option("--bias", a.bias, "bias, as of 'run'; may be repeated")->allow_extra_args(false);
  command.add_option("--seed", a.seed, "of random rotations and of the truth's rays")->capture_default_str();
  command.add_option("--gl", a.backend, "OpenGL context: auto, osmesa, egl or glfw")->capture_default_str();
  command.add_option("--cache", a.cache, "folder that keeps traced images for later runs (default: as 'run')");
  command.add_flag("--no-cache", a.no_cache, "trace everything, keep nothing");
  command.add_option("--out", a.out, "folder of the results")->capture_default_str();
}

}  // namespace

void add_tune_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("tune", "Find the best parameters of filters, and how much their choice matters");
  command->footer(describe_command());
  auto a = std::make_shared<TuneArguments>();
  add_tune_options(*command, *a);
  command->callback([&action, a] { action = [a] { return tune(*a); }; });
}

}  // namespace shadowbench::cli
