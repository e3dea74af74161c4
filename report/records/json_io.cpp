#include "report/records/json_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <exception>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "filters/base/atomic_file.h"
#include "filters/base/error.h"
#include "filters/base/input_file.h"
#include "report/records/cell_key.h"
#include "report/records/json_values.h"
#include "report/records/record_fields.h"

namespace shadowbench::records {
namespace {

using nlohmann::json;

json::json_pointer make_pointer(std::string path) {
  std::replace(path.begin(), path.end(), '.', '/');
  return json::json_pointer("/" + path);
}

bool is_finite(double value) { return std::isfinite(value); }
bool is_finite(std::int64_t) { return true; }
bool is_finite(bool) { return true; }
bool is_finite(const std::string&) { return true; }
bool is_finite(const std::vector<std::string>&) { return true; }
bool is_finite(const MachineKind&) { return true; }
bool is_finite(const Quartiles& value) {
  return std::isfinite(value.median) && std::isfinite(value.q1) && std::isfinite(value.q3);
}
bool is_finite(const OwnTime& value) {
  return is_finite(static_cast<const Quartiles&>(value)) && std::isfinite(value.ci95.low) &&
         std::isfinite(value.ci95.high);
}
bool is_finite(const Interval& value) { return std::isfinite(value.low) && std::isfinite(value.high); }
bool is_finite(const Ratio& value) {
  return std::isfinite(value.median) && std::isfinite(value.ci95.low) && std::isfinite(value.ci95.high);
}

bool is_finite(const std::vector<LightCountRecord>& value) {
  return std::all_of(
      value.begin(), value.end(),
      [](const LightCountRecord& each) {
        return is_finite(each.still_ms) && is_finite(each.moving_ms) && is_finite(each.still_ratio) &&
               is_finite(each.moving_ratio);
      });
}

bool is_finite(const GpuRecords& value) {
  return std::ranges::all_of(
      value,
      [](const auto& each) {
        const auto& estimate = each.second.estimate;
        return !estimate || (std::isfinite(estimate->total_us) && std::isfinite(estimate->memory_us.value_or(0.0)));
      });
}

// Writes each visited field into one JSON object and notes the nulls.
struct FieldWriter {
  json& root;
  std::map<std::string, std::string>& not_finite;
  std::vector<std::string>& nulls;

  template <class T>
  void operator()(const std::string& path, const T& value) {
    root[make_pointer(path)] = value_json(value);
  }

  template <class T>
  void operator()(const std::string& path, const std::optional<T>& value) {
    if (value && is_finite(*value)) {
      (*this)(path, *value);
      return;
    }
    root[make_pointer(path)] = nullptr;
    nulls.push_back(path);
    if (value) not_finite[path] = "the value was not finite";
  }
};

// Reads each visited field from one JSON object.
struct FieldReader {
  const json& root;
  const std::string& where;

  template <class T>
  void operator()(const std::string& path, T& value) {
    if (!lacks_later_field(path)) value = read<T>(path, root);
  }

  template <class T>
  void operator()(const std::string& path, std::optional<T>& value) {
    const bool is_null = lacks_later_field(path) || at(path).is_null();
    value = is_null ? std::nullopt : std::optional<T>(read<T>(path, root));
  }

  bool lacks_later_field(const std::string& path) const {
    return std::ranges::count(kLaterFields, path) > 0 && root.is_object() && !root.contains(make_pointer(path));
  }

  const json& at(const std::string& path) const {
    const auto pointer = make_pointer(path);
    if (!root.is_object() || !root.contains(pointer)) {
      throw Error(ErrorKind::kInput, fmt::format("the field '{}' is missing; delete this file and run again", path),
                  where);
    }
    return root.at(pointer);
  }

  template <class T>
  T read(const std::string& path, const json&) const {
    const json& value = at(path);
    try {
      return read_value<T>(value);
    } catch (const std::exception& problem) {
      throw Error(ErrorKind::kInput,
                  fmt::format("the field '{}' holds {}, which is not what belongs there ({}); delete this file and run "
                              "again",
                              path, dump_line(value).substr(0, 60), problem.what()),
                  where);
    }
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

json parse_file(const std::filesystem::path& file, const json::parser_callback_t& keep = {}) {
  require_plain_file(file, 4096 * kMebibyte);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error(ErrorKind::kInput, "the file cannot be opened; was the run finished?", file.string());
  try {
    return parse_json(stream, keep);
  } catch (const std::exception& problem) {
    throw Error(
        ErrorKind::kInput,
        fmt::format("this is not complete JSON, so the file was cut off or edited ({}); delete it and run again",
                    problem.what()),
        file.string());
  }
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

// Whether a path that a report names stays in its folder: reports come from elsewhere, and `merge` copies what they
// name.
bool stays_inside(const std::string& path) {
  const std::filesystem::path relative = std::filesystem::path(path).lexically_normal();
  return !path.empty() && relative.is_relative() && *relative.begin() != ".." && path.find('\0') == std::string::npos;
}

struct ImageCheck {
  const std::string& where;

  void operator()(const std::string& path, const std::optional<std::string>& value) const {
    if (!path.starts_with("images.") || !value || stays_inside(*value)) return;
    throw Error(
        ErrorKind::kInput,
        fmt::format("the field '{}' holds {}, which is outside the report's folder; delete this file and run again",
                    path, dump_line(*value).substr(0, 60)),
        where);
  }
  template <class T>
  void operator()(const std::string&, const T&) const {}
};

void check_cell(const CellRecord& cell, const std::string& where) {
  if (!is_cell_key(cell.key)) {
    throw Error(
        ErrorKind::kInput,
        fmt::format(
            "the field 'key' holds {}, which is no key of 16 hexadecimal digits; delete this file and run again",
            dump_line(cell.key).substr(0, 60)),
        where);
  }
  visit_cell_fields(cell, ImageCheck{where});
}

void check_shard(const ExperimentRecord& experiment, const std::string& where) {
  if (experiment.cells >= 0 && experiment.shard >= 1 && experiment.shard <= experiment.shards) return;
  throw Error(
      ErrorKind::kInput,
      fmt::format(
          "the field 'experiment' says shard {} of {}, with {} cells, which cannot be; delete this file and run again",
          experiment.shard, experiment.shards, experiment.cells),
      where);
}

}  // namespace

json to_json(const CellRecord& cell) {
  json root = json::object();
  std::map<std::string, std::string> absent = cell.absent;
  std::vector<std::string> nulls;
  visit_cell_fields(cell, FieldWriter{root, absent, nulls});
  root["absent"] = explain_nulls(root, absent, nulls);
  return root;
}

json to_json(const RunRecord& run) {
  json root = json::object();
  std::map<std::string, std::string> absent;
  std::vector<std::string> nulls;
  visit_run_fields(run, FieldWriter{root, absent, nulls});
  root["schema_version"] = kSchemaVersion;
  root["absent"] = explain_nulls(root, absent, nulls);
  return root;
}

CellRecord cell_from_json(const json& json, const std::string& where) {
  CellRecord cell;
  visit_cell_fields(cell, FieldReader{json, where});
  check_cell(cell, where);
  return cell;
}

RunRecord run_from_json(const json& json, const std::string& where) {
  check_version(json, where);
  RunRecord run;
  visit_run_fields(run, FieldReader{json, where});
  check_shard(run.experiment, where);
  return run;
}

std::filesystem::path cell_path(const std::filesystem::path& dir, const std::string& key) {
  assert(is_cell_key(key));
  return dir / "cells" / (key + ".json");
}

void write_cell(const std::filesystem::path& dir, const CellRecord& cell) {
  const json file{{"schema_version", kSchemaVersion}, {"cell", to_json(cell)}};
  write_text_file(cell_path(dir, cell.key), file.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

CellRecord read_cell(const std::filesystem::path& dir, const std::string& key) {
  const std::filesystem::path file = cell_path(dir, key);
  const json root = parse_file(file);
  check_version(root, file.string());
  return cell_from_json(root.value("cell", json()), file.string());
}

void write_results(const std::filesystem::path& dir, const RunRecord& run, const std::vector<CellRecord>& cells) {
  write_text_file(dir / "results.schema.json", results_schema());
  AtomicFile file(dir / "results.json");
  std::string head = to_json(run).dump(1, ' ', false, json::error_handler_t::replace);
  head.resize(head.rfind('\n'));  // the closing brace comes after the cells
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
  const json root = parse_file(file, std::ref(taker));
  results.run = run_from_json(root, where);
  if (!root.contains("cells") || !root["cells"].is_array())
    throw Error(ErrorKind::kInput, "the list 'cells' is missing; delete this file and run again", where);
  taker.throw_problem();
  for (const json& cell : root["cells"]) cell_from_json(cell, where);  // what is no object is no cell
  return results;
}

}  // namespace shadowbench::records
