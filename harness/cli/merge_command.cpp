#include <fmt/format.h>

#include <memory>

#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/cli/interruption.h"
#include "harness/cli/print.h"
#include "harness/run/merge.h"

namespace shadowbench::cli {

Command make_merge_command() {
  struct Arguments {
    std::vector<std::string> folders, times;
    std::string out;
    bool force = false;
  };
  Command command{"merge", "Merge the shards of 'run', or times from other machines, into one report"};
  command.about =
      "Makes one report of the folders of 'run --shard 1/N' to 'N/N'. With --times, adds times that readers' browsers "
      "saved to a report: its page, fronts.csv and answer then offer each machine's costs.";
  auto a = std::make_shared<Arguments>();
  command.add("DIR", &a->folders, "report folders of all shards of one experiment, or the folder of a run")
      .names(ValueKind::kFolder)
      .require();
  command.add("--out", &a->out, "folder of the merged report; new or empty").names(ValueKind::kFolder);
  add_force_option(command, a->force);
  command.add("--times", &a->times, "gpu-times.json saved by the page of the run in DIR; repeatable")
      .names(ValueKind::kFile);
  command.action = [a](const CommandLine&) {
    const bool has_times = !a->times.empty();
    if (has_times && (!a->out.empty() || a->folders.size() > 1))
      fail("--times joins times to one report: name its folder alone, without --out");
    if (!has_times && a->out.empty()) fail("--out is required: name the folder of the whole report");
    const std::filesystem::path out = a->out.empty() ? a->folders.front() : a->out;
    {
      const Interruption interruption(out, kStoppedAdvice);
      if (has_times)
        run::merge_times(out, {a->times.begin(), a->times.end()});
      else
        run::merge_runs({a->folders.begin(), a->folders.end()}, out, a->force);
    }
    print("report: {}\n", (out / "index.html").string());
    return 0;
  };
  return command;
}

}  // namespace shadowbench::cli
