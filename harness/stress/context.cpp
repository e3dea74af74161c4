#include "harness/stress/context.h"

#include <algorithm>

namespace shadowbench::stress {

std::string find_exponent(const filters::FilterSpec& spec) {
  return spec.holds_moments ? std::string() : spec.exponent;
}

std::vector<DrivenFilter> find_driven(const StressContext& context, DrivenParam param_of) {
  std::vector<DrivenFilter> driven;
  for (const filters::FilterRequest& request : context.filters) {
    const std::string param = param_of(request.spec);
    if (!param.empty()) driven.push_back({request, param});
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
