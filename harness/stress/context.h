#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/measure/renderer.h"
#include "harness/options/options.h"
#include "harness/options/progress.h"

namespace shadowbench::stress {

/// What axes make their cases from. Outlives all cases.
struct StressContext {
  measure::Renderer* renderer =
      nullptr;  ///< null: no GL (tests of scalar cases); GL cases are reported as not available
  options::Resources resources;
  std::vector<filters::FilterRequest> filters;  ///< the chosen ones, each with its parameter values
  std::uint32_t seed = 1;
  std::filesystem::path cache;            ///< for traced truth; empty: nothing is kept
  std::filesystem::path out;              ///< where exhibits write their pictures
  options::Progress* progress = nullptr;  ///< for exhibits' notes; may be null
};

/// Names the parameter of a filter that an axis drives, from what the front matter declares; empty: not for this
/// filter.
using DrivenParam = std::string (*)(const filters::FilterSpec&);

/// Names the exponent of a filter that stores exponentials and no moments of them.
std::string find_exponent(const filters::FilterSpec& spec);

/// A chosen filter with the parameter that an axis drives.
struct DrivenFilter {
  filters::FilterRequest request;
  std::string param;
};

/// Finds the chosen filters that have such a parameter, in the order they were chosen.
std::vector<DrivenFilter> find_driven(const StressContext& context, DrivenParam param_of);

/// Gives the choices of a filter's text parameter, such as `store`, for a case each: the chosen value alone where the
/// user set it, all otherwise; empty where the filter has no such parameter.
std::vector<std::string> list_choices(const filters::FilterRequest& request, const std::string& param);

}  // namespace shadowbench::stress
