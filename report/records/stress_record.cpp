#include "report/records/stress_record.h"

#include <fmt/format.h>

#include <algorithm>

namespace shadowbench::records {

std::string label_of(const StressCase& item) {
  const std::string filter = item.filter.empty() ? std::string() : item.filter + ": ";
  return fmt::format("{}{} ({})", filter, item.variant, item.level);
}

const char* name_of(StressVerdict verdict) {
  if (verdict == StressVerdict::kOk) return "ok";
  return verdict == StressVerdict::kDegraded ? "degraded" : "broken";
}

const char* name_of(StressTheoryKind kind) {
  switch (kind) {
    case StressTheoryKind::kOverflow: return "overflow";
    case StressTheoryKind::kQuantum: return "quantum";
    case StressTheoryKind::kSlope: return "slope";
    case StressTheoryKind::kRounding: return "rounding";
  }
  return "";
}

const char* name_of(StressAgreement agreement) {
  if (agreement == StressAgreement::kAgrees) return "agrees";
  return agreement == StressAgreement::kExplained ? "explained" : "disagrees";
}

double tolerance_of(StressTheoryKind kind) { return kind == StressTheoryKind::kRounding ? 8.0 : 1.1; }

const StressOnset* find_onset(const StressCase& item, StressVerdict verdict) {
  if (verdict == StressVerdict::kDegraded && item.degraded) return &*item.degraded;
  return item.broken ? &*item.broken : nullptr;
}

int count_disagreements(const StressRecord& record) {
  int count = 0;
  for (const StressAxis& axis : record.axes)
    for (const StressCase& item : axis.cases)
      count += static_cast<int>(std::ranges::count(item.limits, StressAgreement::kDisagrees, &StressLimit::agreement));
  return count;
}

}  // namespace shadowbench::records
