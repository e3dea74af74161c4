#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shadowbench {

/// Splits a list at its separators. An empty text is a list of one empty part.
std::vector<std::string> split_list(std::string_view list, std::string_view separator = ",");

}  // namespace shadowbench
