#include "harness/stress/context.h"

#include <algorithm>

namespace shadowbench::stress {

std::vector<DrivenFilter> find_driven(const StressContext& context, const std::string& axis) {
  std::vector<DrivenFilter> driven;
  for (const filters::FilterRequest& request : context.filters) {
    for (const filters::ParamSpec& param : request.spec.params) {
      if (param.stress == axis) driven.push_back({request, param.name});
    }
  }
  return driven;
}

std::vector<std::string> list_choices(const filters::FilterRequest& request, const std::string& param) {
  const filters::ParamSpec* spec = request.spec.find_param(param);
  if (!spec) return {};
  const bool chosen = std::ranges::find(request.set_by_user, param) != request.set_by_user.end();
  if (chosen) return {filters::to_string(request.values.at(param))};
  std::vector<std::string> choices;
  for (const filters::ParamValue& choice : spec->choices) choices.push_back(filters::to_string(choice));
  return choices;
}

}  // namespace shadowbench::stress
