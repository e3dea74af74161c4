#include <memory>
#include <string>

#include "harness/cli/commands.h"
#include "harness/gpu/facts_request.h"

namespace shadowbench::cli {

Command make_gpu_facts_command() {
  struct Files {
    std::string request, answers;
  };
  Command command{"gpu-facts", "Compile passes for a GPU and say what its compiler says"};
  command.hidden = true;
  auto files = std::make_shared<Files>();
  command.add("REQUEST", &files->request, "what to compile").names(ValueKind::kFile).require();
  command.add("ANSWERS", &files->answers, "where the facts go, a line for each pass").names(ValueKind::kFile).require();
  command.action = [files](const CommandLine&) {
    gpu::answer_request(files->request, files->answers);
    return 0;
  };
  return command;
}

}  // namespace shadowbench::cli
