#include "report/pages/run_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "filters/kernel.h"
#include "reference/metrics/error_stats.h"
#include "reference/metrics/metric_table.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/claims.h"
#include "report/analysis/picks.h"
#include "report/analysis/place_state.h"
#include "report/analysis/trade.h"
#include "report/analysis/trade_measures.h"
#include "report/document/chart.h"
#include "report/files/file_name.h"
#include "report/pages/answer/answer_data.h"
#include "report/pages/external_section.h"
#include "report/records/cell_key.h"
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

/// Everything that the table can show, and that limits can be set on: of what a frame costs in milliseconds, once.
json list_measures(const std::vector<CostChoice>& costs) {
  json measures = json::array();
  bool is_limited = false;
  for (const CostChoice& cost : costs) {
    measures.push_back(make_measure({.id = cost.field,
                                     .title = cost.title,
                                     .text = cost.measure.meaning,
                                     .unit = cost.unit,
                                     .option = is_limited ? "" : "--max-ms",
                                     .group = "cost"}));
    is_limited = true;
  }
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.tabled || !metric.limit.empty())
      measures.push_back(make_measure(
          {metric.path, metric.title, metric.definition, metric.unit, metric.limit, metric.group(), metric.direction}));
  return measures;
}

json list_values(const records::CellRecord& cell, const std::vector<CostChoice>& costs) {
  json values;
  for (const CostChoice& cost : costs) values[cost.field] = describe_cost({&cell}, cost);
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.tabled || !metric.limit.empty()) values[std::string(metric.path)] = value_of(metric.read(cell));
  return values;
}

/// Of times the 95 % intervals, or the quartiles where there are none.
json list_intervals(const records::CellRecord& cell, const std::vector<CostChoice>& costs) {
  json intervals = json::object();
  for (const CostChoice& choice : costs) {
    const auto cost = choice.measure.is(analysis::CostKind::kTime) ? measure_cost({&cell}, choice) : std::nullopt;
    if (!cost) continue;
    const records::Interval& interval = cost->ci95 ? *cost->ci95 : cost->quartiles;
    intervals[choice.field] = {interval.low, interval.high};
  }
  return intervals;
}

json make_cell(const records::CellRecord& cell, std::size_t configuration, std::size_t place,
               const std::vector<CostChoice>& costs) {
  return {{"key", cell.key},
          {"configuration", configuration},
          {"place", place},
          {"status", cell.status == records::CellStatus::kOk ? "ok" : records::describe_status(cell)},
          {"values_of", list_values(cell, costs)},
          {"rmse", describe_error(cell.error.rmse ? std::optional(analysis::estimate_rmse(cell)) : std::nullopt)},
          {"intervals", list_intervals(cell, costs)},
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
  const std::string settings = records::describe_settings(cell),
                    params = records::describe_params(records::named_params(cell));
  if (cell.external) return fmt::format("{} · {}", cell.filter, describe_engine(*cell.external));
  return cell.filter + (params.empty() ? "" : " · " + params) + settings.substr(settings.find(" · "));
}

/// The filter as the command line takes it: "vsm:radius=4,store=rg32f".
std::string write_request(const records::CellRecord& cell) {
  std::string text = cell.filter;
  for (const auto& [name, value] : records::named_params(cell)) {
    const std::string* word = std::get_if<std::string>(&value);
    text +=
        fmt::format("{}{}={}", text.size() == cell.filter.size() ? ':' : ',',
                    cell.kernel.by_light == name ? "width" : name, word ? *word : records::value_json(value).dump());
  }
  return text;
}

/// `counted` are the configuration's cells that are not left out of what is said of all scenes.
json make_configuration(const analysis::Configuration& configuration,
                        const std::vector<const records::CellRecord*>& counted, const std::vector<std::string>& filters,
                        const std::vector<CostChoice>& choices, const std::vector<records::BiasToShip>& biases) {
  const records::CellRecord& cell = *configuration.cells.front();
  const document::ChartStyle style =
      document::style_of(static_cast<std::size_t>(std::ranges::find(filters, cell.filter) - filters.begin()));
  json made = {{"label", configuration.name},
               {"full", describe_fully(cell)},
               {"filter", cell.filter},
               {"params", records::describe_params(records::named_params(cell))},
               {"class", analysis::name_class(analysis::find_class(cell))},
               {"kernel", analysis::describe_kernel(configuration)},
               {"sigma", value_of(cell.kernel.sigma_texels)},
               {"request", write_request(cell)},
               {"map", cell.map_size},
               {"size", {cell.width, cell.height}},
               {"teaching", cell.teaching},
               {"surroundings", configuration.surroundings},
               {"color", style.color},
               {"bias", describe_biases(configuration, biases)},
               {"hardens", analysis::shows_claim(configuration.cells, analysis::kContactHardening)}};
  for (const CostChoice& choice : choices)
    made[choice.field] = counted.empty() ? json() : describe_cost(counted, choice);
  return made;
}

}  // namespace

json make_run_data(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                   const std::vector<records::BiasToShip>& biases) {
  const std::vector<const records::CellRecord*> all = analysis::point_to(cells);
  const std::vector<analysis::Place> places = analysis::list_places(all);
  const std::vector<std::string> filters = analysis::list_filters(cells);
  const std::vector<CostChoice> choices = list_cost_choices(run, cells);
  json data{{"files", records::value_json(run.filter_files)},
            {"measures", list_measures(choices)},
            {"costs", json::array()},
            {"cost", choices.front().measure.id},
            {"words", analysis::answer_words()},
            {"most_of_tie", analysis::kMostOfTie},
            {"setting", describe_setting(cells)},
            {"classes", json::array()},
            {"places", json::array()},
            {"truths", json::array()},
            {"configurations", json::array()},
            {"cells", json::array()}};
  for (const CostChoice& choice : choices)
    data["costs"].push_back({{"id", choice.measure.id},
                             {"field", choice.field},
                             {"title", choice.title},
                             {"unit", choice.unit},
                             {"option", choice.option},
                             {"text", choice.measure.meaning},
                             {"gpu", choice.measure.cost->gpu}});
  std::vector<std::string> classes;
  for (const std::string& each : filters::list_width_names())
    if (std::ranges::any_of(cells, [&](const records::CellRecord& cell) {
          return records::is_advised(cell) && cell.kernel.width_class == each;
        }))
      classes.push_back(each);
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
  const std::vector<analysis::LeftOutPlace> left_out = analysis::list_left_out(all);
  for (const analysis::Configuration& configuration : configurations) {
    for (const records::CellRecord* cell : configuration.cells)
      data["cells"].push_back(
          make_cell(*cell, data["configurations"].size(), analysis::find_place(places, *cell), choices));
    std::vector<const records::CellRecord*> counted = configuration.cells;
    std::erase_if(counted, [&](const auto* cell) { return analysis::is_left_out(*cell, left_out); });
    data["configurations"].push_back(make_configuration(configuration, counted, filters, choices, biases));
  }
  data["scopes"] = std::ranges::any_of(cells, records::is_advised)
                       ? make_answer_data(cells, configurations, classes, choices)
                       : json::array();
  return data;
}

}  // namespace shadowbench::pages
