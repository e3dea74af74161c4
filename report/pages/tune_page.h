#pragma once

#include <string>

#include "report/document/blocks.h"
#include "report/records/tuned_record.h"

namespace shadowbench::pages {

/// What unseen views make of a filter's found parameters, and what is kept therefore.
std::string describe_verdict(const records::TunedFilterRecord& filter, const std::string& metric);

/// Makes the page of `shadowbench tune`: what was tuned on what, and for every filter its parameters, scores, verdict
/// and good ranges.
document::Page make_tune_page(const records::TunedRecord& record);

}  // namespace shadowbench::pages
