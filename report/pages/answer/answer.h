#pragma once

#include <string>
#include <vector>

#include "report/analysis/advice.h"
#include "report/document/blocks.h"
#include "report/records/bias_record.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// What a run's page asks first: no limit, a moving light, and analysis::choose_cost().
analysis::AdviceRequest choose_request(const std::vector<records::CellRecord>& cells);

/// The keys of the cells whose pictures the page of these cells shows first: one of each answer, where it differs most
/// from the truth.
std::vector<std::string> list_first_pictures(const std::vector<records::CellRecord>& measured);

/// Says which filters are fast, balanced and best, over all scenes and on each, at what cost and error and why, with a
/// picture of one beside the truth. In the browser a script makes the same of limits that the reader moves.
/// `biases`: what a sweep of the bias recommends, which has a row where it is of the filters and maps that are named.
document::Section make_answer_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                      const analysis::AdviceRequest& request,
                                      const std::vector<records::BiasToShip>& biases);

}  // namespace shadowbench::pages
