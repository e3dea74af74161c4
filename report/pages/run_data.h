#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "report/analysis/advice.h"
#include "report/records/bias_record.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// What the scripts of a run's page read: measures with their definitions, places, configurations with their costs and
/// their worst values, per cell its values and its pictures, and what advise() says without limits for every light and
/// class of width: scripts compare worst values with the limits that the reader moves, and judge nothing else. `biases`
/// are what a sweep of the bias recommends. A value that does not exist is null.
nlohmann::json make_run_data(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                             const std::vector<records::BiasToShip>& biases = {});

}  // namespace shadowbench::pages
