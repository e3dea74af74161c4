#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::records {

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
