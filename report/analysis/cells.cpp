#include "report/analysis/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "filters/kernel.h"
#include "report/analysis/measures.h"
#include "report/records/cell_key.h"
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

std::vector<CellList> pivot(const CellList& cells, std::initializer_list<const char*> free) {
  std::vector<CellList> groups;
  std::map<std::string, std::size_t> places;
  for (const records::CellRecord* cell : cells) {
    auto settings = records::cell_settings(*cell);
    for (const char* name : free) settings.erase(name);
    const auto [place, is_new] = places.emplace(records::dump_line(settings), groups.size());
    if (is_new) groups.emplace_back();
    groups[place->second].push_back(cell);
  }
  return groups;
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
  for (CellList& own : pivot(cells, {"scene", "view"})) {
    auto surroundings = records::cell_settings(*own.front());
    for (const char* name : {"scene", "view", "filter", "params"}) surroundings.erase(name);
    configurations.push_back({"", records::dump_line(surroundings), std::move(own)});
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

namespace {

constexpr double kDominatingShare = 0.5;

double truth_se(const records::CellRecord& cell) { return cell.truth.se.value_or(0.0); }

// Indices of the parts, largest share first.
std::array<std::size_t, metrics::kErrorParts> order_parts(const records::PartShares& shares) {
  std::array<std::size_t, metrics::kErrorParts> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return shares[a] > shares[b]; });
  return order;
}

}  // namespace

std::vector<CellGroup> group_cells(const std::vector<records::CellRecord>& cells) {
  std::vector<CellGroup> groups;
  for (const CellList& own : pivot(point_to(cells), {"filter", "params"})) {
    CellGroup& group = groups.emplace_back(CellGroup{own.front()->scene, {}, records::CellNames(own)});
    for (const records::CellRecord* cell : own) group.cells.push_back(*cell);
  }
  return groups;
}

std::optional<std::vector<records::CellRecord>> leave_out_external(const std::vector<records::CellRecord>& cells) {
  const auto is_external = [](const records::CellRecord& cell) { return cell.external.has_value(); };
  if (std::ranges::none_of(cells, is_external)) return std::nullopt;
  std::vector<records::CellRecord> own = cells;
  std::erase_if(own, is_external);
  return own;
}

bool mixes_machines(const std::vector<records::CellRecord>& cells) {
  return std::ranges::any_of(
      cells, [&](const records::CellRecord& cell) { return cell.machine != cells.front().machine; });
}

std::optional<std::vector<records::CellRecord>> withhold_mixed_times(const std::vector<records::CellRecord>& cells) {
  if (!mixes_machines(cells)) return std::nullopt;
  std::vector<records::CellRecord> without = cells;
  for (records::CellRecord& cell : without) {
    std::erase_if(cell.absent, [](const auto& entry) { return entry.first.starts_with("time_ms"); });
    cell.time_ms = {};
    cell.absent["time_ms"] = "several kinds of machine measured the run, whose times do not compare";
  }
  return without;
}

std::optional<std::size_t> find_class(const records::CellRecord& cell) {
  const std::vector<std::string> names = filters::list_width_names();
  const auto found = std::ranges::find(names, cell.kernel.width_class.value_or(""));
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::string name_class(std::optional<std::size_t> width_class) {
  return width_class ? filters::list_width_names()[*width_class] : std::string();
}

double find_rmse_reach(const records::CellRecord& cell) {
  return cell.rmse_ci95 ? 0.5 * (cell.rmse_ci95->high - cell.rmse_ci95->low) : truth_se(cell);
}

Estimate estimate_rmse(const records::CellRecord& cell) {
  const double value = *cell.error.rmse, reach = find_rmse_reach(cell);
  return {value, std::max(0.0, value - reach), value + reach, cell.rmse_replicates.value_or(std::vector<double>())};
}

std::optional<std::size_t> find_dominating_part(const records::PartShares& shares) {
  const auto order = order_parts(shares);
  const bool one_is = shares[order[0]] > kDominatingShare && shares[order[1]] <= kDominatingShare;
  return one_is ? std::optional(order[0]) : std::nullopt;
}

bool is_lost_in_truth(const records::CellRecord& cell) {
  return cell.error.rmse && cell.truth.se && *cell.error.rmse <= *cell.truth.se;
}

namespace {

constexpr double kSeenFlip = 0.01;  // per receiver at a penumbra

/// What one cell says of its place; nothing where it has no truth.
std::optional<PlaceState> judge_cell(const records::CellRecord& cell) {
  if (cell.receivers == 0 || cell.truth.lit == 0) return PlaceState::kUnlit;
  if (cell.truth.penumbra == 0) return PlaceState::kEdgeless;
  if (!cell.truth.penumbra || !cell.error.flip) return std::nullopt;
  const double sum = *cell.error.flip * cell.width * cell.height;
  return sum < kSeenFlip * static_cast<double>(*cell.truth.penumbra) ? PlaceState::kIdle : PlaceState::kMatters;
}

}  // namespace

PlaceState judge_place(const std::vector<const records::CellRecord*>& cells, const Place& place) {
  std::optional<PlaceState> known;  // of the cells that say something, that which matters most
  bool any_unknown = false;
  for (const records::CellRecord* cell : cells) {
    if (place_of(*cell) != place) continue;
    const std::optional<PlaceState> own = judge_cell(*cell);
    any_unknown = any_unknown || !own;
    if (own) known = std::min(*own, known.value_or(*own));
  }
  const bool may_matter = !known || (*known == PlaceState::kIdle && any_unknown);
  return may_matter ? PlaceState::kMatters : *known;
}

std::vector<LeftOutPlace> list_left_out(const std::vector<const records::CellRecord*>& cells) {
  std::vector<LeftOutPlace> left_out;
  bool any_matters = false;
  for (const Place& place : list_places(cells)) {
    const PlaceState state = judge_place(cells, place);
    any_matters = any_matters || state == PlaceState::kMatters;
    if (state != PlaceState::kMatters) left_out.push_back({place, state});
  }
  if (!any_matters) std::erase_if(left_out, &LeftOutPlace::is_tested);
  return left_out;
}

bool is_left_out(const records::CellRecord& cell, const std::vector<LeftOutPlace>& left_out) {
  return std::ranges::count(left_out, place_of(cell), &LeftOutPlace::place) > 0;
}

std::string describe_state(PlaceState state) {
  switch (state) {
    case PlaceState::kMatters: return "matters";
    case PlaceState::kIdle:
      return fmt::format("does not matter: every filter's FLIP is below {} per receiver at a penumbra", kSeenFlip);
    case PlaceState::kUnlit: return "not tested: no receiver in view sees it";
    case PlaceState::kEdgeless: return "not tested: no edge of its shadows is in view";
  }
  return {};
}

}  // namespace shadowbench::analysis
