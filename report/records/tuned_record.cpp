#include "report/records/tuned_record.h"

#include <fmt/format.h>

#include <cassert>
#include <fstream>

#include "base/error.h"
#include "base/files.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

using nlohmann::json;

TuneVerdict find_verdict(const TunedFilterRecord& filter) {
  const double least = filter.unseen_truth_se.value_or(0.0);
  if (filter.training.gain() <= least) return TuneVerdict::kNoGain;
  if (filter.unseen.gain() > least) return TuneVerdict::kBetter;
  return filter.unseen.gain() > 0.0 ? TuneVerdict::kNoGain : TuneVerdict::kOverfitted;
}

/// The means over the training views, or over the unseen ones.
struct Means {
  TunedScore score;
  double truth_se = 0.0;
};

Means average(const std::vector<TunedViewRecord>& views, bool training) {
  Means means;
  double count = 0.0;
  for (const TunedViewRecord& view : views) {
    if (view.training != training) continue;
    means.score.at_default += view.score.at_default;
    means.score.tuned += view.score.tuned;
    means.truth_se += view.truth_se;
    count += 1.0;
  }
  assert(count > 0.0);
  return {{means.score.at_default / count, means.score.tuned / count}, means.truth_se / count};
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
  /// The value, which is `what`.
  template <class T>
  T as(const char* what) const {
    try {
      return read_value<T>(value_);
    } catch (const std::exception&) {
      refuse(what);
    }
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
    for (const auto& [name, value] : value_.items())
      params[name] = Field(value, path_ + "." + name, file_).as<ParamValue>("a number, a text, true or false");
    return params;
  }
  const std::string& path() const { return path_; }

 private:
  const json& value_;
  std::string path_;
  const std::filesystem::path& file_;

  void require(bool holds, const char* what) const {
    if (!holds) refuse(what);
  }
  [[noreturn]] void refuse(const char* what) const {
    fail(file_, fmt::format("{} must be {}, but is {}", path_.empty() ? "the file" : "the field " + path_, what,
                            dump_line(value_)));
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

/// Writes parameters as they are, 4.0 for 4.
json params_json(const ParamMap& params) {
  json written = json::object();
  for (const auto& [name, value] : params)
    std::visit([&written, &key = name](const auto& held) { written[key] = held; }, value);
  return written;
}

}  // namespace

void judge_tuning(TunedFilterRecord& filter, const ParamMap& found, bool metric_in_visibility) {
  filter.training = average(filter.views, true).score;
  const Means unseen = average(filter.views, false);
  filter.unseen = unseen.score;
  if (metric_in_visibility) filter.unseen_truth_se = unseen.truth_se;
  filter.verdict = find_verdict(filter);
  filter.params = filter.verdict == TuneVerdict::kBetter ? found : filter.defaults;
}

void visit_fields(const TunedScore& score, auto&& visit) {
  visit("default", score.at_default);
  visit("tuned", score.tuned);
}

void visit_fields(const TunedViewRecord& view, auto&& visit) {
  visit("scene", view.scene);
  visit("view", view.view);
  visit("training", view.training);
  visit("score", view.score);
  visit("truth_se", view.truth_se);
}

void visit_fields(const TunedParamRecord& param, auto&& visit) {
  visit("name", param.name);
  visit("unit", param.unit);
  visit("scale", param.scale);
  visit("min", param.min);
  visit("max", param.max);
  visit("default", param.default_value);
  visit("found", param.found);
  visit("good", param.good);
  visit("good_share", param.good_share);
  visit("no_effect", param.no_effect);
}

void visit_fields(const TunedFilterRecord& filter, auto&& visit) {
  visit("id", filter.id);
  visit("params", params_json(filter.params));
  visit("fit", filter.fit);
  visit("defaults", params_json(filter.defaults));
  visit("verdict", filter.verdict);
  visit("training", filter.training);
  visit("unseen", filter.unseen);
  visit("searched", filter.searched);
  visit("views", filter.views);
  visit("search_evaluations", filter.search_evaluations);
  visit("evaluations", filter.evaluations);
  visit("unseen_truth_se", filter.unseen_truth_se);
}

std::string make_tuned_json(const TunedRecord& record) {
  return dump_file({{"schema_version", kTunedSchemaVersion},
                    {"commit", record.commit},
                    {"renderer", record.renderer},
                    {"metric", record.metric},
                    {"map_size", record.map_size},
                    {"fit", record.fit},
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
                    {"filters", value_json(record.filters)}});
}

TunedSettings read_tuned_settings(const std::filesystem::path& file) {
  const json parsed = parse(file);
  const Field root(parsed, "", file);
  const int version = root.at("schema_version").as<int>("a whole number");
  if (version != kTunedSchemaVersion)
    fail(file, fmt::format("the field schema_version is {}, and this program reads {}", version, kTunedSchemaVersion));
  TunedSettings settings{
      root.at("metric").as<std::string>("a text"), root.at("map_size").as<int>("a whole number"), {}};
  for (const Field& item : root.at("filters").items()) {
    TunedSettings::Filter filter{item.at("id").as<std::string>("a text"), item.at("params").params(),
                                 item.at("fit").as<std::string>("a text")};
    for (const TunedSettings::Filter& known : settings.filters)
      if (known.id == filter.id)
        fail(file, fmt::format("the field {}.id names '{}' a second time", item.path(), filter.id));
    settings.filters.push_back(std::move(filter));
  }
  return settings;
}

}  // namespace shadowbench::records
