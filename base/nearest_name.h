#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shadowbench {

/// Finds the known name that `name` was most likely meant to be, ignoring case.
/// Returns nothing where even the closest one differs in more than one of `part` letters: in half of them where few
/// names are known. Among many names one is near by chance, and `part` should be larger.
/// Source: optimal string alignment distance (insert, delete, replace, swap neighbours; each costs 1).
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known,
                                        std::size_t part = 2);

/// The end of a message about an unknown name: "; did you mean 'x'?", empty where no known name is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known, std::size_t part = 2);

/// The same, but where no known name is near it lists them all: "; known: x, y".
std::string did_you_mean_or_known(std::string_view name, const std::vector<std::string>& known);

}  // namespace shadowbench
