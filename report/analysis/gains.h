#pragma once

#include <optional>
#include <vector>

#include "report/analysis/configuration.h"
#include "report/analysis/front.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// The RMSE over cells of several places: the root of the mean square. Nothing where a cell has none,
/// or there is none.
std::optional<Estimate> combine_rmse(const std::vector<const records::CellRecord*>& cells);

/// Said of the places where the choice does not matter.
inline constexpr const char* kIdle = "every filter's FLIP is below 0.001";

/// Finds the places where the choice does not matter, as kIdle says. Where that is so everywhere, there is none.
std::vector<Place> list_idle_places(const std::vector<const records::CellRecord*>& cells);

}  // namespace shadowbench::analysis
