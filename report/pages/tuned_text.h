#pragma once

#include <string>

#include "report/records/tuned_record.h"

namespace shadowbench::pages {

/// Makes tune.md: what was tuned on what, and for every filter its parameters, scores, verdict and good ranges.
std::string make_tuned_text(const records::TunedRecord& record);

/// Says what unseen views make of a filter's found parameters, and what is kept therefore.
std::string describe_verdict(const records::TunedFilterRecord& filter, const std::string& metric);

}  // namespace shadowbench::pages
