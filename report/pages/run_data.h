#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "report/analysis/advice.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// What the scripts of a run's page read: measures with their definitions, places, configurations with their costs, and
/// per cell its values, its pictures and why it is not ranked. The limits of `request` are those that the page starts
/// with. A value that does not exist is null; `nothing` of a cell names fields that have nothing to be measured on.
nlohmann::json make_run_data(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                             const analysis::AdviceRequest& request);

}  // namespace shadowbench::pages
