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

/// What axes make their cases from. It outlives all cases.
struct AxisInputs {
  measure::Renderer* renderer = nullptr;  ///< null: there is no GL, and cases that need one are not available
  options::Resources resources;
  std::vector<filters::FilterRequest> filters;  ///< the chosen ones, each with its parameter values
  std::uint32_t seed = 1;
  std::filesystem::path cache;            ///< for traced truth; empty: nothing is kept
  std::filesystem::path out;              ///< where exhibits write their pictures
  options::Progress* progress = nullptr;  ///< for exhibits' notes; may be null
};

/// Names the parameter of a filter that an axis drives, from what the front matter declares; empty: it has none.
using DrivenParam = std::string (*)(const filters::FilterSpec&);

/// Names the exponent of a filter that stores exponentials and no moments of them.
std::string find_exponent(const filters::FilterSpec& spec);

bool is_set_by_user(const filters::FilterRequest& request, const std::string& param);

/// Lists the values of a filter's text parameter, such as `store`, that get a case each: the chosen value alone where
/// the user set it, all otherwise; none where the filter has no such parameter.
std::vector<std::string> list_choices(const filters::FilterRequest& request, const std::string& param);

}  // namespace shadowbench::stress
