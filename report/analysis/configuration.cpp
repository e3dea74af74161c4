#include "report/analysis/configuration.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "report/records/cell_key.h"
#include "report/records/cell_names.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

void set_names(std::vector<Configuration>& all) {
  const auto first = [](const Configuration& each) { return each.cells.front(); };
  std::vector<const records::CellRecord*> cells;
  std::ranges::transform(all, std::back_inserter(cells), first);
  const records::CellNames names(cells);
  std::map<std::string, int> uses;
  for (Configuration& configuration : all) {
    configuration.name = names.name(*first(configuration));
    ++uses[configuration.name];
  }
  for (Configuration& configuration : all)
    if (uses[configuration.name] > 1) configuration.name += ", as cell " + first(configuration)->key;
}

}  // namespace

std::vector<const records::CellRecord*> point_to(const std::vector<records::CellRecord>& cells) {
  std::vector<const records::CellRecord*> pointers;
  for (const records::CellRecord& cell : cells) pointers.push_back(&cell);
  return pointers;
}

Place place_of(const records::CellRecord& cell) { return {cell.scene, cell.view}; }

std::vector<Place> list_places(const std::vector<const records::CellRecord*>& cells) {
  std::vector<Place> places;
  for (const records::CellRecord* cell : cells)
    if (std::find(places.begin(), places.end(), place_of(*cell)) == places.end()) places.push_back(place_of(*cell));
  return places;
}

std::size_t find_place(const std::vector<Place>& places, const records::CellRecord& cell) {
  return static_cast<std::size_t>(std::ranges::find(places, place_of(cell)) - places.begin());
}

std::string describe_place(const Place& place, const std::vector<Place>& places) {
  const auto views =
      std::count_if(places.begin(), places.end(), [&](const Place& p) { return p.scene == place.scene; });
  return views > 1 ? fmt::format("{} ({})", place.scene, place.view) : place.scene;
}

std::vector<Configuration> list_configurations(const std::vector<const records::CellRecord*>& cells) {
  std::vector<Configuration> configurations;
  std::map<std::string, std::size_t> indices;
  for (const records::CellRecord* cell : cells) {
    auto settings = records::cell_settings(*cell);
    settings.erase("scene");
    settings.erase("view");
    const auto [index, is_new] = indices.emplace(records::dump_line(settings), configurations.size());
    if (is_new) {
      settings.erase("filter");
      settings.erase("params");
      configurations.push_back({"", records::dump_line(settings), {}});
    }
    configurations[index->second].cells.push_back(cell);
  }
  set_names(configurations);
  return configurations;
}

std::string describe_kernel(const Configuration& configuration) {
  const auto sigma_of = [](const records::CellRecord* cell) { return cell->kernel.sigma_texels; };
  const auto [narrowest, widest] = std::ranges::minmax_element(configuration.cells, {}, sigma_of);
  if (sigma_of(*narrowest) == sigma_of(*widest)) return records::describe_kernel((*widest)->kernel);
  return fmt::format("{} .. {}", records::format_number(sigma_of(*narrowest)),
                     records::describe_kernel((*widest)->kernel));
}

}  // namespace shadowbench::analysis
