#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "report/records/records.h"

namespace shadowbench::records {

/// The parameters as they were asked for: one whose value the light's width gave is "light" everywhere.
ParamMap named_params(const CellRecord& cell);

/// Returns what identifies a cell: scene, view, filter, named parameters, map settings, bias, fit, light, range rule
/// and picture size; no results.
nlohmann::json cell_settings(const CellRecord& cell);

/// Returns the key of settings: 16 hexadecimal digits, the hash of their canonical JSON (sorted keys, no white space,
/// 4 and 4.0 alike). A caller with further settings adds them to what cell_settings() returns.
std::string cell_key(const nlohmann::json& settings);

/// Returns the key of cell_settings(cell); that of a row of another renderer is no filter's of the same name.
std::string cell_key(const CellRecord& cell);

/// Tells whether a text is a key: 16 digits 0-9, a-f.
bool is_cell_key(std::string_view text);

}  // namespace shadowbench::records
