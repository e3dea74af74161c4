#include "report/records/tuned_json.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "filters/base/error.h"
#include "filters/base/input_file.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

using nlohmann::json;

json to_json(const ParamMap& params) {
  json result = json::object();
  for (const auto& [name, value] : params)
    std::visit([&result, &key = name](const auto& v) { result[key] = v; }, value);
  return result;
}

json to_json(const TunedScore& score) { return {{"default", score.at_default}, {"tuned", score.tuned}}; }

json to_json(const TunedParamRecord& param) {
  json good = json::array();
  for (const Interval& interval : param.good) good.push_back({interval.low, interval.high});
  return {{"name", param.name},
          {"unit", param.unit},
          {"scale", param.scale},
          {"min", param.min},
          {"max", param.max},
          {"default", param.default_value},
          {"found", param.found},
          {"good", good},
          {"good_share", param.good_share},
          {"no_effect", param.no_effect}};
}

json to_json(const TunedViewRecord& view) {
  return {{"scene", view.scene},
          {"view", view.view},
          {"training", view.training},
          {"score", to_json(view.score)},
          {"truth_se", view.truth_se}};
}

const char* name_of(TuneVerdict verdict) {
  if (verdict == TuneVerdict::kBetter) return "better";
  return verdict == TuneVerdict::kNoGain ? "no gain" : "overfitted";
}

json to_json(const TunedFilterRecord& filter);

json to_json(const TunedFilterRecord& filter) {
  json result = {{"id", filter.id},
                 {"params", to_json(filter.params)},
                 {"defaults", to_json(filter.defaults)},
                 {"verdict", name_of(filter.verdict)},
                 {"training", to_json(filter.training)},
                 {"unseen", to_json(filter.unseen)},
                 {"searched", list_json(filter.searched, to_json)},
                 {"views", list_json(filter.views, to_json)},
                 {"search_evaluations", filter.search_evaluations},
                 {"evaluations", filter.evaluations}};
  result["unseen_truth_se"] = filter.unseen_truth_se ? json(*filter.unseen_truth_se) : json();
  return result;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& message) {
  throw Error(ErrorKind::kInput, message + "; make the file anew with 'shadowbench tune'", file.string());
}

/// One value of the file, with its place in it for messages.
class Field {
 public:
  Field(const json& value, std::string path, const std::filesystem::path& file)
      : value_(value), path_(std::move(path)), file_(file) {}

  Field at(const char* key) const {
    require(value_.is_object(), "an object");
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (!value_.contains(key)) fail(file_, fmt::format("the field {} is missing", path));
    return {value_.at(key), path, file_};
  }
  std::string text() const {
    require(value_.is_string(), "a text");
    return value_.get<std::string>();
  }
  int whole() const {
    require(value_.is_number_integer(), "a whole number");
    return value_.get<int>();
  }
  std::vector<Field> items() const {
    require(value_.is_array(), "a list");
    std::vector<Field> fields;
    for (std::size_t i = 0; i < value_.size(); ++i)
      fields.emplace_back(value_[i], fmt::format("{}[{}]", path_, i), file_);
    return fields;
  }
  ParamMap params() const {
    require(value_.is_object(), "an object");
    ParamMap params;
    for (const auto& [name, value] : value_.items()) params[name] = Field(value, path_ + "." + name, file_).param();
    return params;
  }
  const std::string& path() const { return path_; }

 private:
  const json& value_;
  std::string path_;
  const std::filesystem::path& file_;

  void require(bool holds, const char* what) const {
    if (!holds)
      fail(file_, fmt::format("{} must be {}, but is {}", path_.empty() ? "the file" : "the field " + path_, what,
                              value_.dump(-1, ' ', false, json::error_handler_t::replace)));
  }
  ParamValue param() const {
    if (value_.is_boolean()) return value_.get<bool>();
    if (value_.is_string()) return value_.get<std::string>();
    require(value_.is_number(), "a number, a text, true or false");
    return value_.get<double>();
  }
};

json parse(const std::filesystem::path& file) {
  require_plain_file(file, 64 * kMebibyte);
  std::ifstream stream(file, std::ios::binary);
  if (!stream)
    throw Error(ErrorKind::kInput, "this file of tuned parameters cannot be read: check --tuned", file.string());
  try {
    return parse_json(stream);
  } catch (const std::exception& error) {
    fail(file, fmt::format("not JSON, or cut off: {}", error.what()));
  }
}

}  // namespace

std::string make_tuned_json(const TunedRecord& record) {
  const json result = {{"schema_version", kTunedSchemaVersion},
                       {"commit", record.commit},
                       {"renderer", record.renderer},
                       {"metric", record.metric},
                       {"map_size", record.map_size},
                       {"size", {record.width, record.height}},
                       {"pad_texels", record.pad_texels},
                       {"widest_kernel", record.widest_kernel},
                       {"budget", record.budget},
                       {"tolerance", record.tolerance},
                       {"seed", record.seed},
                       {"light", record.light},
                       {"bias", record.bias},
                       {"scenes", record.scenes},
                       {"training_views", record.training_views},
                       {"unseen_views", record.unseen_views},
                       {"notes", record.notes},
                       {"filters", list_json(record.filters, to_json)}};
  return result.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

TunedSettings read_tuned_settings(const std::filesystem::path& file) {
  const json parsed = parse(file);
  const Field root(parsed, "", file);
  const int version = root.at("schema_version").whole();
  if (version != kTunedSchemaVersion)
    fail(file, fmt::format("the field schema_version is {}, and this program reads {}", version, kTunedSchemaVersion));
  TunedSettings settings{root.at("metric").text(), root.at("map_size").whole(), {}};
  for (const Field& item : root.at("filters").items()) {
    TunedSettings::Filter filter{item.at("id").text(), item.at("params").params()};
    for (const TunedSettings::Filter& known : settings.filters)
      if (known.id == filter.id)
        fail(file, fmt::format("the field {}.id names '{}' a second time", item.path(), filter.id));
    settings.filters.push_back(std::move(filter));
  }
  return settings;
}

}  // namespace shadowbench::records
