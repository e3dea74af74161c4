#include "report/records/stress_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/records/csv.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

using nlohmann::json;

json optional_json(const std::optional<double>& value) { return value ? json(*value) : json(); }

json text_or_null(const std::string& text) { return text.empty() ? json() : json(text); }

json to_json(const StressSample& sample) {
  return {{"value", sample.value},
          {"verdict", name_of(sample.verdict)},
          {"measured", optional_json(sample.measured)},
          {"why", text_or_null(sample.why)}};
}

json to_json(const std::optional<StressOnset>& onset) {
  if (!onset) return {};
  return {
      {"value", onset->value}, {"last_before", optional_json(onset->last_before)}, {"why", text_or_null(onset->why)}};
}

json to_json(const StressLimit& limit) {
  return {{"predicts", name_of(limit.predicts)},
          {"kind", name_of(limit.kind)},
          {"theory", optional_json(limit.onset)},
          {"formula", limit.formula},
          {"source", limit.source},
          {"measured", optional_json(limit.measured)},
          {"ratio", optional_json(limit.ratio)},
          {"tolerance", tolerance_of(limit.kind)},
          {"agreement", name_of(limit.agreement)},
          {"explanation", text_or_null(limit.explanation)}};
}

json to_json(const StressExhibit& exhibit) {
  json result = {{"id", exhibit.id},
                 {"title", exhibit.title},
                 {"sentences", exhibit.sentences},
                 {"table", nullptr},
                 {"pictures", json::array()}};
  if (exhibit.table) result["table"] = {{"header", exhibit.table->header}, {"rows", exhibit.table->rows}};
  for (const StressExhibit::Picture& picture : exhibit.pictures)
    result["pictures"].push_back({{"file", picture.file}, {"caption", picture.caption}});
  return result;
}

json to_json(const StressCase& item);
json to_json(const StressAxis& axis);

json to_json(const StressCase& item) {
  return {{"filter", text_or_null(item.filter)},
          {"variant", item.variant},
          {"level", item.level},
          {"params", value_json(item.params)},
          {"not_available", text_or_null(item.not_available)},
          {"samples", list_json(item.samples, to_json)},
          {"degraded", to_json(item.degraded)},
          {"broken", to_json(item.broken)},
          {"limits", list_json(item.limits, to_json)},
          {"notes", item.notes}};
}

json to_json(const StressAxis& axis) {
  return {{"id", axis.id},
          {"title", axis.title},
          {"quantity", axis.quantity},
          {"unit", axis.unit},
          {"scale", axis.log ? "log" : "linear"},
          {"range", {axis.range.low, axis.range.high}},
          {"measured", axis.measured},
          {"measured_unit", axis.measured_unit},
          {"bound", axis.bound},
          {"broken_when", axis.broken_when},
          {"cases", list_json(axis.cases, to_json)},
          {"exhibits", list_json(axis.exhibits, to_json)}};
}

std::string optional_field(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : std::string();
}

}  // namespace

std::string make_stress_json(const StressRecord& record) {
  RunRecord run;
  run.gl = record.gl;
  run.machine = record.machine;
  const json head = records::to_json(run);
  const json result = {{"schema_version", kStressSchemaVersion},
                       {"commit", record.commit},
                       {"gl", head.at("gl")},
                       {"machine", head.at("machine")},
                       {"seed", record.seed},
                       {"command", record.command},
                       {"filters", record.filters},
                       {"seconds", record.seconds},
                       {"disagreements", count_disagreements(record)},
                       {"axes", list_json(record.axes, to_json)}};
  return result.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string make_stress_csv(const StressRecord& record) {
  std::string csv = "axis,filter,variant,level,value,verdict,measured,why\r\n";
  for (const StressAxis& axis : record.axes) {
    for (const StressCase& item : axis.cases) {
      const std::string head =
          fmt::format("{},{},{},{}", axis.id, quote_csv(item.filter), quote_csv(item.variant), item.level);
      if (!item.not_available.empty())
        csv += fmt::format("{},,not available,,{}\r\n", head, quote_csv(item.not_available));
      for (const StressSample& sample : item.samples) {
        csv += fmt::format("{},{},{},{},{}\r\n", head, sample.value, name_of(sample.verdict),
                           optional_field(sample.measured), quote_csv(sample.why));
      }
    }
  }
  return csv;
}

}  // namespace shadowbench::records
