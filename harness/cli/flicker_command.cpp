#include <fmt/format.h>

#include <memory>

#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/print.h"
#include "harness/cli/progress_bar.h"
#include "harness/flicker/run_flicker.h"

namespace shadowbench::cli {
namespace {

struct FlickerArguments : PictureArguments {
  std::string scene = "cubes";
  std::string frames = "64";
  std::string motions = "light,camera";
};

int parse_frames(const std::string& text) {
  const int frames = parse_count(text, "--frames");
  if (frames >= 2) return frames;
  fail(fmt::format("--frames: '{}' must be 2 or more: flicker is what changes from one frame to the next", text));
}

int measure_flicker(const FlickerArguments& arguments, const std::vector<std::string>& words) {
  flicker::FlickerOptions options;
  options.frames = parse_frames(arguments.frames);
  options.motions = arguments.motions;
  take_picture_options(arguments, options.run);
  options.run.scenes = {arguments.scene};
  options.run.filters = parse_builtin_filters(arguments.filters, options.run.resources);
  options.run.command = words;
  work_with_progress(options.run.out, [&](options::Progress& progress) { flicker::run_flicker(options, progress); });
  print("report: {}\n", (options.run.out / "flicker.html").string());
  return 0;
}

}  // namespace

Command make_flicker_command() {
  Command command{"flicker",
                  "Move light and camera by less than a texel a frame, and hold what flickers against the truth"};
  command.about =
      "Looks the first frame's receivers up in the map of every frame, once with the map's texel grid snapped to the "
      "world and once without, and compares what changes from frame to frame with what changes in ray-traced truth. "
      "Writes flicker.html, .md, .json, .csv and pictures by pixel.";
  auto a = std::make_shared<FlickerArguments>();
  a->map_size = "512";
  a->size = "320x180";
  a->out = "report/out/flicker";
  add_scene_option(command, a->scene);
  add_builtin_filters_option(command, a->filters);
  command.add("--frames", &a->frames, "frames of each motion, 2 or more");
  add_picture_options(command, *a);
  command.add("--motion", &a->motions, "what moves: light, camera, or both, separated by a comma");
  add_drawing_options(command, *a);
  command.action = [a](const CommandLine& line) { return measure_flicker(*a, line.words()); };
  return command;
}

}  // namespace shadowbench::cli
