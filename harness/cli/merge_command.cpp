#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "harness/cli/commands.h"
#include "harness/cli/interruption.h"
#include "harness/run/merge.h"

namespace shadowbench::cli {

void add_merge_command(CLI::App& app, Action& action) {
  struct Arguments {
    std::vector<std::filesystem::path> folders;
    std::filesystem::path out;
  };
  CLI::App* command = app.add_subcommand("merge", "Join the report folders that 'run --shard 1/N' to 'N/N' wrote");
  auto a = std::make_shared<Arguments>();
  command->add_option("DIR", a->folders, "the report folders of all shards of one experiment")->required();
  command->add_option("--out", a->out, "folder of the whole report; new or empty")->required();
  command->callback([&action, a] {
    action = [a] {
      {
        const Interruption interruption(a->out, kStoppedAdvice);
        run::merge_runs(a->folders, a->out);
      }
      fmt::print("report: {}\n", (a->out / "index.html").string());
      return 0;
    };
  });
}

}  // namespace shadowbench::cli
