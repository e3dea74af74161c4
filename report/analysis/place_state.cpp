#include "report/analysis/place_state.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/analysis/cell_group.h"
#include "report/analysis/trade_measures.h"

namespace shadowbench::analysis {
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
