#include "report/analysis/verdict_places.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace shadowbench::analysis {
namespace {

// Each scene once, in the order in which it first appears; "cubes (3 settings)" where it stands there for several
// lights, biases or fits.
std::string join_scenes(const std::vector<std::string>& scenes) {
  std::vector<std::string> names;
  for (auto scene = scenes.begin(); scene != scenes.end(); ++scene) {
    if (std::find(scenes.begin(), scene, *scene) != scene) continue;
    const auto count = std::count(scene, scenes.end(), *scene);
    names.push_back(count > 1 ? fmt::format("{} ({} settings)", *scene, count) : *scene);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string describe_places(const VerdictPlaces& places) {
  std::map<std::pair<std::string, std::string>, std::vector<int>> maps;  // scenes and picture to maps
  for (const auto& [place, scenes] : places) maps[{join_scenes(scenes), place.first}].push_back(place.second);
  std::vector<std::string> texts;
  for (const auto& [where, sizes] : maps)
    texts.push_back(fmt::format("{}, picture {}, map {}", where.first, where.second, fmt::join(sizes, ", ")));
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace shadowbench::analysis
