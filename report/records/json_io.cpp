#include "report/records/json_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "report/records/cell_key.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

using nlohmann::json;

constexpr int kDeepest = 100;
constexpr std::uintmax_t kMostOfResults = 4096 * kMebibyte;
constexpr const char* kRunAgain = "delete this file and run again";
constexpr const char* kMistakesFile = "filter_mistakes.json";

void require_shallow(int depth) {
  if (depth > kDeepest) throw std::invalid_argument("nested more than 100 deep");
}

void check_depth(const json& value, int depth = 0) {
  if (!value.is_structured()) return;
  require_shallow(depth);
  for (const json& each : value) check_depth(each, depth + 1);
}

bool is_finite(const json& value) {
  if (value.is_structured()) return std::ranges::all_of(value, is_finite);
  return !value.is_number_float() || std::isfinite(value.get<double>());
}

// Writes each visited field into one JSON object and notes the nulls.
struct FieldWriter {
  json& root;
  std::map<std::string, std::string>& not_finite;
  std::vector<std::string>& nulls;

  void operator()(const std::string&, const Group&, const About& = {}) const {}

  template <class T>
  void operator()(const std::string& path, const T& value, const About& = {}) const {
    root[make_pointer(path)] = value_json(value);
  }

  template <class T>
  void operator()(const std::string& path, const std::optional<T>& value, const About& about = {}) const {
    if (!value && about.may_lack) return;
    json& written = root[make_pointer(path)] = value_json(value);
    if (value && is_finite(written)) return;
    written = nullptr;
    nulls.push_back(path);
    if (value) not_finite[path] = "the value was not finite";
  }
};

// Lists the files that visited fields name.
struct PathLister {
  std::vector<std::string>& files;

  void operator()(const std::string&, const auto&, const About& = {}) const {}
  void operator()(const std::string&, const std::optional<std::string>& file, const About& about = {}) const {
    if (file && about.is_path) files.push_back(*file);
  }
  void operator()(const std::string&, const std::optional<AccumulationRecord>& record, const About& = {}) const {
    if (record) visit_fields(*record, *this);
  }
};

constexpr const char* kNotMeasured = "not measured";

// A path, its group, that group's group and so on.
std::vector<std::string> list_path_and_groups(std::string path) {
  std::vector<std::string> names{path};
  for (auto dot = path.rfind('.'); dot != std::string::npos; dot = path.rfind('.')) {
    path.resize(dot);
    names.push_back(path);
  }
  return names;
}

bool is_explained(const std::map<std::string, std::string>& absent, const std::string& path) {
  for (const std::string& name : list_path_and_groups(path))
    if (absent.count(name) != 0) return true;
  return false;
}

bool has_value(const json& value) {
  if (!value.is_object()) return !value.is_null();
  return std::any_of(value.begin(), value.end(), has_value);
}

std::map<std::string, std::string> explain_nulls(const json& root, std::map<std::string, std::string> absent,
                                                 const std::vector<std::string>& nulls) {
  // A record that was read again still says "not measured" of values that have been measured since.
  std::erase_if(absent, [](const auto& entry) { return entry.second == kNotMeasured; });
  for (const std::string& path : nulls) {
    if (is_explained(absent, path)) continue;
    const std::string group = list_path_and_groups(path).back();
    absent[has_value(root.at(group)) ? path : group] = kNotMeasured;
  }
  return absent;
}

/// Writes a record, with the reasons of what it lacks.
json write_record(const auto& record, std::map<std::string, std::string> absent) {
  json root = json::object();
  std::vector<std::string> nulls;
  visit_fields(record, FieldWriter{root, absent, nulls});
  root["absent"] = explain_nulls(root, absent, nulls);
  return root;
}

json parse_json(std::istream& stream, const json::parser_callback_t& keep) {
  if (keep) {
    return json::parse(
        stream,
        [&](int depth, json::parse_event_t event, json& value) {
          require_shallow(depth);
          return keep(depth, event, value);
        });
  }
  // With a callback, the parser goes through all that an object holds whenever one of its members ends.
  json value = json::parse(stream);
  check_depth(value);
  return value;
}

void check_version(const json& root, const std::string& where) {
  const json version = root.is_object() ? root.value("schema_version", json()) : json();
  if (version != kSchemaVersion) {
    throw Error(ErrorKind::kInput,
                fmt::format("its schema_version is {}, and this program reads {}; run again with this program, or read "
                            "it with the one that wrote it",
                            version.is_null() ? "missing" : dump_line(version), kSchemaVersion),
                where);
  }
}

// Takes the cells out of a results.json while it is parsed: as JSON they fill ten times the memory that they need.
class CellTaker {
 public:
  CellTaker(std::vector<CellRecord>& cells, const std::string& where) : cells_(cells), where_(where) {}

  /// Whether a value stays; called by the parser. What is wrong with a cell waits until the file is known to be whole.
  bool operator()(int depth, json::parse_event_t event, const json& value) {
    if (depth == 1 && event == json::parse_event_t::key) among_cells_ = value == "cells";
    if (!among_cells_ || depth != 2 || event != json::parse_event_t::object_end) return true;
    try {
      if (!problem_) cells_.push_back(cell_from_json(value, where_));
    } catch (const Error&) {
      problem_ = std::current_exception();
    }
    return false;
  }

  void throw_problem() const {
    if (problem_) std::rethrow_exception(problem_);
  }

 private:
  std::vector<CellRecord>& cells_;
  const std::string& where_;
  bool among_cells_ = false;
  std::exception_ptr problem_;
};

using nlohmann::ordered_json;

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
  template <class T>
  ordered_json describe(const About& about) {
    if constexpr (kIsA<T, std::optional>)
      return describe_optional<typename T::value_type>(about);
    else if constexpr (std::is_enum_v<T>)
      return {{"enum", list_names<T>()}};
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
    ordered_json schema = ordered_json::object();
    if constexpr (std::is_same_v<T, Interval>) {
      schema = {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
    } else {
      const T record{};
      visit_fields(record, FieldDescriber{*this, schema});
    }
    return schema;
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

json read_json_file(const std::filesystem::path& file, std::uintmax_t most_bytes, std::string_view advice,
                    const json::parser_callback_t& keep) {
  require_plain_file(file, most_bytes);
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    fail_input("the file cannot be opened: is its name right, and did the command that writes it end?", file.string());
  try {
    return parse_json(stream, keep);
  } catch (const std::exception& problem) {
    fail_input(
        fmt::format("this is not complete JSON, so the file was cut off or edited ({}); {}", problem.what(), advice),
        file.string());
  }
}

json number_json(double value) {
  constexpr double kLargestExactInteger = 9007199254740992.0;  // 2^53
  if (std::nearbyint(value) == value && std::abs(value) <= kLargestExactInteger)
    return static_cast<std::int64_t>(value);
  return value;
}

std::string dump_line(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

std::string dump_file(const json& value) { return value.dump(1, ' ', false, json::error_handler_t::replace) + "\n"; }

bool FieldReader::stays_inside(const std::string& path) {
  const std::filesystem::path relative = std::filesystem::path(path).lexically_normal();
  return !path.empty() && relative.is_relative() && *relative.begin() != ".." && path.find('\0') == std::string::npos;
}

void FieldReader::fail(const std::string& fault) const {
  throw Error(ErrorKind::kInput, fmt::format("{}; {}", fault, advice), where);
}

json::json_pointer make_pointer(std::string path) {
  std::replace(path.begin(), path.end(), '.', '/');
  return json::json_pointer("/" + path);
}

json to_json(const CellRecord& cell) { return write_record(cell, cell.absent); }

json to_json(const RunRecord& run) {
  json root = write_record(run, {});
  root["schema_version"] = kSchemaVersion;
  return root;
}

CellRecord cell_from_json(const json& json, const std::string& where) {
  CellRecord cell;
  const FieldReader reader{json, where, kRunAgain};
  visit_fields(cell, reader);
  if (!is_cell_key(cell.key))
    reader.fail(fmt::format("the field 'key' holds {}, which is no key of 16 hexadecimal digits",
                            dump_line(cell.key).substr(0, 60)));
  return cell;
}

RunRecord run_from_json(const json& json, const std::string& where) {
  check_version(json, where);
  RunRecord run;
  const FieldReader reader{json, where, kRunAgain};
  visit_fields(run, reader);
  const ExperimentRecord& all = run.experiment;
  if (all.cells < 0 || all.shard < 1 || all.shard > all.shards)
    reader.fail(fmt::format("the field 'experiment' says shard {} of {}, with {} cells, which cannot be", all.shard,
                            all.shards, all.cells));
  return run;
}

std::filesystem::path cell_path(const std::filesystem::path& dir, const std::string& key) {
  assert(is_cell_key(key));
  return dir / "cells" / (key + ".json");
}

void write_cell(const std::filesystem::path& dir, const CellRecord& cell) {
  const json file{{"schema_version", kSchemaVersion}, {"cell", to_json(cell)}};
  write_text_file(cell_path(dir, cell.key), dump_file(file));
}

CellRecord read_cell(const std::filesystem::path& dir, const std::string& key) {
  const std::filesystem::path file = cell_path(dir, key);
  const json root = read_json_file(file, kMostOfResults, kRunAgain);
  check_version(root, file.string());
  return cell_from_json(root.value("cell", json()), file.string());
}

std::vector<std::string> list_files(const CellRecord& cell) {
  std::vector<std::string> files;
  visit_fields(cell, PathLister{files});
  return files;
}

std::vector<CellRecord> read_cells(const std::filesystem::path& dir, const std::vector<std::string>& keys) {
  std::vector<CellRecord> cells;
  for (const std::string& key : keys) cells.push_back(read_cell(dir, key));
  return cells;
}

void write_results(const std::filesystem::path& dir, const RunRecord& run, const std::vector<CellRecord>& cells) {
  write_text_file(dir / "results.schema.json", results_schema());
  AtomicFile file(dir / "results.json");
  std::string head = dump_file(to_json(run));
  head.resize(head.rfind("\n}"));  // the closing brace comes after the cells
  file.write(head + ",\n \"cells\": [");
  std::string_view separator = "\n";
  for (const CellRecord& cell : cells) {
    file.write(fmt::format("{}  {}", separator, dump_line(to_json(cell))));
    separator = ",\n";
  }
  file.write("\n ]\n}\n");
  file.commit();
}

Results read_results(const std::filesystem::path& file) {
  Results results;
  const std::string where = file.string();
  CellTaker taker(results.cells, where);
  const json root = read_json_file(file, kMostOfResults, kRunAgain, std::ref(taker));
  results.run = run_from_json(root, where);
  if (!root.contains("cells") || !root["cells"].is_array())
    throw Error(ErrorKind::kInput, "the list 'cells' is missing; delete this file and run again", where);
  taker.throw_problem();
  for (const json& cell : root["cells"]) cell_from_json(cell, where);  // what is no object is no cell
  std::set<std::string_view> keys;
  for (const CellRecord& cell : results.cells)
    if (!keys.insert(cell.key).second)
      throw Error(ErrorKind::kInput, fmt::format("the cell {} stands in it twice; delete it and run again", cell.key),
                  where);
  return results;
}

std::string results_schema() {
  SchemaWriter writer;
  const ordered_json version = {{"const", kSchemaVersion}}, reference = {{"$ref", "#/$defs/cell"}};
  ordered_json schema = {
      {"$schema", "https://json-schema.org/draft/2020-12/schema"},
      {"title", "Shadowbench results"},
      {"description", "results.json of one run. A value that does not exist is null, and `absent` says why."}};
  schema.update(writer.describe<RunRecord>({}));
  add_property(schema, "schema_version", version);
  add_property(schema, "absent", writer.describe<std::map<std::string, std::string>>({}));
  add_property(schema, "cells", {{"type", "array"}, {"items", reference}});
  ordered_json cell = start("one scene x view x filter x parameters x map settings");
  cell.update(writer.describe<CellRecord>({}));
  cell.update(ordered_json::parse(R"({
    "if": {"properties": {"status": {"const": "ok"}}},
    "then": {"properties": {"message": {"const": ""}, "suspect_of": {"maxItems": 0}}},
    "else": {"properties": {"message": {"minLength": 1}}}})"));
  ordered_json file = start("cells/<key>.json");
  add_property(file, "schema_version", version);
  add_property(file, "cell", reference);
  schema["$defs"] = {{"cell", std::move(cell)}, {"cell_file", std::move(file)}};
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

void write_filter_mistakes(const std::filesystem::path& folder, const std::vector<filters::FilterMistake>& mistakes) {
  std::error_code ignored;
  if (mistakes.empty()) {
    std::filesystem::remove(folder / kMistakesFile, ignored);
    return;
  }
  json list = json::array();
  for (const filters::FilterMistake& each : mistakes)
    list.push_back({{"filter", each.id}, {"file", each.file}, {"message", each.message}});
  write_text_file(folder / kMistakesFile, dump_file(list));
}

std::vector<filters::FilterMistake> read_filter_mistakes(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder / kMistakesFile, ignored)) return {};
  const json list = read_json_file(folder / kMistakesFile, kMebibyte, kRunAgain);
  std::vector<filters::FilterMistake> mistakes;
  try {
    for (const json& each : list)
      mistakes.push_back({each.at("filter").get<std::string>(), each.at("file").get<std::string>(),
                          each.at("message").get<std::string>()});
  } catch (const std::exception&) {
    fail_input("this file is damaged; run again, or remove it", (folder / kMistakesFile).string());
  }
  return mistakes;
}

}  // namespace shadowbench::records
