#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/analysis/measures.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// Points to each of some cells, in their order. Requires that the cells outlive what is returned.
std::vector<const records::CellRecord*> point_to(const std::vector<records::CellRecord>& cells);

using CellList = std::vector<const records::CellRecord*>;

/// The pivot of everything that is compared: groups cells that agree in all settings but those named `free` ("filter",
/// "map_size"), in the order in which each group first appears.
std::vector<CellList> pivot(const CellList& cells, std::initializer_list<const char*> free);

/// Names what a filter is judged on: a scene, seen from one of its views.
struct Place {
  std::string scene;
  std::string view;
  bool operator==(const Place&) const = default;
};

/// Returns where a cell was measured.
Place place_of(const records::CellRecord& cell);

/// Lists where cells were measured, each place once, in the order in which they appear.
std::vector<Place> list_places(const std::vector<const records::CellRecord*>& cells);

/// The index of a cell's place; their number where it is none of them.
std::size_t find_place(const std::vector<Place>& places, const records::CellRecord& cell);

/// Names a place for people: its scene, and its view where the scene has several.
std::string describe_place(const Place& place, const std::vector<Place>& places);

/// The cells that differ in nothing but scene and view: what a renderer would choose as a whole.
struct Configuration {
  std::string name;                               ///< by records::CellNames
  std::string surroundings;                       ///< canonical settings without filter and parameters
  std::vector<const records::CellRecord*> cells;  ///< in the order of the run; never empty
};

/// Groups cells into configurations, in the order in which each first appears; no two have one name.
/// Requires that the cells outlive what is returned.
std::vector<Configuration> list_configurations(const std::vector<const records::CellRecord*>& cells);

/// The width of its kernel as records::describe_kernel(), or the range of its widths where the light chose them.
std::string describe_kernel(const Configuration& configuration);

/// The cells of one scene, view, map, bias and picture size: what one table and one grid compare.
struct CellGroup {
  std::string scene;
  std::vector<records::CellRecord> cells;
  records::CellNames names = records::CellNames({});  ///< of the cells
};

/// Groups cells by what may be compared, in the order in which each group first appears.
std::vector<CellGroup> group_cells(const std::vector<records::CellRecord>& cells);

/// A copy of the cells without those that other renderers drew, which have no cost here, and are in no trade. Nothing
/// where there are none.
std::optional<std::vector<records::CellRecord>> leave_out_external(const std::vector<records::CellRecord>& cells);

/// Whether several kinds of machine measured the cells, so that their times do not compare.
bool mixes_machines(const std::vector<records::CellRecord>& cells);

/// A copy of the cells without times where mixes_machines(); `absent` says why. Nothing where one kind measured them.
std::optional<std::vector<records::CellRecord>> withhold_mixed_times(const std::vector<records::CellRecord>& cells);

/// The class of a cell's kernel, an index into filters::list_width_names(); empty where it has none.
std::optional<std::size_t> find_class(const records::CellRecord& cell);

/// The name of a class; empty without one.
std::string name_class(std::optional<std::size_t> width_class);

/// How far a cell's RMSE may be off: half the width of its 95 % interval over the phases of the map's grid, or the
/// truth's standard error where the run has one phase; 0 where neither is known.
double find_rmse_reach(const records::CellRecord& cell);

/// A cell's RMSE with that reach and its groups of phases. Requires one.
Estimate estimate_rmse(const records::CellRecord& cell);

/// Finds the part that alone is more than half of an error, as an index into list_error_parts().
std::optional<std::size_t> find_dominating_part(const records::PartShares& shares);

/// Whether a cell's RMSE is at most the standard error of its truth; false where either is unknown.
bool is_lost_in_truth(const records::CellRecord& cell);

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
