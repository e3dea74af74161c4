#include <fmt/format.h>

#include <memory>

#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/print.h"
#include "harness/cli/progress_bar.h"
#include "harness/stress/bias_sweep.h"

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

}  // namespace shadowbench::cli
