#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/records.h"

namespace shadowbench::report {

/// Stands in a text for a value that does not exist.
inline constexpr const char* kNothing = "–";

/// Writes a number for people: three significant digits, no exponent where it can be helped.
std::string format_number(double value);

/// Writes a ratio for people: "1.09 [1.08, 1.1]".
std::string format_ratio(const std::optional<Ratio>& ratio);

/// Names the clock that a run's times come from: "CPU time (software rasteriser)".
std::string describe_clock(const GlRecord& gl);

/// Names the unit of a run's times where room is short: "ms (CPU)", "ms (GPU)",
/// "ms (GL timer)" or "ms".
std::string time_unit(const GlRecord& gl);

/// Lists parameters: "radius 4, store rg32f".
std::string describe_params(const ParamMap& params);

/// Says how well the map's texels are spent: "3.2 map texels per pixel (worst 0.4), 61 % of the map used"; empty where
/// that was not measured.
std::string describe_coverage(const CoverageRecord& coverage);

/// Lists what all cells of one table share: view, map, picture size, bias.
std::string describe_settings(const CellRecord& cell);

/// Are the cells of one scene, view, map, bias and picture size: what one table and one grid compare.
struct CellGroup {
  std::string scene;
  std::vector<CellRecord> cells;
};

/// Groups cells by what may be compared, in the order in which each group first appears.
std::vector<CellGroup> group_cells(const std::vector<CellRecord>& cells);

/// Names a cell of a group: its filter, with its parameters where the group holds that filter more than once.
std::string label_cell(const CellGroup& group, const CellRecord& cell);

/// Says how a cell ended: "ok", "timeout: no answer after 10 s".
std::string describe_status(const CellRecord& cell);

/// Ranks cells by their lookup, fastest first, as groups of indices into `cells` that are not ranked apart.
/// A cell joins the group of the fastest cell whose interval overlaps its own. The interval is the 95 % one of the
/// ratio to `none`; where a timed cell lacks it, all cells are ranked by their quartiles. Untimed cells are left out.
std::vector<std::vector<std::size_t>> rank_lookups(const std::vector<CellRecord>& cells);

/// Says in plain sentences what a group's numbers show: times, which are those of `gl`, accuracy, and what went wrong.
std::vector<std::string> describe_group(const CellGroup& group, const GlRecord& gl);

/// Lists the machine, the GL and the build, as name and value.
std::vector<std::pair<std::string, std::string>> list_run_facts(const RunRecord& run);

/// Counts, for every "field: reason" in the cells' `absent`, the cells that carry it.
std::map<std::string, int> count_absences(const std::vector<CellRecord>& cells);

}  // namespace shadowbench::report
