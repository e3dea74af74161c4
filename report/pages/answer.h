#pragma once

#include <vector>

#include "report/analysis/advice.h"
#include "report/document/blocks.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// The limits that a run's page starts with: a moving light, and an RMSE of at most a quarter more than that of the
/// filter whose worst scene is the least wrong, or as much as three configurations keep to, rounded up. No limit where
/// no RMSE was measured.
analysis::AdviceRequest choose_request(const std::vector<records::CellRecord>& cells);

/// Says which filter and map keep those limits at the least cost, why, what the runner-up would buy, and what the
/// choice fails at. In the browser a script makes the same of limits that the reader moves.
document::Section make_answer_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                      const analysis::AdviceRequest& request);

}  // namespace shadowbench::pages
