#include <fmt/format.h>

#include <memory>

#include "harness/cli/commands.h"
#include "harness/cli/print.h"
#include "harness/cli/progress_bar.h"
#include "harness/cli/run_arguments.h"
#include "harness/engines/exported_scene.h"

namespace shadowbench::cli {
namespace {

int export_scenes(RunArguments& arguments, const std::vector<std::string>& words) {
  options::find_told<std::string>(arguments.told, "--filters") = kReferenceFilter;
  const options::RunOptions options = make_run_options(arguments, words);
  const engines::ExportedScenes exported = work_with_progress(
      options.out, [&](options::Progress& progress) { return engines::export_scenes(options, progress); });
  for (const std::filesystem::path& folder : exported.folders) print("{}\n", (folder / "scene.json").string());
  if (arguments.strict) require_no_warnings(exported.warnings, "scene");
  return 0;
}

}  // namespace

Command make_export_command() {
  Command command{"export", "Write scenes for other renderers: a .glb of each, with the light's map"};
  command.about =
      "Writes OUT/<scene>/<scene>.glb with camera and light, and scene.json with image size and the map's window. "
      "'score' scores what another renderer draws of it. 'run --scene OUT/<scene>/<scene>.glb' measures the same "
      "scene.";
  auto a = std::make_shared<RunArguments>();
  command
      .add("SCENE", &options::find_told<std::vector<std::string>>(a->told, "--scene"),
           "scenes, as --scene of 'run' takes them")
      .names(ValueKind::kScene)
      .require();
  add_told(command, *a, {"--ground", "--view", "--light-name", "--light", "--size", "--map-size", "--fit"});
  add_strict(command, *a, "exit code 1 where a scene has a warning, as 'run' gives it; the scenes are written");
  add_drawing_options(command, *a);
  a->out = "report/out/scenes";
  command.action = [a](const CommandLine& line) { return export_scenes(*a, line.words()); };
  return command;
}

}  // namespace shadowbench::cli
