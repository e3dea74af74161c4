#pragma once

#include <algorithm>
#include <string>

#include "report/records/records.h"

namespace shadowbench::records {

/// Why a value is absent.
struct Absence {
  std::string why;
  bool nothing_to_see = false;  ///< its fault cannot occur in the view: that is not a value that nobody measured
};

/// Says why a field, or a group of them, is absent.
inline void explain(CellRecord& cell, const std::string& field, const Absence& absence) {
  cell.absent[field] = absence.why;
  if (absence.nothing_to_see) cell.nothing_to_see.push_back(field);
}

/// Whether the fault that a field measures cannot occur in the cell's view.
inline bool has_nothing_to_see(const CellRecord& cell, std::string field) {
  for (;; field.resize(field.rfind('.'))) {
    if (cell.absent.contains(field)) return std::ranges::count(cell.nothing_to_see, field) > 0;
    if (field.find('.') == std::string::npos) return false;
  }
}

/// Why a cell lacks a value: what `absent` holds for the field, for a group that it is in, or for a part of it;
/// "not measured" where it holds nothing.
inline std::string explain_absence(const CellRecord& cell, const std::string& field) {
  for (std::string name = field;; name.resize(name.rfind('.'))) {
    if (const auto found = cell.absent.find(name); found != cell.absent.end()) return found->second;
    if (name.find('.') == std::string::npos) break;
  }
  const auto part = cell.absent.lower_bound(field + ".");
  return part != cell.absent.end() && part->first.starts_with(field + ".") ? part->second : "not measured";
}

}  // namespace shadowbench::records
