#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/analysis/configuration.h"
#include "report/analysis/front.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// Whether the choice of a filter matters at a place, the most it may first.
enum class PlaceState {
  kMatters,   ///< a filter's picture differs from the truth's where light and shadow meet, or nobody knows
  kIdle,      ///< no filter's does
  kUnlit,     ///< not tested: no receiver in view sees the light
  kEdgeless,  ///< not tested: no receiver in view is at a penumbra
};

/// A place that an answer does not count, and why.
struct LeftOutPlace {
  Place place;
  PlaceState state;
  bool operator==(const LeftOutPlace&) const = default;

  bool is_tested() const { return state == PlaceState::kIdle; }
};

/// Judges a place by the cells that were measured there: by the FLIP that a filter's picture has for each receiver in
/// or beside a penumbra. A mean over the picture would call any small shadow unimportant.
PlaceState judge_place(const std::vector<const records::CellRecord*>& cells, const Place& place);

/// Lists the places that say nothing of which filter is better: those that were not tested, and those where the choice
/// does not matter, unless there are no others.
std::vector<LeftOutPlace> list_left_out(const std::vector<const records::CellRecord*>& cells);

bool is_left_out(const records::CellRecord& cell, const std::vector<LeftOutPlace>& left_out);

/// Names a state for people: "not tested: no receiver in view sees it".
std::string describe_state(PlaceState state);

}  // namespace shadowbench::analysis
