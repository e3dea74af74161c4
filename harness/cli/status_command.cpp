#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "harness/cli/arguments.h"
#include "harness/cli/commands.h"
#include "harness/submit/sweep_status.h"

namespace shadowbench::cli {
namespace {

bool is_trouble(const submit::TaskStatus& task) {
  return task.state == submit::TaskState::kFailed || task.state == submit::TaskState::kLost;
}

}  // namespace

Command make_status_command() {
  struct Arguments {
    std::string folder;
    double silent_after_s = submit::kSilentAfter_s;
    bool json = false;
  };
  Command command{"status", "Say how far a submitted sweep is"};
  command.about =
      "Reads the files of the sweep alone, and asks no scheduler: a task that waits in a queue counts as waiting, "
      "and one that was stopped and waits there again as failed until it begins. Exit code 1 where a task failed or "
      "was lost; 'submit' with the same words submits those again.";
  auto a = std::make_shared<Arguments>();
  command.add("DIR", &a->folder, "the folder that 'submit' was given with --out").names(ValueKind::kFolder).require();
  command.add("--silent-after", &a->silent_after_s,
              "seconds after which a task that shows no sign of life is taken for lost");
  add_json_option(command, a->json);
  command.action = [a](const CommandLine&) {
    if (!(a->silent_after_s > 0.0))
      fail(fmt::format("--silent-after: {} is out of range: choose more than 0 seconds", a->silent_after_s));
    const submit::SweepStatus status = submit::read_status(a->folder, a->silent_after_s);
    if (a->json)
      fmt::print("{}", submit::make_status_json(status));
    else
      print("{}", submit::describe_status(status));
    return std::ranges::any_of(status.truths, is_trouble) || std::ranges::any_of(status.tasks, is_trouble) ? 1 : 0;
  };
  return command;
}

}  // namespace shadowbench::cli
