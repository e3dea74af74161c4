#include <fmt/format.h>

#include <memory>

#include "harness/cli/commands.h"
#include "harness/cli/interruption.h"
#include "harness/run/merge.h"

namespace shadowbench::cli {

Command make_merge_command() {
  struct Arguments {
    std::vector<std::string> folders;
    std::string out;
  };
  Command command{"merge", "Join the report folders that 'run --shard 1/N' to 'N/N' wrote"};
  auto a = std::make_shared<Arguments>();
  command.add("DIR", &a->folders, "the report folders of all shards of one experiment")
      .names(ValueKind::kFolder)
      .require();
  command.add("--out", &a->out, "folder of the whole report; new or empty").names(ValueKind::kFolder).require();
  command.action = [a](const CommandLine&) {
    const std::filesystem::path out = a->out;
    {
      const Interruption interruption(out, kStoppedAdvice);
      run::merge_runs({a->folders.begin(), a->folders.end()}, out);
    }
    fmt::print("report: {}\n", (out / "index.html").string());
    return 0;
  };
  return command;
}

}  // namespace shadowbench::cli
