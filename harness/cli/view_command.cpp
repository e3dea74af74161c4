#include <fmt/format.h>

#include <memory>

#include "base/error.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/view/gui.h"

namespace shadowbench::cli {
namespace {

constexpr double kLargestScale = 4.0;

struct ViewArguments : DrawingArguments {
  view::ViewOptions view;
  bool ground = false;
  std::vector<std::string> filter_files;
  std::string map_size = "1024", size;
};

int view_scene(const ViewArguments& arguments, const CommandLine& line) {
  view::ViewOptions options = arguments.view;
  for (const char* other : {"scene", "--left", "--right", "--light-name", "--map-size"})
    if (!options.lesson.empty() && line.has(other)) fail(fmt::format("--lesson sets {} itself: leave it out", other));
  take_drawing_options(arguments, options.run);
  options::read_run_options(options::list_run_options(), options.run);
  options.run.ground = arguments.ground;
  options.run.map_sizes = {parse_count(arguments.map_size, "--map-size")};
  options.keeps_size = !arguments.size.empty();
  if (options.keeps_size) std::tie(options.run.width, options.run.height) = parse_picture_size(arguments.size);
  options.run.sizes = {{options.run.width, options.run.height}};
  options.filter_files.assign(arguments.filter_files.begin(), arguments.filter_files.end());
  if (!(options.scale >= 0.0 && options.scale <= kLargestScale))
    fail(fmt::format("--scale: {} is out of range: choose 0 .. {:g}; 0 asks the screen", options.scale, kLargestScale));
#ifdef SHADOWBENCH_HAS_WINDOW
  view::run_view(options);
  return 0;
#else
  throw Error(ErrorKind::kContext,
              "this build has no window; install libglfw3-dev, libimgui-dev and libstb-dev, and configure it again");
#endif
}

}  // namespace

Command make_view_command() {
  Command command{"view", "Compare two filters, or one and the truth, in a window"};
  command.about =
      "A divider between two filters, or a filter and ray-traced truth. Camera, light, map and every parameter by "
      "mouse; errors, causes, times; lessons on what goes wrong. F1 lists the keys. A filter's file is recompiled "
      "whenever it is saved.";
  auto a = std::make_shared<ViewArguments>();
  a->out = "report/out/view";
  command.add("scene", &a->view.scene, "a built-in scene by name, or a .toml, .gltf, .glb or .obj file")
      .names(ValueKind::kScene);
  command.add("--lesson", &a->view.lesson, "begin with a lesson of 'list lessons', in place of a scene");
  command.add("--ground", &a->ground, "put a floor under a bare model");
  command.add("--light-name", &a->view.light_name, "the scene's light of this name");
  command
      .add("--left", &a->view.sides[0],
           "the left side: a filter with parameters, or 'truth' (default your own filter, or one of medium width)")
      .names(ValueKind::kFilters);
  command.add("--right", &a->view.sides[1], "the right side").names(ValueKind::kFilters);
  add_as_run(command, "--filter-file", &a->filter_files);
  command.add("--map-size", &a->map_size, "texels along a side of the shadow map");
  command.add("--size", &a->size, "keep the image at WIDTHxHEIGHT pixels (default the window's size)");
  command.add("--scale", &a->view.scale, "scale of text and widgets (default the screen's)");
  command.add("--out", &a->out, "folder for saved images");
  command.add("--log", &a->view.log, "").hide();
  command.add("--close-after", &a->view.close_after_s, "").hide();
  command.action = [a](const CommandLine& line) { return view_scene(*a, line); };
  return command;
}

}  // namespace shadowbench::cli
