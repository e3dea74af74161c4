#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "report/analysis/advice.h"

namespace shadowbench::pages {

/// Writes an advice for people: the first line is the answer, then its evidence. At most 100 columns where labels and
/// names allow.
std::string make_advice_text(const records::RunRecord& run, const analysis::Advice& advice);

/// The answer alone: the sentence, then fast, balanced and best, a line each. Some configuration must be left.
std::string make_answer_text(const records::RunRecord& run, const analysis::Advice& advice);

/// Writes an advice as JSON, with the same fields every time. What cells have is in results.json, under their keys.
nlohmann::json make_advice_json(const records::RunRecord& run, const analysis::Advice& advice);

}  // namespace shadowbench::pages
