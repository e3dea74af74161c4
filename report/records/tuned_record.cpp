#include "report/records/tuned_record.h"

#include <fmt/format.h>

#include <cassert>

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

constexpr const char* kTuneAgain = "make the file anew with 'shadowbench tune'";

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

void visit_fields(TunedSettings::Filter& filter, auto&& visit) {
  visit("id", filter.id);
  visit("params", filter.params);
  visit("fit", filter.fit);
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
  const json parsed = read_json_file(file, 64 * kMebibyte, kTuneAgain);
  const std::string where = file.string();
  const FieldReader root{parsed, where, kTuneAgain};
  int version = 0;
  root("schema_version", version);
  if (version != kTunedSchemaVersion)
    root.fail(fmt::format("the field schema_version is {}, and this program reads {}", version, kTunedSchemaVersion));
  TunedSettings settings;
  root("metric", settings.metric);
  root("map_size", settings.map_size);
  if (!parsed.contains("filters") || !parsed["filters"].is_array()) root.fail("the field 'filters' must be a list");
  for (const json& item : parsed["filters"]) {
    const std::string place = fmt::format("filters[{}].", settings.filters.size());
    TunedSettings::Filter filter;
    visit_fields(filter, FieldReader{item, where, kTuneAgain, place});
    for (const TunedSettings::Filter& known : settings.filters)
      if (known.id == filter.id) root.fail(fmt::format("the field {}id names '{}' a second time", place, filter.id));
    settings.filters.push_back(std::move(filter));
  }
  return settings;
}

}  // namespace shadowbench::records
