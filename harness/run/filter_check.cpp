#include "harness/run/filter_check.h"

#include <set>
#include <utility>
#include <vector>

#include "filters/filter_errors.h"
#include "harness/run/worker_process.h"

namespace shadowbench::run {

void check_user_filters(const RunPlan& plan, const std::string& backend) {
  std::set<std::string> checked;  // ids
  std::vector<filters::FilterMistake> mistakes;
  for (const PlannedTask& planned : plan.tasks) {
    const PlannedScene& scene = plan.scenes[planned.scene];
    for (const filters::FilterRequest& request : planned.task.filters) {
      if (!request.user_file || !checked.insert(request.spec.id).second) continue;
      try {
        check_user_filter(scene.options, planned.task, request, {scene.argument, backend});
      } catch (const filters::FilterErrors& error) {
        mistakes.insert(mistakes.end(), error.mistakes().begin(), error.mistakes().end());
      }
    }
  }
  if (!mistakes.empty()) throw filters::FilterErrors(std::move(mistakes));
}

}  // namespace shadowbench::run
