#include "harness/stress/axis_inputs.h"

#include <algorithm>

namespace shadowbench::stress {

std::string find_exponent(const filters::FilterSpec& spec) {
  return spec.holds_moments ? std::string() : spec.exponent;
}

bool is_set_by_user(const filters::FilterRequest& request, const std::string& param) {
  return std::ranges::find(request.set_by_user, param) != request.set_by_user.end();
}

std::vector<std::string> list_choices(const filters::FilterRequest& request, const std::string& param) {
  const filters::ParamSpec* spec = request.spec.find_param(param);
  if (!spec) return {};
  if (is_set_by_user(request, param)) return {filters::to_string(request.values.at(param))};
  std::vector<std::string> choices;
  for (const filters::ParamValue& choice : spec->choices) choices.push_back(filters::to_string(choice));
  return choices;
}

}  // namespace shadowbench::stress
