#include <nlohmann/json.hpp>

#include "reference/metrics/metric_table.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

namespace shadowbench::records {

extern const char* const kSchemaFrame;  // results.schema.json.in, which the build embeds

namespace {

using nlohmann::ordered_json;

ordered_json describe_metric(const metrics::Metric& metric) {
  ordered_json schema = {{"description", metric.definition + "; unit: " + std::string(metric.unit)},
                         {"type", {metric.is_count() ? "integer" : "number", "null"}}};
  if (metric.range.min) schema["minimum"] = ordered_json(number_json(*metric.range.min));
  if (metric.range.max) schema["maximum"] = ordered_json(number_json(*metric.range.max));
  return schema;
}

/// Requires a property of an object; a dot in its path is a group.
void add_property(ordered_json& object, const std::string& path, const ordered_json& property) {
  const std::string name = path.substr(0, path.find('.'));
  object["type"] = "object";
  object["additionalProperties"] = false;
  ordered_json& required = object["required"];
  if (std::find(required.begin(), required.end(), name) == required.end()) required.push_back(name);
  ordered_json& child = object["properties"][name];
  if (name == path)
    child = property;
  else
    add_property(child, path.substr(name.size() + 1), property);
}

}  // namespace

std::string results_schema() {
  ordered_json schema = ordered_json::parse(kSchemaFrame);
  for (const metrics::Metric& metric : metrics::metric_table())
    add_property(schema["$defs"]["cell"], std::string(metric.path), describe_metric(metric));
  return schema.dump(1) + "\n";
}

}  // namespace shadowbench::records
