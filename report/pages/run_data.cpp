#include "report/pages/run_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "filters/kernel_width.h"
#include "reference/metrics/error_stats.h"
#include "reference/metrics/metric_table.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/machines/machine_kinds.h"
#include "report/analysis/trade.h"
#include "report/analysis/trade_measures.h"
#include "report/document/chart.h"
#include "report/files/file_name.h"
#include "report/records/absence.h"
#include "report/records/error_parts.h"
#include "report/records/format.h"

namespace shadowbench::pages {
namespace {

using nlohmann::json;

bool is_advised(const records::CellRecord& cell) { return !cell.teaching.value_or(false); }

/// What a frame costs, by the names that the page's scripts have for it: milliseconds, or ratios to `none` where
/// several kinds of machine measured the cells.
constexpr const char *kMoving = "time_ms.moving", *kStatic = "time_ms.static";

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
  return {make(kMoving, "moving light", "map, prefilter and lookup", "in which light or casters move"),
          make(kStatic, "static light", is_ratio ? "the lookup" : "lookup", "while light and casters stand still")};
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
  values[kMoving] = value_of(analysis::cost_spec(frame).read(cell, analysis::LightMotion::kMoving));
  values[kStatic] = value_of(analysis::cost_spec(frame).read(cell, analysis::LightMotion::kStatic));
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
  for (const auto& [id, light] :
       {std::pair(kMoving, analysis::LightMotion::kMoving), std::pair(kStatic, analysis::LightMotion::kStatic)}) {
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
  const std::vector<double> replicates = cell.rmse_replicates.value_or(std::vector<double>());
  return {{"key", cell.key},
          {"configuration", configuration},
          {"place", place},
          {"status", cell.status == records::CellStatus::kOk ? "ok" : records::describe_status(cell)},
          {"values_of", list_values(cell, gpus, frame)},
          {"reach", analysis::find_rmse_reach(cell)},
          {"replicates", replicates},
          {"t", replicates.size() > 1 ? json(metrics::find_student_t(replicates.size())) : json()},
          {"intervals", list_intervals(cell, frame)},
          {"cause", find_cause(cell)},
          {"picture", path_of(cell.images.picture)},
          {"values", path_of(cell.images.values)}};
}

constexpr std::pair<const char*, analysis::LightMotion> kLights[] = {{"moving", analysis::LightMotion::kMoving},
                                                                     {"static", analysis::LightMotion::kStatic}};

std::size_t find_index(const std::vector<analysis::Place>& places, const records::CellRecord& cell) {
  return static_cast<std::size_t>(std::ranges::find(places, analysis::place_of(cell)) - places.begin());
}

/// The worst value, the number that as a limit lets it pass, its place, and those with nothing to see; or why there is
/// none.
json describe_worst(const analysis::Verdict& verdict, const std::vector<analysis::Place>& places) {
  if (!verdict.absent.empty()) return verdict.absent;
  json unseen = json::array();
  for (const records::CellRecord* cell : verdict.nothing_to_see) unseen.push_back(find_index(places, *cell));
  return {{"value", *verdict.worst},
          {"limit", std::stod(analysis::format_limit(*verdict.worst))},
          {"place", find_index(places, *verdict.where)},
          {"unseen", std::move(unseen)}};
}

/// How a configuration stands to everything that may be limited, by the names of the measures.
json list_worst(const analysis::Configuration& configuration, const std::vector<analysis::Place>& places,
                const analysis::CostKind& frame) {
  json worst = json::object();
  for (const analysis::LimitSpec& spec : analysis::limit_table()) {
    if (!spec.metric && frame == analysis::CostKind::kRatio) continue;
    for (const auto& [name, light] : kLights) {
      if (spec.metric && light == analysis::LightMotion::kStatic) continue;
      worst[spec.metric ? spec.field : fmt::format("{}.{}", spec.field, name)] =
          describe_worst(analysis::judge_limit(configuration, {&spec, 0.0, {}}, light, places), places);
    }
  }
  return worst;
}

/// The ranks behind one whose costs cannot be told from its own, as pairs of the first and the one after the last.
json list_ties(const analysis::Advice& advice, std::size_t rank) {
  json ranges = json::array();
  std::size_t end = 0;
  for (std::size_t other = rank + 1; other < advice.keeping.size(); ++other) {
    const auto gap = analysis::compare_costs(advice.keeping[rank], advice.keeping[other], advice.request.cheapest);
    if (!gap.tied || gap.basis == analysis::Basis::kNone) continue;
    if (end != other) ranges.push_back({other, other});
    ranges.back()[1] = end = other + 1;
  }
  return ranges;
}

/// A cost that a reader may ask for.
struct CostChoice {
  std::string id;     ///< in the page's data and its links
  std::string field;  ///< of a configuration's and a cell's value
  std::string title, unit;
  std::string said;    ///< behind a number: "a frame with a moving light"
  std::string option;  ///< of `advise`
  analysis::CostKind kind;
  analysis::LightMotion light = analysis::LightMotion::kMoving;
};

std::vector<CostChoice> list_cost_choices(const records::RunRecord& run, const std::vector<std::string>& gpus,
                                          const analysis::CostKind& frame) {
  const bool is_ratio = frame == analysis::CostKind::kRatio;
  const std::string unit = is_ratio ? analysis::kRatioUnit : records::time_unit(run.gl);
  const std::string where = is_ratio ? "" : run.gl.software ? ", this CPU" : ", this GPU";
  std::vector<CostChoice> choices = {
      {"moving", kMoving, "moving light" + where, unit, "a frame with a moving light", "", frame},
      {"static", kStatic, "static light" + where, unit, "a frame with a static light", "--light-motion static", frame,
       analysis::LightMotion::kStatic}};
  for (const std::string& gpu : gpus)
    choices.push_back({"gpu." + gpu, "gpu." + gpu + ".estimate_us", "estimate, " + gpu, "us",
                       "estimated on " + gpu + ", for one map's prefilter and a million receivers",
                       "--cheapest gpu:" + gpu, analysis::CostKind(analysis::CostKind::kGpu, gpu)});
  return choices;
}

/// What advise() says without limits, by cost and class of width: configurations in the order of their costs, with
/// their ties, and why others are not judged.
json list_advice(const std::vector<records::CellRecord>& cells, const json& classes,
                 const std::vector<CostChoice>& choices, const std::vector<analysis::Configuration>& configurations) {
  std::map<const records::CellRecord*, std::size_t> indices;
  for (std::size_t i = 0; i < configurations.size(); ++i)
    for (const records::CellRecord* cell : configurations[i].cells) indices[cell] = i;
  const auto index_of = [&](const auto& each) { return indices.at(each.configuration.cells.front()); };
  json all = json::object();
  for (const CostChoice& choice : choices) {
    for (const std::string wide : classes) {
      analysis::AdviceRequest request;
      request.light = choice.light;
      if (choice.kind.kind == analysis::CostKind::kGpu) request.cheapest = choice.kind;
      request.width_class = wide;
      const analysis::Advice advice = analysis::advise(cells, request);
      json order = json::array(), unjudged = json::array();
      for (std::size_t rank = 0; rank < advice.keeping.size(); ++rank)
        order.push_back({{"index", index_of(advice.keeping[rank])}, {"tied", list_ties(advice, rank)}});
      for (const analysis::Unjudged& each : advice.unjudged)
        unjudged.push_back({{"index", index_of(each)}, {"gap", each.reason}});
      all[choice.id][wide] = {{"order", std::move(order)}, {"unjudged", std::move(unjudged)}};
    }
  }
  return all;
}

/// The mean of what a frame takes over the places; null where a cell was not timed.
json describe_cost(const analysis::Configuration& configuration, const analysis::CostKind& frame,
                   analysis::LightMotion light) {
  const auto cost = analysis::measure_cost(configuration.cells, frame, light);
  return cost ? json(cost->mean) : json();
}

json make_configuration(const analysis::Configuration& configuration, const std::vector<std::string>& filters,
                        const std::vector<analysis::Place>& places, const std::vector<CostChoice>& choices) {
  const records::CellRecord& cell = *configuration.cells.front();
  const document::ChartStyle style =
      document::style_of(static_cast<std::size_t>(std::ranges::find(filters, cell.filter) - filters.begin()));
  json made = {{"label", configuration.name},
               {"full", configuration.label},
               {"filter", cell.filter},
               {"params", records::describe_params(cell.params)},
               {"class", analysis::name_class(analysis::find_class(cell))},
               {"kernel", records::describe_kernel(cell.kernel)},
               {"sigma", value_of(cell.kernel.sigma_texels)},
               {"map", cell.map_size},
               {"pixels", cell.width * cell.height},
               {"teaching", cell.teaching.value_or(false)},
               {"surroundings", configuration.surroundings},
               {"color", style.color},
               {"worst", list_worst(configuration, places, choices.front().kind)}};
  for (const CostChoice& choice : choices) made[choice.field] = describe_cost(configuration, choice.kind, choice.light);
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
            {"measures", list_measures(run, gpus, frame)},
            {"costs", json::array()},
            {"cost", request.cheapest.kind == analysis::CostKind::kGpu ? "gpu." + request.cheapest.gpu : "moving"},
            {"classes", json::array()},
            {"limits", json::object()},
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
                             {"said", choice.said},
                             {"option", choice.option},
                             {"isEstimate", choice.kind.kind == analysis::CostKind::kGpu}});
  for (const auto& each : filters::width_classes())
    if (std::ranges::any_of(cells, [&](const records::CellRecord& cell) {
          return is_advised(cell) && cell.kernel.width_class == each.name;
        }))
      data["classes"].push_back(each.name);
  for (const analysis::Demand& demand : request.demands) data["limits"][demand.spec->field] = demand.most;
  for (const analysis::Place& place : places) {
    data["places"].push_back({{"title", analysis::describe_place(place, places)}});
    const auto shown = std::ranges::find_if(
        cells, [&](const auto& cell) { return analysis::place_of(cell) == place && cell.images.truth_values; });
    data["truths"].push_back(shown == cells.end() ? json()
                                                  : json{{"picture", path_of(shown->images.truth_picture)},
                                                         {"values", path_of(shown->images.truth_values)}});
  }
  const std::vector<analysis::Configuration> configurations = analysis::list_configurations(all);
  for (const analysis::Configuration& configuration : configurations) {
    for (const records::CellRecord* cell : configuration.cells)
      data["cells"].push_back(make_cell(*cell, data["configurations"].size(), find_index(places, *cell), gpus, frame));
    data["configurations"].push_back(make_configuration(configuration, filters, places, choices));
  }
  if (std::ranges::any_of(cells, is_advised)) {
    json classes = data["classes"];
    classes.push_back("");
    data["advice"] = list_advice(cells, classes, choices, configurations);
  }
  return data;
}

}  // namespace shadowbench::pages
