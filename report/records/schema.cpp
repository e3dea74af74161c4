#include <nlohmann/json.hpp>

#include "base/text.h"
#include "report/records/json_io.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

using nlohmann::ordered_json;

/// What is described once in the schema, under this name, and referred to where it stands.
struct Definition {
  std::string_view name = {};  ///< empty: it is described where it stands
  std::string_view text = {};
};

template <class T>
constexpr Definition find_definition() {
  if (std::is_same_v<T, CellRecord>) return {"cell", "one scene x view x filter x parameters x map settings"};
  if (std::is_same_v<T, Quartiles>) return {"quartiles"};
  if (std::is_same_v<T, Interval>) return {"interval"};
  if (std::is_same_v<T, Ratio>) return {"ratio"};
  if (std::is_same_v<T, OwnTime>) return {"own_time", "may be below 0 where a difference is too small for this clock"};
  if (std::is_same_v<T, CascadeRecord>) return {"cascade"};
  if (std::is_same_v<T, GpuRecord>)
    return {"gpu", "facts of the compiler, and an estimate made of them; or why there are none"};
  if (std::is_same_v<T, GpuPassRecord>)
    return {
        "gpu_pass",
        "what the GPU's compiler says of a pass; counts are of the machine code, in which the body of a loop stands "
        "once"};
  return {};
}

ordered_json start(std::string_view text) {
  return text.empty() ? ordered_json::object() : ordered_json{{"description", text}};
}

/// Adds a property to an object; a dot in its path is a group.
void add_property(ordered_json& object, const std::string& path, const ordered_json& property, bool required = true) {
  const std::string name = path.substr(0, path.find('.'));
  object["type"] = "object";
  object["additionalProperties"] = false;
  if (required && std::ranges::none_of(object["required"], [&](const auto& known) { return known == name; }))
    object["required"].push_back(name);
  ordered_json& child = object["properties"][name];
  if (name == path)
    child = property;
  else
    add_property(child, path.substr(name.size() + 1), property, required);
}

/// Describes records and their values.
class SchemaWriter {
 public:
  ordered_json definitions = ordered_json::object();

  template <class T>
  ordered_json describe(const About& about) {
    if constexpr (kIsA<T, std::optional>)
      return describe_optional<typename T::value_type>(about);
    else if constexpr (std::is_enum_v<T>)
      return {{"enum", kNames<T>}};
    else if constexpr (std::is_same_v<T, bool>)
      return {{"type", "boolean"}};
    else if constexpr (std::is_arithmetic_v<T>)
      return describe_number(std::is_integral_v<T>, about);
    else if constexpr (std::is_same_v<T, std::string>)
      return describe_text(about);
    else if constexpr (std::is_same_v<T, ParamValue>)
      return {{"type", {"number", "string", "boolean"}}};
    else if constexpr (kIsA<T, std::map>)
      return {{"type", "object"}, {"additionalProperties", describe<typename T::mapped_type>({.filled = true})}};
    else if constexpr (kIsA<T, std::vector>) {
      ordered_json list = {{"type", "array"}, {"items", describe<typename T::value_type>({.filled = about.filled})}};
      if (about.least) list["minItems"] = number_json(*about.least);
      return list;
    } else
      return describe_record<T>();
  }

 private:
  template <class T>
  ordered_json describe_optional(About about) {
    about.filled = true;
    ordered_json schema = describe<T>(about);
    if (schema.contains("enum"))
      schema["enum"].push_back(nullptr);
    else if (std::is_arithmetic_v<T> || kIsText<T>)
      schema["type"] = {schema["type"], "null"};
    else
      schema = {{"oneOf", {{{"type", "null"}}, schema}}};
    return schema;
  }

  static ordered_json describe_number(bool whole, const About& about) {
    ordered_json schema = {{"type", whole ? "integer" : "number"}};
    if (about.least || whole) schema["minimum"] = number_json(about.least.value_or(0.0));
    if (about.most) schema["maximum"] = number_json(*about.most);
    return schema;
  }

  static ordered_json describe_text(const About& about) {
    if (!about.one_of.empty()) return {{"enum", split_list(about.one_of)}};
    ordered_json schema = {{"type", "string"}};
    if (about.filled) schema["minLength"] = 1;
    if (about.is_path) schema["pattern"] = "^[^/]";
    if (!about.pattern.empty()) schema["pattern"] = about.pattern;
    return schema;
  }

  template <class T>
  ordered_json describe_record() {
    constexpr Definition kHere = find_definition<T>();
    ordered_json schema = start(kHere.text);
    if constexpr (std::is_same_v<T, Interval>) {
      schema = {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
    } else {
      const T record{};
      visit_fields(record, FieldDescriber{*this, schema});
    }
    if (kHere.name.empty()) return schema;
    definitions[std::string(kHere.name)] = schema;
    return {{"$ref", fmt::format("#/$defs/{}", kHere.name)}};
  }

  /// Adds each visited field to the schema of a record.
  struct FieldDescriber {
    SchemaWriter& writer;
    ordered_json& record;

    void operator()(const std::string& path, const Group&, const About& about = {}) const {
      if (!about.text.empty()) record["properties"][path]["description"] = about.text;
    }
    template <class T>
    void operator()(const std::string& path, const T&, const About& about = {}) const {
      ordered_json property =
          start(about.unit.empty() ? std::string(about.text) : fmt::format("{}; unit: {}", about.text, about.unit));
      property.update(writer.describe<T>(about));
      add_property(record, path, property, !about.may_lack);
    }
  };
};

}  // namespace

std::string results_schema() {
  SchemaWriter writer;
  const ordered_json version = {{"const", kSchemaVersion}}, cell = writer.describe<CellRecord>({});
  ordered_json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"title", "Shadowbench results"},
      {"description", "results.json of one run. A value that does not exist is null, and `absent` says why."}};
  schema.update(writer.describe<RunRecord>({}));
  add_property(schema, "schema_version", version);
  add_property(schema, "absent", writer.describe<std::map<std::string, std::string>>({}));
  add_property(schema, "cells", {{"type", "array"}, {"items", cell}});
  writer.definitions["cell"].update(ordered_json::parse(R"({
    "if": {"properties": {"status": {"const": "ok"}}},
    "then": {"properties": {"message": {"const": ""}, "suspect_of": {"maxItems": 0}}},
    "else": {"properties": {"message": {"minLength": 1}}}})"));
  ordered_json& file = writer.definitions["cell_file"] = start("cells/<key>.json");
  add_property(file, "schema_version", version);
  add_property(file, "cell", cell);
  schema["$defs"] = writer.definitions;
  return schema.dump(1) + "\n";
}

std::string make_metric_text() {
  std::string text;
  for (const metrics::Metric& metric : metrics::metric_table()) {
    text += fmt::format("{}  {}, {}, {}\n  {}\n", metric.path, metric.unit, metrics::describe_range(metric.range),
                        metrics::describe_direction(metric.direction), metric.definition);
  }
  return text;
}

std::string make_metric_json() {
  nlohmann::json listed = nlohmann::json::array();
  for (const metrics::Metric& metric : metrics::metric_table()) {
    listed.push_back({{"path", metric.path},
                      {"name", metric.name()},
                      {"unit", metric.unit},
                      {"min", member_json(metric.range.min)},
                      {"max", member_json(metric.range.max)},
                      {"direction", metrics::describe_direction(metric.direction)},
                      {"definition", metric.definition},
                      {"diff", metric.source != metrics::MetricSource::kRun}});
  }
  return listed.dump(2) + "\n";
}

}  // namespace shadowbench::records
