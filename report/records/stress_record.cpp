#include "report/records/stress_record.h"

#include <fmt/format.h>

#include <algorithm>

#include "report/records/csv_tables.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

namespace shadowbench::records {

std::string label_of(const StressCase& item) {
  const std::string filter = item.filter.empty() ? std::string() : item.filter + ": ";
  return fmt::format("{}{} ({})", filter, item.variant, item.level);
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

void visit_fields(const StressSample& sample, auto&& visit) {
  visit("value", sample.value);
  visit("verdict", sample.verdict);
  visit("measured", sample.measured);
  visit("why", null_if_empty(sample.why));
}

void visit_fields(const StressOnset& onset, auto&& visit) {
  visit("value", onset.value);
  visit("last_before", onset.last_before);
  visit("why", null_if_empty(onset.why));
}

void visit_fields(const StressLimit& limit, auto&& visit) {
  visit("predicts", limit.predicts);
  visit("kind", limit.kind);
  visit("theory", limit.onset);
  visit("formula", limit.formula);
  visit("source", limit.source);
  visit("measured", limit.measured);
  visit("ratio", limit.ratio);
  visit("tolerance", tolerance_of(limit.kind));
  visit("agreement", limit.agreement);
  visit("explanation", null_if_empty(limit.explanation));
}

void visit_fields(const StressCase& item, auto&& visit) {
  visit("filter", null_if_empty(item.filter));
  visit("variant", item.variant);
  visit("level", item.level);
  visit("params", item.params);
  visit("not_available", null_if_empty(item.not_available));
  visit("samples", item.samples);
  visit("degraded", item.degraded);
  visit("broken", item.broken);
  visit("limits", item.limits);
  visit("notes", item.notes);
}

void visit_fields(const StressAxis& axis, auto&& visit) {
  visit("id", axis.id);
  visit("title", axis.title);
  visit("quantity", axis.quantity);
  visit("unit", axis.unit);
  visit("scale", std::string(axis.log ? "log" : "linear"));
  visit("range", axis.range);
  visit("measured", axis.measured);
  visit("measured_unit", axis.measured_unit);
  visit("bound", axis.bound);
  visit("broken_when", axis.broken_when);
  visit("cases", axis.cases);
}

std::string make_stress_json(const StressRecord& record) {
  return dump_file({{"schema_version", kStressSchemaVersion},
                    {"commit", record.commit},
                    {"gl", value_json(record.gl)},
                    {"machine", value_json(record.machine)},
                    {"seed", record.seed},
                    {"command", record.command},
                    {"seconds", record.seconds},
                    {"filters", record.filters},
                    {"disagreements", count_disagreements(record)},
                    {"axes", value_json(record.axes)}});
}

std::string make_stress_csv(const StressRecord& record) {
  TextTable table{{"axis", "filter", "variant", "level", "value", "verdict", "measured", "why"}, {}};
  for (const StressAxis& axis : record.axes) {
    for (const StressCase& item : axis.cases) {
      const auto add = [&](const std::string& value, const char* verdict, const std::optional<double>& measured,
                           const std::string& why) {
        table.rows.push_back({axis.id, item.filter, item.variant, item.level, value, verdict,
                              measured ? fmt::format("{}", *measured) : std::string(), why});
      };
      if (!item.not_available.empty()) add("", "not available", {}, item.not_available);
      for (const StressSample& sample : item.samples)
        add(fmt::format("{}", sample.value), name_of(sample.verdict), sample.measured, sample.why);
    }
  }
  return make_csv(table);
}

}  // namespace shadowbench::records
