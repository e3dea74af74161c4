#pragma once

#include <string>
#include <string_view>

#include "report/records/records.h"

namespace shadowbench::records {

/// The beginning of the reason of a value that has nothing to be measured on, since its fault cannot occur there: that
/// is not a value that nobody measured. Readers of results.json find it in `absent`.
inline constexpr std::string_view kNothingToSee = "nothing to see: ";

/// Makes such a reason; `why` says what there is too little of.
inline std::string explain_nothing_to_see(std::string_view why) {
  return std::string(kNothingToSee) + std::string(why);
}

/// Whether a reason of `absent` begins like that.
inline bool is_nothing_to_see(std::string_view reason) { return reason.starts_with(kNothingToSee); }

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
