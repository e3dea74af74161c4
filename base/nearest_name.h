#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shadowbench {

/// Finds the known name that `name` was most likely meant to be, ignoring case.
/// Returns nothing where even the closest one differs in more than half of its letters.
/// Source: optimal string alignment distance (insert, delete, replace, swap neighbours; each costs 1).
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known);

/// The end of a message about an unknown name: "; did you mean 'x'?", empty where no known name is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

/// The same, but where no known name is near it lists them all: "; known: x, y".
std::string did_you_mean_or_known(std::string_view name, const std::vector<std::string>& known);

}  // namespace shadowbench
