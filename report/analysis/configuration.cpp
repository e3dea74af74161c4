#include "report/analysis/configuration.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/split_list.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::analysis {
namespace {

constexpr std::string_view kSeparator = " · ";  // of records::describe_settings()

// What is true of every scene: without the view, and without lengths in the units of one scene's map.
std::vector<std::string> describe_parts(records::CellRecord cell) {
  cell.map_scale = {};
  std::vector<std::string> parts = split_list(records::describe_settings(cell), kSeparator);
  parts.erase(parts.begin());
  return parts;
}

// Counts how many configurations share what a label may name.
struct Census {
  std::map<std::string, std::size_t> filters;
  std::map<std::string, std::size_t> params;    ///< by param_key()
  std::map<std::string, std::size_t> settings;  ///< by the text of describe_parts()
};

std::string param_key(const records::CellRecord& cell, const std::string& name) {
  return fmt::format("{} {}", cell.filter, records::describe_params({{name, cell.params.at(name)}}));
}

Census take_census(const std::vector<Configuration>& all) {
  Census census;
  for (const Configuration& configuration : all) {
    const records::CellRecord& cell = *configuration.cells.front();
    ++census.filters[cell.filter];
    for (const auto& [name, value] : cell.params) ++census.params[param_key(cell, name)];
    for (const std::string& part : describe_parts(cell)) ++census.settings[part];
  }
  return census;
}

// Settings are named only where not every configuration has them; with `always_map` the map always is.
std::string make_label(const records::CellRecord& cell, const Census& census, std::size_t configurations,
                       bool always_map) {
  records::ParamMap varying;
  for (const auto& [name, value] : cell.params)
    if (census.params.at(param_key(cell, name)) < census.filters.at(cell.filter)) varying[name] = value;
  std::string label = cell.filter;
  if (!varying.empty()) label += fmt::format(" ({})", records::describe_params(varying));
  const std::vector<std::string> parts = describe_parts(cell);
  for (const std::string& part : parts)
    if ((always_map && part == parts.front()) || census.settings.at(part) < configurations) label += ", " + part;
  return label;
}

void set_labels(std::vector<Configuration>& all) {
  const Census census = take_census(all);
  std::map<std::string, int> uses;
  for (Configuration& configuration : all) {
    configuration.label = make_label(*configuration.cells.front(), census, all.size(), true);
    configuration.name = make_label(*configuration.cells.front(), census, all.size(), false);
    ++uses[configuration.label];
  }
  for (Configuration& configuration : all)
    if (uses[configuration.label] > 1)
      for (std::string* text : {&configuration.label, &configuration.name})
        *text += ", as cell " + configuration.cells.front()->key;
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
      configurations.push_back({"", "", records::dump_line(settings), {}});
    }
    configurations[index->second].cells.push_back(cell);
  }
  set_labels(configurations);
  return configurations;
}

}  // namespace shadowbench::analysis
