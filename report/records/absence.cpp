#include "report/records/absence.h"

namespace shadowbench::records {

std::string explain_nothing_to_see(std::string_view why) { return std::string(kNothingToSee) + std::string(why); }

bool is_nothing_to_see(std::string_view reason) { return reason.starts_with(kNothingToSee); }

std::string explain_absence(const CellRecord& cell, const std::string& field) {
  for (std::string name = field;; name.resize(name.rfind('.'))) {
    if (const auto found = cell.absent.find(name); found != cell.absent.end()) return found->second;
    if (name.find('.') == std::string::npos) break;
  }
  const auto part = cell.absent.lower_bound(field + ".");
  return part != cell.absent.end() && part->first.starts_with(field + ".") ? part->second : "not measured";
}

}  // namespace shadowbench::records
