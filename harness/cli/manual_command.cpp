#include <filesystem>
#include <memory>

#include "filters/base/atomic_file.h"
#include "filters/catalogue.h"
#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/completion.h"
#include "harness/cli/manual_page.h"
#include "harness/options/experiment_file.h"
#include "harness/scene/load.h"

namespace shadowbench::cli {
namespace {

KnownNames list_known_names() {
  const options::Resources resources = options::find_resources();
  KnownNames names;
  for (const auto& scenes : {scene::list_scenes(resources.scenes), scene::list_teaching_scenes(resources.scenes)})
    for (const scene::SceneInfo& info : scenes) names[ValueKind::kScene].push_back(info.name);
  const filters::Catalogue catalogue(resources.filters);
  names[ValueKind::kFilters] = {"all"};
  for (const filters::FilterSpec& spec : catalogue.filters()) names[ValueKind::kFilters].push_back(spec.id);
  names[ValueKind::kExperiment] = options::list_experiments(resources.experiments);
  return names;
}

int write_manual(const Command& program, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const KnownNames names = list_known_names();
  write_text_file(folder / (program.name + ".1"), make_program_page(program));
  for (const Command& command : program.commands)
    if (!command.hidden)
      write_text_file(folder / (program.name + "-" + command.name + ".1"), make_command_page(program, command));
  write_text_file(folder / (program.name + ".bash"), make_bash_completion(program, names));
  write_text_file(folder / ("_" + program.name), make_zsh_completion(program, names));
  return 0;
}

}  // namespace

Command make_manual_command(const Command& program) {
  Command command{"manual", "Write manual pages and completions for the shells"};
  command.hidden = true;
  auto folder = std::make_shared<std::string>();
  command.add("DIR", folder.get(), "folder of the pages").names(ValueKind::kFolder).require();
  command.action = [folder, &program](const CommandLine&) { return write_manual(program, *folder); };
  return command;
}

}  // namespace shadowbench::cli
