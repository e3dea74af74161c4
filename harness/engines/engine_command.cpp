#include "harness/engines/engine_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/error.h"
#include "base/files.h"
#include "harness/run/worker_process.h"

namespace shadowbench::engines {
namespace {

/// The last line that is not empty: what a program says before it ends.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

/// Runs a command in its folder. Throws Error(kInput) where it does not do what it is to do.
void draw(const options::Engine& engine, const std::filesystem::path& folder, double timeout_s) {
  const std::filesystem::path picture = folder / "picture.exr";
  run::WorkerProcess process({"-c", fmt::format("cd \"$1\" && {} \"$2\" \"$3\"", engine.command), "sh",
                              std::filesystem::absolute(engine.folder.empty() ? "." : engine.folder).string(),
                              (folder / "scene.json").string(), picture.string()},
                             {.program = "/bin/sh"});
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  const bool ended = process.listen(std::chrono::time_point_cast<std::chrono::steady_clock::duration>(deadline));
  const run::WorkerOutcome outcome = process.end();
  const std::string said = last_line(outcome.error_text);
  const std::string end = said.empty() ? "" : fmt::format("; it said: {}", said);
  if (!ended)
    fail_input(fmt::format("the command was not done after {:g} s, and was killed (--cell-timeout){}", timeout_s, end));
  if (outcome.exit_code != 0)
    fail_input(fmt::format("the command {}{}",
                           outcome.exit_code ? fmt::format("ended with exit code {}", *outcome.exit_code)
                                             : fmt::format("was killed by signal {}", outcome.signal),
                           end));
  if (!std::filesystem::exists(picture))
    fail_input("the command ended well, and wrote no picture.exr where it was told to" + end);
}

}  // namespace

std::vector<std::pair<records::CellRecord, std::vector<Finding>>> run_engines(
    RunScorer& scorer, const std::vector<options::Engine>& engines, const ScoreRequest& request, double timeout_s,
    options::Progress& progress) {
  std::vector<std::pair<records::CellRecord, std::vector<Finding>>> rows;
  std::vector<std::string> failures;
  for (const options::Engine& engine : engines) scorer.check_name(engine.name);
  for (const analysis::Place& place : scorer.list_places()) {
    if ((!request.scene.empty() && place.scene != request.scene) ||
        (!request.view.empty() && place.view != request.view))
      continue;
    const ScratchFolder folder(std::filesystem::absolute(make_temporary_folder_path(scorer.folder(), "engine")));
    scorer.export_place(place, folder.path());
    for (const options::Engine& engine : engines) {
      progress.note(fmt::format("{}: {}", place.scene, engine.name));
      try {
        for (const char* old : {"picture.exr", "meta.json", "shadow_map.exr"})
          std::filesystem::remove(folder.path() / old);
        draw(engine, folder.path(), timeout_s);
        ScoreRequest own = request;
        own.name = engine.name;
        own.scene = place.scene;
        own.view = place.view;
        own.files = {.layers = (folder.path() / "picture.exr").string()};
        if (std::filesystem::exists(folder.path() / "meta.json")) own.meta = folder.path() / "meta.json";
        if (const auto map = folder.path() / "shadow_map.exr"; std::filesystem::exists(map))
          own.files.shadow_map = map.string();
        rows.push_back(scorer.score(own));
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::kInput) {
          if (!rows.empty()) scorer.finish();
          throw;
        }
        failures.push_back(fmt::format("{}, {}: {}", engine.name, place.scene, error.what()));
        progress.note("failed: " + failures.back());
      }
    }
  }
  if (!rows.empty()) scorer.finish();
  if (failures.empty() && rows.empty())
    throw Error(ErrorKind::kUsage, fmt::format("--scene: the run has no scene '{}' with such a view", request.scene));
  if (failures.empty()) return rows;
  fail_input(fmt::format("{} of {} pictures could not be scored; the first: {}", failures.size(),
                         failures.size() + rows.size(), failures.front()));
}

}  // namespace shadowbench::engines
