#include "report/analysis/verdict_places.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace shadowbench::analysis {

std::string describe_places(const VerdictPlaces& places) {
  std::map<std::pair<std::string, std::string>, std::vector<int>> maps;  // scenes and picture to maps
  for (const auto& [place, scenes] : places)
    maps[{fmt::format("{}", fmt::join(scenes, ", ")), place.first}].push_back(place.second);
  std::vector<std::string> texts;
  for (const auto& [where, sizes] : maps)
    texts.push_back(fmt::format("{}, picture {}, map {}", where.first, where.second, fmt::join(sizes, ", ")));
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace shadowbench::analysis
