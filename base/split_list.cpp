#include "base/split_list.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace shadowbench {

std::vector<std::string> split_list(std::string_view list, std::string_view separator) {
  std::vector<std::string> parts;
  std::size_t end = 0;
  while ((end = list.find(separator)) != std::string_view::npos) {
    parts.emplace_back(list.substr(0, end));
    list.remove_prefix(end + separator.size());
  }
  parts.emplace_back(list);
  return parts;
}

std::vector<std::pair<std::string, std::string>> split_assignments(std::string_view list, std::string_view option) {
  std::vector<std::pair<std::string, std::string>> assignments;
  if (list.empty())
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: nothing follows the ':'; write KEY=VALUE there, or leave it out", option));
  for (const std::string& part : split_list(list)) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string key = part.substr(0, equals);
    for (const auto& known : assignments)
      if (known.first == key) throw Error(ErrorKind::kUsage, fmt::format("{}: '{}' is given twice", option, key));
    assignments.emplace_back(key, part.substr(std::min(equals + 1, part.size())));
  }
  return assignments;
}

}  // namespace shadowbench
