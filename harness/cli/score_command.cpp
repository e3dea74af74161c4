#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/terminal.h"
#include "harness/engines/exported_scene.h"
#include "harness/engines/score_run.h"
#include "report/records/csv_tables.h"
#include "report/records/format.h"
#include "report/records/json_values.h"
#include "report/records/records.h"

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

struct ScoreArguments : DrawingArguments {
  std::string run, name, scene, view, command;
  engines::ExternalFiles files;
  std::string meta;
  std::string map_size;
  double timeout_s = 60.0;
  bool unaligned = false;
  bool json = false;
};

using Row = std::pair<records::CellRecord, std::vector<engines::Finding>>;

std::string describe_shift(const records::ExternalRecord& external) {
  if (!external.shift_x) return "not known: give --depth, or --unlit";
  std::string text = fmt::format("{:.3f} right, {:.3f} down of ours, by {}", *external.shift_x, *external.shift_y,
                                 external.aligned_by);
  if (external.shift_p99) text += fmt::format("; {:.3f} at the 99th percentile", *external.shift_p99);
  return text + (external.unaligned ? "; NOT our view, by what was found" : "");
}

/// The row among the run's filters, each of one phase, the best first.
void print_peers(const records::CellRecord& cell) {
  std::vector<std::pair<double, std::string>> rows;
  for (const auto& [label, rmse] : cell.external->peers) rows.emplace_back(rmse, label);
  if (cell.error.rmse) rows.emplace_back(*cell.error.rmse, cell.filter + "  <-");
  std::ranges::sort(rows);
  for (const auto& [rmse, label] : rows) print("  {:<8} {}\n", records::format_number(rmse), label);
}

void print_row(const Row& row) {
  const auto& [cell, findings] = row;
  const records::ExternalRecord& external = *cell.external;
  const auto number = [&](const char* name, const std::optional<double>& value, const std::string& field) {
    print("{:<20} {}\n", name,
          value ? records::format_number(value) : "absent: " + records::explain_absence(cell, field));
  };
  print("{} on {}, view {}\n", cell.filter, cell.scene, cell.view);
  print("{:<20} {}\n", "shift, pixels", describe_shift(external));
  number("RMSE", cell.error.rmse, "error.rmse");
  number("without silhouettes", external.inside_rmse, "error.rmse");
  number("mean", cell.error.mean, "error.mean");
  number("FLIP", cell.error.flip, "error.flip");
  number("acne", cell.artefact.acne, "artefact.acne");
  number("leak", cell.artefact.leak, "artefact.leak");
  number("contact gap", cell.artefact.contact_gap, "artefact.contact_gap");
  print("{:<20} {} of {} receivers\n", "undefined", external.undefined, cell.receivers.value_or(0));
  if (external.nearest)
    print("{:<20} {}, {} apart\n", "nearest filter", *external.nearest, records::format_number(external.nearest_rmse));
  print_peers(cell);
}

std::filesystem::path run_folder(const std::string& run) { return find_results(run).parent_path(); }

/// The options of a run, from the command line that its report keeps. Throws Error(kInput) where that is none of 'run'.
options::RunOptions reread_options(const std::filesystem::path& folder, const ScoreArguments& arguments) {
  const records::Results results = records::read_results(folder / "results.json");
  const std::vector<std::string>& words = results.run.command;
  if (words.size() < 2 || words[1] != "run")
    throw Error(ErrorKind::kInput, "this report was not made by 'shadowbench run', whose settings are read from it",
                folder.string());
  RunArguments told;
  Command run{"run", ""};
  add_run_options(run, told);
  options::RunOptions options;
  run.action = [&](const CommandLine& line) {
    apply_experiment(line, told);
    options = make_run_options(told, line.words());
    return 0;
  };
  Command program{"shadowbench", ""};
  program.commands = {run};
  try {
    run_command_line(program, words);
  } catch (const Error& error) {
    throw Error(error.kind(),
                error.message() + "; the run's command is read again: score in the folder in which it was started",
                error.where());
  }
  take_drawing_options(arguments, options);
  options.out = folder;
  return options;
}

/// Only the scene that is asked for is loaded, where its name tells which that is.
void keep_scene(options::RunOptions& options, const std::string& scene) {
  const auto is_it = [&](const std::string& argument) {
    const std::string stem = std::filesystem::path(argument).stem().string();
    return scene == stem || scene.starts_with(stem + ".");
  };
  if (std::ranges::count_if(options.scenes, is_it) == 1)
    std::erase_if(options.scenes, [&](const std::string& each) { return !is_it(each); });
}

void check_arguments(const ScoreArguments& arguments) {
  const engines::ExternalFiles& files = arguments.files;
  const bool has_files =
      !(files.layers + files.lit + files.unlit + files.visibility + files.depth + files.shadow_map + files.unbiased)
           .empty();
  if (arguments.command.empty() && !has_files)
    fail(
        "score: give what was drawn: --layers F, or --lit F --unlit F, or --visibility F; or --command C, which draws");
  if (!arguments.command.empty() && (has_files || !arguments.meta.empty()))
    fail("--command draws the pictures, and may leave a meta.json: leave out the files");
  if (!(arguments.timeout_s > 0.0)) fail("--cell-timeout must be more than 0 seconds");
}

std::vector<Row> score_all(const ScoreArguments& arguments, const options::RunOptions& options,
                           options::Progress& progress) {
  engines::RunScorer scorer(options, progress);
  engines::ScoreRequest request{.name = arguments.name,
                                .scene = arguments.scene,
                                .view = arguments.view,
                                .files = arguments.files,
                                .meta = {},
                                .unaligned = arguments.unaligned};
  if (!arguments.map_size.empty()) request.map_size = parse_count(arguments.map_size, "--map-size");
  if (!arguments.meta.empty()) request.meta = arguments.meta;
  if (!arguments.command.empty())
    return engines::run_engines(scorer, {{arguments.name, arguments.command, "."}}, request, arguments.timeout_s,
                                progress);
  std::vector<Row> rows = {scorer.score(request)};
  scorer.finish();
  return rows;
}

int score(const ScoreArguments& arguments) {
  check_arguments(arguments);
  const std::filesystem::path folder = run_folder(arguments.run);
  options::RunOptions options = reread_options(folder, arguments);
  keep_scene(options, arguments.scene);
  const std::vector<Row> rows =
      work_with_progress(folder, [&](options::Progress& progress) { return score_all(arguments, options, progress); });
  nlohmann::json all = nlohmann::json::array();
  for (const Row& row : rows) {
    for (const engines::Finding& finding : row.second)
      print_message("warning: {}: {}\n", row.first.scene, finding.text);
    all.push_back(records::to_json(row.first));
    if (!arguments.json) print_row(row);
  }
  if (arguments.json)
    fmt::print("{}\n", all.dump(2));
  else
    print("report: {}\n", (folder / "index.html").string());
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

Command make_score_command() {
  Command command{"score", "Score another renderer's image of a run's scene, as a row of its report"};
  command.about =
      "'export' writes the scene for the other renderer. Visibility is the lit image over the unlit one, at each "
      "receiver; it is scored like a filter's, against the same truth. The images are first checked against the run's "
      "view: a shift over 0.05 pixels is a warning; over 0.25 pixels, flipped, display-encoded or exchanged images are "
      "errors.\nImages are linear, in any format of OpenImageIO; FILE#PART is one part. With --command a program draws "
      "each scene of the run: it gets a scene.json and the name of the EXR file to write, with the layers lit, unlit, "
      "visibility and depth.";
  auto a = std::make_shared<ScoreArguments>();
  command.add("RUN", &a->run, "the report's folder, which gets the row").names(ValueKind::kFolder).require();
  command.add("--name", &a->name, "name of the row").never_empty("a name, such as 'three.js PCF'").require();
  command.add("--scene", &a->scene, "a scene of the run (default its only one; with --command all)")
      .names(ValueKind::kScene);
  command.add("--view", &a->view, "a view of that scene (default its only one)");
  command.add("--layers", &a->files.layers, "EXR file with layers lit and unlit, or visibility; optionally depth")
      .names(ValueKind::kFile);
  command.add("--lit", &a->files.lit, "the light with its shadow, without ambient light").names(ValueKind::kFile);
  command.add("--unlit", &a->files.unlit, "the same without the shadow").names(ValueKind::kFile);
  command.add("--visibility", &a->files.visibility, "instead of both: 1 lit, 0 in shadow").names(ValueKind::kFile);
  command.add("--unbiased", &a->files.unbiased, "visibility without any bias, to separate contact gap from blur")
      .names(ValueKind::kFile);
  command.add("--map-size", &a->map_size, "the run's map to compare with (default its first)");
  command.add("--depth", &a->files.depth, "metres along the camera's axis; detects a shift best")
      .names(ValueKind::kFile);
  command
      .add("--shadow-map", &a->files.shadow_map,
           "its own shadow map as stored, to attribute its error; needs map_from_world in --meta")
      .names(ValueKind::kFile);
  command
      .add("--meta", &a->meta,
           "a JSON object of texts: engine, version, driver, map, bias, fit, ms, timed, truth; map_from_world")
      .names(ValueKind::kFile);
  command.add("--command", &a->command, "shell command that draws the scene; gets a scene.json and the EXR to write");
  command.add("--cell-timeout", &a->timeout_s, "seconds that the command may take on one scene");
  command.add("--unaligned", &a->unaligned, "score images that do not match the run's view, and mark the row");
  add_json_option(command, a->json);
  add_backend_option(command, a->backend);
  command.add("--cache", &a->cache, "folder of traced images (default as 'run')").names(ValueKind::kFolder);
  command.action = [a](const CommandLine&) { return score(*a); };
  return command;
}

}  // namespace shadowbench::cli
