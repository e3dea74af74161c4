#include "filters/map_range.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"

namespace shadowbench::filters {

const std::vector<std::string>& border_names() {
  static const std::vector<std::string> names = {"border", "edge", "repeat"};
  return names;
}

const std::string& to_string(Border border) { return border_names().at(static_cast<std::size_t>(border)); }

Border parse_border(const std::string& name) {
  const auto found = std::find(border_names().begin(), border_names().end(), name);
  if (found != border_names().end()) return static_cast<Border>(found - border_names().begin());
  throw Error(ErrorKind::kUsage, fmt::format("unknown border '{}'; known: {}", name, fmt::join(border_names(), ", ")));
}

}  // namespace shadowbench::filters
