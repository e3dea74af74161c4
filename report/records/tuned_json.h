#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/records/tuned_record.h"

namespace shadowbench::records {

/// Names the schema that tuned.json follows.
inline constexpr int kTunedSchemaVersion = 1;

/// Makes the text of a tuned.json: settings, and for every filter its parameters, their good ranges and all scores.
std::string make_tuned_json(const TunedRecord& record);

/// What a run takes from a tuned.json.
struct TunedSettings {
  struct Filter {
    std::string id;
    ParamMap params;  ///< not checked against the filter
  };
  std::string metric;
  int map_size = 0;
  std::vector<Filter> filters;  ///< each id once
};

/// Reads a tuned.json.
/// Throws Error(kInput), with file and field, where it is missing, malformed or of another schema version.
TunedSettings read_tuned_settings(const std::filesystem::path& file);

}  // namespace shadowbench::records
