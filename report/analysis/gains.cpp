#include "report/analysis/gains.h"

#include <algorithm>

#include "report/analysis/cell_group.h"
#include "report/analysis/trade_measures.h"

namespace shadowbench::analysis {
namespace {

constexpr double kSeenFlip = 0.001;  // as kIdle says

}  // namespace

std::optional<Estimate> combine_rmse(const std::vector<const records::CellRecord*>& cells) {
  std::vector<Estimate> estimates;
  for (const records::CellRecord* cell : cells) {
    if (!cell->error.rmse) return std::nullopt;
    estimates.push_back(estimate_rmse(*cell));
  }
  return estimates.empty() ? std::nullopt : std::optional(list_error_measures().front().combine(estimates));
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
