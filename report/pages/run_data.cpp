#include "report/pages/run_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "filters/kernel_width.h"
#include "reference/metrics/error_stats.h"
#include "reference/metrics/metric_table.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/claims.h"
#include "report/analysis/machines/machine_kinds.h"
#include "report/analysis/trade.h"
#include "report/analysis/trade_measures.h"
#include "report/document/chart.h"
#include "report/files/file_name.h"
#include "report/pages/answer/answer_data.h"
#include "report/pages/external_section.h"
#include "report/records/error_parts.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::pages {
namespace {

using nlohmann::json;

json value_of(const std::optional<double>& value) { return value && std::isfinite(*value) ? json(*value) : json(); }

json path_of(const std::optional<std::string>& path) { return path ? json(files::encode_url_path(*path)) : json(); }

/// What the page says of one column of its table of numbers.
struct MeasureWords {
  std::string_view id, title, text, unit, option = {}, group = {};
  metrics::MetricDirection direction = metrics::MetricDirection::kLess;
};

json make_measure(const MeasureWords& words) {
  static constexpr const char* kBetter[] = {"less", "more", "zero", "neither"};
  return {{"id", words.id},
          {"title", words.title},
          {"text", words.text},
          {"unit", words.unit},
          {"option", words.option},
          {"group", words.group},
          {"better", kBetter[static_cast<std::size_t>(words.direction)]}};
}

/// The time of a frame, light moving and static; no limit is set on a ratio.
json list_frame_measures(const records::RunRecord& run, const analysis::CostKind& frame) {
  const bool is_ratio = frame == analysis::CostKind::kRatio;
  const std::string unit = is_ratio ? analysis::kRatioUnit : records::time_unit(run.gl);
  const std::string clock = "; " + records::describe_clock(run.gl);
  const auto make = [&](const char* id, const std::string& title, const std::string& passes, const char* frames) {
    const std::string ratio = "time of " + passes +
                              " over that of 'none' in the same rounds, on the same machine and map; a map of another "
                              "size has another 'none'";
    const std::string time = passes + " less a lookup that reads nothing: what a frame pays " + frames + clock;
    const std::string titled = (is_ratio ? "ratio to 'none', " : "time, ") + title;
    return make_measure({.id = id,
                         .title = titled,
                         .text = is_ratio ? ratio : time,
                         .unit = unit,
                         .option = is_ratio ? "" : "--max-ms",
                         .group = "cost"});
  };
  return {
      make(kMovingField, "moving light", "map, prefilter and lookup", "in which light or casters move"),
      make(kStaticField, "static light", is_ratio ? "the lookup" : "lookup", "while light and casters stand still")};
}

/// Everything that the table can show, and that limits can be set on.
json list_measures(const records::RunRecord& run, const std::vector<std::string>& gpus,
                   const analysis::CostKind& frame) {
  json measures = list_frame_measures(run, frame);
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.tabled || !metric.limit.empty())
      measures.push_back(make_measure(
          {metric.path, metric.title, metric.definition, metric.unit, metric.limit, metric.group(), metric.direction}));
  for (const std::string& gpu : gpus)
    measures.push_back(
        make_measure({.id = "gpu." + gpu + ".estimate_us",
                      .title = "estimate, " + gpu,
                      .text = "prefilter and a million receivers' lookups on that GPU, which was not there",
                      .unit = "us",
                      .group = "cost"}));
  return measures;
}

json list_values(const records::CellRecord& cell, const std::vector<std::string>& gpus,
                 const analysis::CostKind& frame) {
  json values;
  values[kMovingField] = value_of(analysis::cost_spec(frame).read(cell, analysis::LightMotion::kMoving));
  values[kStaticField] = value_of(analysis::cost_spec(frame).read(cell, analysis::LightMotion::kStatic));
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.tabled || !metric.limit.empty()) values[std::string(metric.path)] = value_of(metric.read(cell));
  for (const std::string& gpu : gpus)
    values["gpu." + gpu + ".estimate_us"] =
        value_of(analysis::cost_spec({analysis::CostKind::kGpu, gpu}).read(cell, analysis::LightMotion::kMoving));
  return values;
}

/// Of times and ratios the 95 % intervals, or the quartiles where there are none.
json list_intervals(const records::CellRecord& cell, const analysis::CostKind& frame) {
  json intervals = json::object();
  for (const auto& [id, light] : {std::pair(kMovingField, analysis::LightMotion::kMoving),
                                  std::pair(kStaticField, analysis::LightMotion::kStatic)}) {
    const auto cost = analysis::measure_cost({&cell}, frame, light);
    if (!cost) continue;
    const records::Interval& interval = cost->ci95 ? *cost->ci95 : cost->quartiles;
    intervals[id] = {interval.low, interval.high};
  }
  return intervals;
}

/// What most of a cell's error comes from, in words; empty where that cannot be said.
std::string find_cause(const records::CellRecord& cell) {
  const auto shares = records::list_shares(cell);
  if (!shares || analysis::is_lost_in_truth(cell)) return {};
  const auto part = analysis::find_dominating_part(*shares);
  if (!part) return {};
  const records::ErrorPart& own = records::list_error_parts()[*part];
  return std::string(own.id) + ": " + own.meaning;
}

json make_cell(const records::CellRecord& cell, std::size_t configuration, std::size_t place,
               const std::vector<std::string>& gpus, const analysis::CostKind& frame) {
  return {{"key", cell.key},
          {"configuration", configuration},
          {"place", place},
          {"status", cell.status == records::CellStatus::kOk ? "ok" : records::describe_status(cell)},
          {"values_of", list_values(cell, gpus, frame)},
          {"rmse", describe_error(cell.error.rmse ? std::optional(analysis::estimate_rmse(cell)) : std::nullopt)},
          {"intervals", list_intervals(cell, frame)},
          {"cause", find_cause(cell)},
          {"picture", path_of(cell.images.picture)},
          {"smooth", cell.images.samples ? json{{"samples", *cell.images.samples},
                                                {"picture", path_of(cell.images.supersampled)},
                                                {"truth", path_of(cell.images.truth_supersampled)}}
                                         : json()},
          {"part", choose_part(cell)},
          {"frames", path_of(cell.images.frames)},
          {"values", path_of(cell.images.values)}};
}

/// All that is true of a configuration on every scene: without the view, and lengths in units of one scene's map.
std::string describe_fully(records::CellRecord cell) {
  cell.map_scale = {};
  const std::string settings = records::describe_settings(cell), params = records::describe_params(cell.params);
  if (cell.external) return fmt::format("{} · {}", cell.filter, describe_engine(*cell.external));
  return cell.filter + (params.empty() ? "" : " · " + params) + settings.substr(settings.find(" · "));
}

/// The filter as the command line takes it: "vsm:radius=4,store=rg32f".
std::string write_request(const records::CellRecord& cell) {
  std::string text = cell.filter;
  for (const auto& [name, value] : cell.params) {
    const std::string* word = std::get_if<std::string>(&value);
    text += fmt::format("{}{}={}", text.size() == cell.filter.size() ? ':' : ',', name,
                        word ? *word : records::value_json(value).dump());
  }
  return text;
}

json make_configuration(const analysis::Configuration& configuration, const std::vector<std::string>& filters,
                        const std::vector<CostChoice>& choices) {
  const records::CellRecord& cell = *configuration.cells.front();
  const document::ChartStyle style =
      document::style_of(static_cast<std::size_t>(std::ranges::find(filters, cell.filter) - filters.begin()));
  json made = {{"label", configuration.name},
               {"full", describe_fully(cell)},
               {"filter", cell.filter},
               {"params", records::describe_params(cell.params)},
               {"class", analysis::name_class(analysis::find_class(cell))},
               {"kernel", records::describe_kernel(cell.kernel)},
               {"sigma", value_of(cell.kernel.sigma_texels)},
               {"request", write_request(cell)},
               {"map", cell.map_size},
               {"size", {cell.width, cell.height}},
               {"teaching", cell.teaching.value_or(false)},
               {"surroundings", configuration.surroundings},
               {"color", style.color},
               {"hardens", analysis::shows_claim(configuration.cells, analysis::kContactHardening)}};
  for (const CostChoice& choice : choices) made[choice.field] = describe_cost(configuration.cells, choice);
  return made;
}

}  // namespace

json make_run_data(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                   const analysis::AdviceRequest& request) {
  const std::vector<const records::CellRecord*> all = analysis::point_to(cells);
  const std::vector<analysis::Place> places = analysis::list_places(all);
  const std::vector<std::string> filters = analysis::list_filters(cells);
  const std::vector<std::string> gpus = analysis::list_gpus(all);
  const analysis::CostKind frame = analysis::frame_cost_kind(cells);
  const bool is_ratio = frame == analysis::CostKind::kRatio;
  json data{{"ratios", is_ratio},
            {"files", records::value_json(run.filter_files)},
            {"measures", list_measures(run, gpus, frame)},
            {"costs", json::array()},
            {"cost", request.cheapest.kind == analysis::CostKind::kGpu ? "gpu." + request.cheapest.gpu : "moving"},
            {"classes", json::array()},
            {"places", json::array()},
            {"truths", json::array()},
            {"configurations", json::array()},
            {"cells", json::array()}};
  const std::vector<CostChoice> choices = list_cost_choices(run, gpus, frame);
  for (const CostChoice& choice : choices)
    data["costs"].push_back({{"id", choice.id},
                             {"field", choice.field},
                             {"title", choice.title},
                             {"unit", choice.unit},
                             {"option", choice.option},
                             {"isEstimate", choice.kind.kind == analysis::CostKind::kGpu}});
  std::vector<std::string> classes;
  for (const auto& each : filters::width_classes())
    if (std::ranges::any_of(cells, [&](const records::CellRecord& cell) {
          return records::is_advised(cell) && cell.kernel.width_class == each.name;
        }))
      classes.emplace_back(each.name);
  data["classes"] = classes;
  for (const analysis::Place& place : places) {
    const auto scene = std::ranges::find(run.scenes, place.scene, &records::SceneRecord::name);
    data["places"].push_back({{"title", analysis::describe_place(place, places)},
                              {"scene", place.scene},
                              {"view", scene == run.scenes.end() ? json::array() : json(scene->view_words)}});
    const auto shown = std::ranges::find_if(
        cells, [&](const auto& cell) { return analysis::place_of(cell) == place && cell.images.truth_values; });
    data["truths"].push_back(shown == cells.end() ? json()
                                                  : json{{"picture", path_of(shown->images.truth_picture)},
                                                         {"values", path_of(shown->images.truth_values)}});
  }
  const std::vector<analysis::Configuration> configurations = analysis::list_configurations(all);
  for (const analysis::Configuration& configuration : configurations) {
    for (const records::CellRecord* cell : configuration.cells)
      data["cells"].push_back(
          make_cell(*cell, data["configurations"].size(), analysis::find_place(places, *cell), gpus, frame));
    data["configurations"].push_back(make_configuration(configuration, filters, choices));
  }
  data["scopes"] = std::ranges::any_of(cells, records::is_advised)
                       ? make_answer_data(cells, configurations, classes, choices)
                       : json::array();
  return data;
}

}  // namespace shadowbench::pages
