#include <fmt/format.h>

#include <memory>
#include <tuple>

#include "filters/base/error.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/interruption.h"
#include "harness/cli/progress_bar.h"
#include "harness/flicker/run_flicker.h"

namespace shadowbench::cli {
namespace {

struct FlickerArguments {
  std::string scene = "cubes";
  std::string filters;
  std::string frames = "64";
  std::string map_size = "512";
  std::string size = "320x180";
  std::string motions = "light,camera";
  std::string backend = "auto";
  std::string cache;
  bool no_cache = false;
  std::string out = "report/out/flicker";
};

int parse_frames(const std::string& text) {
  const int frames = parse_count(text, "--frames");
  if (frames >= 2) return frames;
  throw Error(
      ErrorKind::kUsage,
      fmt::format("--frames: '{}' must be 2 or more: flicker is what changes from one frame to the next", text));
}

flicker::FlickerOptions make_options(const FlickerArguments& arguments, const std::vector<std::string>& words) {
  flicker::FlickerOptions options;
  options.frames = parse_frames(arguments.frames);
  options.motions = arguments.motions;
  options::RunOptions& run = options.run;
  run.resources = options::find_resources();
  run.scenes = {arguments.scene};
  run.filters = filters::Catalogue(run.resources.filters).parse_requests(arguments.filters);
  require_distinct(run.filters);
  run.map_sizes = {parse_count(arguments.map_size, "--map-size")};
  std::tie(run.width, run.height) = parse_picture_size(arguments.size);
  run.backend = gl::parse_backend(arguments.backend);
  run.cache = choose_cache(arguments.cache, arguments.no_cache);
  run.out = arguments.out;
  run.command = words;
  return options;
}

int measure_flicker(const FlickerArguments& arguments, const std::vector<std::string>& words) {
  const flicker::FlickerOptions options = make_options(arguments, words);
  {
    const Interruption interruption(options.run.out, kStoppedAdvice);
    const std::unique_ptr<options::Progress> progress = make_progress();
    flicker::run_flicker(options, *progress);
  }
  fmt::print("report: {}\n", (options.run.out / "flicker.html").string());
  return 0;
}

}  // namespace

void add_flicker_command(CLI::App& app, Action& action, const std::vector<std::string>& words) {
  CLI::App* command = app.add_subcommand(
      "flicker", "Move light and camera by less than a texel a frame, and hold what flickers against the truth");
  command->footer(
      "Looks the first frame's receivers up in every frame's map, without snapping the map's texel grid and with it, "
      "and holds\n"
      "what changes from frame to frame against what changes in ray-traced truth. Writes flicker.html, .md, .json, "
      ".csv\n"
      "and pictures by pixel.");
  auto a = std::make_shared<FlickerArguments>();
  command->add_option("--scene", a->scene, "a built-in scene, or a .toml, .gltf, .glb or .obj file")
      ->capture_default_str();
  command->add_option("--filters", a->filters, "built-in filters with parameters (default: all; see 'list filters')");
  command->add_option("--frames", a->frames, "2 or more")->capture_default_str();
  command->add_option("--map-size", a->map_size, "texels along a side of the shadow map")->capture_default_str();
  command->add_option("--size", a->size, "picture size in pixels, WIDTHxHEIGHT")->capture_default_str();
  command->add_option("--motion", a->motions, "what moves: light, camera, or both, separated by a comma")
      ->capture_default_str();
  command->add_option("--gl", a->backend, "OpenGL context: auto, osmesa, egl or glfw")->capture_default_str();
  command->add_option("--cache", a->cache, "folder that keeps traced images for later runs (default: as 'run')");
  command->add_flag("--no-cache", a->no_cache, "trace everything, keep nothing");
  command->add_option("--out", a->out, "folder of the report")->capture_default_str();
  command->callback([&action, a, words] { action = [a, words] { return measure_flicker(*a, words); }; });
}

}  // namespace shadowbench::cli
