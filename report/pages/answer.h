#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "report/analysis/advice.h"
#include "report/document/blocks.h"
#include "report/records/bias_record.h"
#include "report/records/records.h"

namespace shadowbench::pages {

/// What a run's page asks first: no limit, a moving light, and analysis::choose_cost().
analysis::AdviceRequest choose_request(const std::vector<records::CellRecord>& cells);

/// Calls `use` with what the page of these cells advises first; not where it advises nothing, as of filters for
/// teaching alone.
void with_first_advice(const std::vector<records::CellRecord>& measured,
                       const std::function<void(const analysis::Advice&)>& use);

/// A cell whose picture a page shows first, and the part of it that is seen: left, top, width, height; pixels.
struct FirstPicture {
  std::string key;
  std::array<double, 4> part{};
};

/// Those that the page of these cells shows: one of each answer, where it differs most from the truth.
std::vector<FirstPicture> list_first_pictures(const std::vector<records::CellRecord>& measured);

/// Says which filters are fast, balanced and best, over all scenes and on each, at what cost and error and why, with
/// the grid of the scene with the largest error. In the browser a script makes the same of limits that the reader
/// moves. `biases`: what a sweep of the bias recommends, which has a row where it is of the filters and maps that are
/// named.
document::Section make_answer_section(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                                      const analysis::AdviceRequest& request,
                                      const std::vector<records::BiasCell>& biases);

}  // namespace shadowbench::pages
