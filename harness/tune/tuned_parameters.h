#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "filters/catalogue.h"
#include "harness/scene/lights/light_fit.h"

namespace shadowbench::tune {

/// Every request the parameters that a tuned.json holds for its filter, but for those that the request sets
/// itself. Returns what the user should know: filters that the file does not name, which keep their defaults, and maps
/// and fits that differ from those it was tuned on. Throws Error(kInput), with file and field, where the file is
/// malformed or names an unknown filter or parameter, or a value that is not allowed; also for filters that are not
/// requested.
std::vector<std::string> apply_tuned(std::vector<filters::FilterRequest>& requests, const filters::Catalogue& catalogue,
                                     const std::filesystem::path& file, const std::vector<int>& map_sizes,
                                     const std::vector<scene::FitRule>& fits);

}  // namespace shadowbench::tune
