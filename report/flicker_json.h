#pragma once

#include <string>

#include "report/flicker_record.h"

namespace shadowbench::report {

/// Makes the text of a flicker.json: `gl` and `machine` as in results.json.
std::string make_flicker_json(const FlickerRecord& record);

/// Makes flicker.csv (RFC 4180): one row per motion, snapping and filter.
std::string make_flicker_csv(const FlickerRecord& record);

}  // namespace shadowbench::report
