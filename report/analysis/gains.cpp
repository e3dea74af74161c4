#include "report/analysis/gains.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "report/analysis/cell_group.h"
#include "report/analysis/trade_measures.h"

namespace shadowbench::analysis {
namespace {

constexpr double kSeenFlip = 0.001;  // as kIdle says
constexpr const char* kReference = "none";

}  // namespace

std::optional<Estimate> combine_rmse(const std::vector<const records::CellRecord*>& cells) {
  std::vector<Estimate> estimates;
  for (const records::CellRecord* cell : cells) {
    if (!cell->error.rmse) return std::nullopt;
    estimates.push_back(estimate_rmse(*cell));
  }
  return estimates.empty() ? std::nullopt : std::optional(list_error_measures().front().combine(estimates));
}

std::vector<std::optional<bool>> find_gains(const std::vector<Configuration>& configurations,
                                            const std::vector<const records::CellRecord*>& cells) {
  using Key = std::tuple<std::string, std::string, std::string>;
  std::map<Key, const records::CellRecord*> references;
  for (const Configuration& each : list_configurations(cells))
    for (const records::CellRecord* cell : each.cells)
      if (cell->filter == kReference) references[{each.surroundings, cell->scene, cell->view}] = cell;
  std::vector<std::optional<bool>> gains;
  for (const Configuration& each : configurations) {
    std::vector<const records::CellRecord*> own;
    for (const records::CellRecord* cell : each.cells)
      if (const auto found = references.find({each.surroundings, cell->scene, cell->view}); found != references.end())
        own.push_back(found->second);
    const auto rmse = combine_rmse(each.cells);
    const auto reference = own.size() == each.cells.size() ? combine_rmse(own) : std::nullopt;
    gains.push_back(rmse && reference ? std::optional(is_clearly_less_error(*rmse, *reference)) : std::nullopt);
  }
  return gains;
}

std::vector<Place> list_idle_places(const std::vector<const records::CellRecord*>& cells) {
  const std::vector<Place> places = list_places(cells);
  std::vector<Place> idle;
  for (const Place& place : places) {
    const auto is_seen = [&](const records::CellRecord* cell) {
      return place_of(*cell) == place && !(cell->error.flip && *cell->error.flip < kSeenFlip);
    };
    if (std::ranges::none_of(cells, is_seen)) idle.push_back(place);
  }
  return idle.size() < places.size() ? idle : std::vector<Place>();
}

}  // namespace shadowbench::analysis
