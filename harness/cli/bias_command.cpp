#include <fmt/format.h>

#include <memory>
#include <tuple>

#include "harness/bias/bias_sweep.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/interruption.h"
#include "harness/cli/progress_bar.h"

namespace shadowbench::cli {
namespace {

struct BiasArguments {
  std::string scene = "fence";  ///< of the built-in ones, it has receivers for acne and for contact gaps
  std::string filters;
  std::string map_size = "1024";
  std::string size = "960x540";
  std::string backend = "auto";
  std::string cache;
  bool no_cache = false;
  std::string out = "report/out/bias";
};

options::RunOptions make_options(const BiasArguments& arguments) {
  options::RunOptions options;
  options.resources = options::find_resources();
  options.scenes = {arguments.scene};
  options.filters = filters::Catalogue(options.resources.filters).parse_requests(arguments.filters);
  require_distinct(options.filters);
  options.map_sizes = {parse_count(arguments.map_size, "--map-size")};
  std::tie(options.width, options.height) = parse_picture_size(arguments.size);
  options.backend = gl::parse_backend(arguments.backend);
  options.attribution = false;
  options.cache = choose_cache(arguments.cache, arguments.no_cache);
  options.out = arguments.out;
  return options;
}

int sweep(const BiasArguments& arguments) {
  const options::RunOptions options = make_options(arguments);
  {
    const Interruption interruption(options.out, kStoppedAdvice);
    const std::unique_ptr<options::Progress> progress = make_progress();
    bias::run_bias_sweep(options, *progress);
  }
  fmt::print("report: {}\n", (options.out / "bias.html").string());
  return 0;
}

}  // namespace

void add_bias_command(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("bias", "Sweep every mode of depth bias over its amount, and write a page about it");
  command->footer(
      "Draws the scene's first view with each filter under each mode of --bias (see 'run --help'), at 0 to 8 times the "
      "amount\n"
      "that theory asks for, and writes bias.html (charts of acne and contact gap), bias.csv and pictures.");
  auto a = std::make_shared<BiasArguments>();
  command->add_option("--scene", a->scene, "a built-in scene, or a .toml, .gltf, .glb or .obj file")
      ->capture_default_str();
  command->add_option("--filters", a->filters, "built-in filters with parameters (default: all; see 'list filters')");
  command->add_option("--map-size", a->map_size, "texels along a side of the shadow map")->capture_default_str();
  command->add_option("--size", a->size, "picture size in pixels, WIDTHxHEIGHT")->capture_default_str();
  command->add_option("--gl", a->backend, "OpenGL context: auto, osmesa, egl or glfw")->capture_default_str();
  command->add_option("--cache", a->cache, "folder that keeps traced images for later runs (default: as 'run')");
  command->add_flag("--no-cache", a->no_cache, "trace everything, keep nothing");
  command->add_option("--out", a->out, "folder of the page")->capture_default_str();
  command->callback([&action, a] { action = [a] { return sweep(*a); }; });
}

}  // namespace shadowbench::cli
