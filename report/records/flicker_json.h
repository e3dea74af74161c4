#pragma once

#include <string>

#include "report/records/flicker_record.h"

namespace shadowbench::records {

/// Makes the text of a flicker.json: `gl` and `machine` as in results.json.
std::string make_flicker_json(const FlickerRecord& record);

/// Makes flicker.csv (RFC 4180): one row per motion, snapping and filter.
std::string make_flicker_csv(const FlickerRecord& record);

}  // namespace shadowbench::records
