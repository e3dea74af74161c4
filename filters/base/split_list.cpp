#include "filters/base/split_list.h"

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

}  // namespace shadowbench
