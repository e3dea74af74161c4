#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// Names one of the fits that a run has: "tight fit", "4 cascades". Of cascades what differs between `fits` follows:
/// "4 cascades, split 1".
std::string name_fit(const std::string& fit, const std::set<std::string>& fits);

/// The same as a part of a file's name: "4-cascades-split-1".
std::string make_fit_stem(const std::string& fit, const std::set<std::string>& fits);

/// Names cells by their filter and by what differs among them, but for scene and view: "vsm (radius 4), 4 cascades".
/// Pages, the terminal, grids and files take their short names from here.
class CellNames {
 public:
  /// `cells`: one of each that is to be told apart.
  explicit CellNames(const std::vector<const CellRecord*>& cells);

  /// Requires that the cell is one of those, or differs from one in scene and view alone.
  std::string name(const CellRecord& cell) const;

 private:
  using Settings = std::vector<std::pair<std::string, std::string>>;  // what, and its value in words

  std::string name_filter(const CellRecord& cell) const;  // with the parameters in which its cells differ
  Settings list_settings(const CellRecord& cell) const;

  std::set<std::string> fits_;
  std::map<std::string, std::set<std::string>> params_;  ///< by filter and parameter, the values
  std::map<std::string, std::set<std::string>> values_;  ///< by setting
};

}  // namespace shadowbench::records
