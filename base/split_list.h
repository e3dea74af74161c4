#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shadowbench {

/// Splits a list at its separators. An empty text is a list of one empty part.
std::vector<std::string> split_list(std::string_view list, std::string_view separator = ",");

/// Splits "key=value,key=value", which follow a colon; a part without "=" has an empty value. Throws Error(kUsage), in
/// the name of `option`, for an empty text and where a key is given twice.
std::vector<std::pair<std::string, std::string>> split_assignments(std::string_view list, std::string_view option);

}  // namespace shadowbench
