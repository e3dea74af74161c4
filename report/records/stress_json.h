#pragma once

#include <string>

#include "report/records/stress_record.h"

namespace shadowbench::records {

/// Makes the text of a stress.json: `gl` and `machine` as in results.json; a value that does not exist is null.
std::string make_stress_json(const StressRecord& record);

/// Makes stress.csv (RFC 4180): one row per observation, and one per case that was not available; what does not exist
/// is empty.
std::string make_stress_csv(const StressRecord& record);

}  // namespace shadowbench::records
