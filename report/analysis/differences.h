#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "report/analysis/front.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// Chooses cells, of one filter with its parameters.
using CellChoice = std::function<bool(const records::CellRecord&)>;

/// How much the RMSE of one filter is above another's, over all places where both were measured: the root mean squares
/// over these, subtracted as subtract() does. Nothing where there is no such place.
std::optional<Estimate> find_difference(const std::vector<records::CellRecord>& cells, const CellChoice& a,
                                        const CellChoice& b);

/// Says how small a difference between two filters' RMSEs a run can tell apart, with 95 % confidence and a power of
/// 80 %: of one class of width, in one place. Empty where no two cells have phases in common.
std::string describe_power(const std::vector<records::CellRecord>& cells);

}  // namespace shadowbench::analysis
