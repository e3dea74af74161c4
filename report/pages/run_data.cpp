#include "report/pages/run_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "base/files.h"
#include "filters/kernel.h"
#include "reference/metrics/error_stats.h"
#include "reference/metrics/metric_table.h"
#include "report/analysis/advice.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cells.h"
#include "report/analysis/measures.h"
#include "report/analysis/trade.h"
#include "report/document/chart.h"
#include "report/pages/bias_page.h"
#include "report/pages/tables.h"
#include "report/pages/trade_section.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/json_values.h"

namespace shadowbench::pages {
namespace {

using analysis::Quantity;
using nlohmann::json;

constexpr double kShape = 2.5;        // of the part of a picture: width over height
constexpr double kMostShown = 480.0;  // pixels across, so that an edge is large enough to look at

/// The worst value, the number that as a limit lets it pass, its place, and those with nothing to see; or why there is
/// none.
json describe_worst(const analysis::Verdict& verdict, const std::vector<analysis::Place>& places) {
  if (!verdict.absent.empty()) return verdict.absent;
  json unseen = json::array();
  for (const records::CellRecord* cell : verdict.nothing_to_see) unseen.push_back(analysis::find_place(places, *cell));
  return {{"value", *verdict.worst},
          {"limit", std::stod(analysis::format_limit(*verdict.worst))},
          {"place", analysis::find_place(places, *verdict.where)},
          {"unseen", std::move(unseen)}};
}

/// How a configuration stands to everything that may be limited, by the names of the measures.
json list_worst(const analysis::Configuration& configuration, const std::vector<analysis::Place>& places,
                const std::vector<Quantity>& costs) {
  json worst = json::object();
  const auto add = [&](const std::string& field, const Quantity& spec, analysis::LightMotion light) {
    worst[field] = describe_worst(analysis::judge_limit(configuration, {&spec, 0.0}, light, places), places);
  };
  for (const Quantity& spec : analysis::limit_table())
    if (spec.metric) add(spec.field, spec, analysis::LightMotion::kMoving);
  for (const Quantity& cost : costs) add(cost.full_field(), analysis::cost_spec(*cost.cost), cost.light);
  return worst;
}

/// The ranks behind one whose costs cannot be told from its own, as pairs of the first and the one after the last.
json list_ties(const analysis::Advice& advice, std::size_t rank) {
  json ranges = json::array();
  std::size_t end = 0;
  for (std::size_t other = rank + 1; other < advice.keeping.size(); ++other) {
    if (!analysis::are_costs_tied(advice.keeping[rank], advice.keeping[other], advice.request.cheapest)) continue;
    if (end != other) ranges.push_back({other, other});
    ranges.back()[1] = end = other + 1;
  }
  return ranges;
}

/// A scene, or all of them, with the configurations' cells there.
struct Scope {
  std::vector<std::string> scenes;  ///< empty: all
  std::vector<analysis::Configuration> configurations;
  std::vector<analysis::LeftOutPlace> left_out;
};

Scope make_scope(std::vector<std::string> scenes, const std::vector<analysis::Configuration>& configurations) {
  Scope scope{std::move(scenes), configurations, {}};
  std::vector<const records::CellRecord*> advised;
  for (analysis::Configuration& each : scope.configurations) {
    std::erase_if(each.cells, [&](const records::CellRecord* cell) {
      return !scope.scenes.empty() && std::ranges::count(scope.scenes, cell->scene) == 0;
    });
    for (const records::CellRecord* cell : each.cells)
      if (records::is_advised(*cell)) advised.push_back(cell);
  }
  scope.left_out = analysis::list_left_out(advised);
  for (analysis::Configuration& each : scope.configurations)
    std::erase_if(each.cells, [&](const auto* cell) { return analysis::is_left_out(*cell, scope.left_out); });
  return scope;
}

/// Where a configuration is most wrong, with the worst fault that is seen, or else the cause; empty where nothing is
/// known.
std::string describe_wrong(const analysis::Configuration& configuration, const std::vector<analysis::Place>& places) {
  constexpr double kSeenRate = 0.01;
  const auto rmse_of = [](const records::CellRecord* cell) { return cell->error.rmse.value_or(0.0); };
  const records::CellRecord& worst = **std::ranges::max_element(configuration.cells, {}, rmse_of);
  if (rmse_of(&worst) <= 0.0) return {};
  const records::CellRecord* where = nullptr;
  const metrics::Metric* fault = nullptr;
  double most = kSeenRate;
  for (const metrics::Metric& metric : metrics::metric_table()) {
    if (metric.limit.empty() || metric.group() != "artefact" || metric.unit != "share") continue;
    for (const records::CellRecord* cell : configuration.cells) {
      if (metric.read(*cell).value_or(0.0) < most) continue;
      most = *metric.read(*cell);
      where = cell;
      fault = &metric;
    }
  }
  const auto name_place = [&](const records::CellRecord& cell) {
    return analysis::describe_place(analysis::place_of(cell), places);
  };
  const std::string at = places.size() > 1 ? "worst on " + name_place(worst) : "";
  if (fault) {
    std::string seen = fmt::format("{} {}", fault->name(), records::format_rate(most));
    std::ranges::replace(seen, '_', ' ');
    if (at.empty()) return seen;
    return where == &worst ? at + ": " + seen : fmt::format("{}; {} on {}", at, seen, name_place(*where));
  }
  const auto shares = analysis::is_lost_in_truth(worst) ? std::nullopt : records::list_shares(worst);
  const auto part = shares ? analysis::find_dominating_part(*shares) : std::nullopt;
  return !part ? at : at + (at.empty() ? "" : ": ") + records::list_error_parts()[*part].meaning;
}

/// What a scope has of each configuration; null of those without a cell there.
json list_rows(const Scope& scope, const std::vector<analysis::Place>& places, const std::vector<Quantity>& choices) {
  json rows = json::array();
  for (const analysis::Configuration& each : scope.configurations) {
    if (each.cells.empty()) {
      rows.push_back(nullptr);
      continue;
    }
    json row = {{"worst", list_worst(each, places, choices)},
                {"rmse", describe_error(analysis::combine_rmse(each.cells))},
                {"seam", analysis::find_seam(each.cells)}};
    if (scope.scenes.empty()) row["wrong"] = describe_wrong(each, places);
    for (const Quantity& choice : choices) row[choice.full_field()] = describe_cost(each.cells, choice);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// What advise() says without limits, by cost and class of width: configurations in the order of their costs, with
/// their ties, and why others are not judged.
json list_advice(const std::vector<records::CellRecord>& cells, const Scope& scope,
                 const std::vector<std::string>& classes, const std::vector<Quantity>& choices,
                 const std::map<const records::CellRecord*, std::size_t>& indices) {
  const auto index_of = [&](const auto& each) { return indices.at(each.configuration.cells.front()); };
  json all = json::object();
  for (const Quantity& choice : choices) {
    for (const std::string& wide : classes) {
      analysis::AdviceRequest request;
      request.light = choice.light;
      request.cheapest = *choice.cost;
      request.width_class = wide;
      request.scenes = scope.scenes;
      request.whole = true;
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

/// Classes that the scope's configurations have, and that of any width, whose name is empty.
std::vector<std::string> list_classes_of(const Scope& scope, const std::vector<std::string>& classes) {
  std::vector<std::string> own = {""};
  for (const std::string& name : classes)
    if (std::ranges::any_of(scope.configurations, [&](const analysis::Configuration& each) {
          return !each.cells.empty() && records::is_advised(*each.cells.front()) &&
                 each.cells.front()->kernel.width_class == name;
        }))
      own.push_back(name);
  return own;
}

}  // namespace

std::vector<Quantity> list_cost_choices(const records::RunRecord& run, const std::vector<records::CellRecord>& cells) {
  std::vector<Quantity> choices = analysis::list_cost_measures(cells);
  std::erase_if(choices, [](const Quantity& each) { return !each.cost->is_of_frame(); });
  for (Quantity& choice : choices) {
    choice.unit = analysis::unit_of(choice, run.gl);
    if (choice.is(analysis::CostKind::kTime))
      choice.title = fmt::format("{} light, this {}", choice.id, run.gl.software ? "CPU" : "GPU");
  }
  return choices;
}

json describe_error(const std::optional<analysis::Estimate>& error) {
  if (!error) return {};
  const std::size_t count = error->replicates.size();
  return {{"value", error->value},
          {"reach", error->high - error->value},
          {"replicates", error->replicates},
          {"t", count > 1 ? json(metrics::find_student_t(count)) : json()}};
}

std::string describe_setting(const std::vector<records::CellRecord>& cells) {
  std::set<std::string> scenes, filters, maps, sizes;
  for (const records::CellRecord& cell : cells) {
    scenes.insert(cell.scene);
    filters.insert(cell.filter);
    maps.insert(fmt::format("{}²", cell.map_size));
    sizes.insert(fmt::format("{} × {}", cell.width, cell.height));
  }
  const auto count = [](const std::set<std::string>& all, const char* kind) {
    return all.size() == 1 ? *all.begin() : fmt::format("{} {}", all.size(), kind);
  };
  return fmt::format("{} · map {} · {} · {} filter{}", count(scenes, "scenes"), fmt::join(maps, ", "),
                     count(sizes, "sizes"), filters.size(), filters.size() == 1 ? "" : "s");
}

std::array<double, 4> choose_part(const records::CellRecord& cell) {
  const double across = cell.width, down = cell.height;
  if (!cell.images.hardest) return {0.0, 0.0, across, down};
  const records::TileRecord& tile = *cell.images.hardest;
  const double width = std::min(across, std::max(kMostShown, across / 2.0)), height = std::min(down, width / kShape);
  return {std::clamp(tile.left + 0.5 * (tile.width - width), 0.0, across - width),
          std::clamp(tile.top + 0.5 * (tile.height - height), 0.0, down - height), width, height};
}

json describe_cost(const std::vector<const records::CellRecord*>& cells, const Quantity& choice) {
  const auto cost = analysis::measure_cost(cells, *choice.cost, choice.light);
  return cost ? json(cost->mean) : json();
}

std::vector<std::string> list_answered_scenes(const std::vector<records::CellRecord>& cells) {
  std::vector<std::string> scenes;
  for (const records::CellRecord& cell : cells)
    if (records::is_advised(cell) && std::ranges::count(scenes, cell.scene) == 0) scenes.push_back(cell.scene);
  return scenes.size() < 2 || cells.size() > kMostCellsInDetail ? std::vector<std::string>() : scenes;
}

std::string describe_biases(const analysis::Configuration& configuration,
                            const std::vector<records::BiasCell>& biases) {
  std::vector<std::string> texts;
  for (const records::BiasCell& bias : biases)
    if (std::ranges::any_of(configuration.cells, [&](const auto* cell) { return bias.is_of(*cell); }))
      texts.push_back(fmt::format("{}: {}", bias.scene, describe_bias(bias)));
  return fmt::format("{}", fmt::join(texts, "; "));
}

json make_answer_data(const std::vector<records::CellRecord>& cells,
                      const std::vector<analysis::Configuration>& configurations,
                      const std::vector<std::string>& classes, const std::vector<Quantity>& choices) {
  const std::vector<const records::CellRecord*> all = analysis::point_to(cells);
  const std::vector<analysis::Place> places = analysis::list_places(all);
  std::map<const records::CellRecord*, std::size_t> indices;
  for (std::size_t i = 0; i < configurations.size(); ++i)
    for (const records::CellRecord* cell : configurations[i].cells) indices[cell] = i;
  std::vector<Scope> scopes = {make_scope({}, configurations)};
  for (const std::string& scene : list_answered_scenes(cells)) scopes.push_back(make_scope({scene}, configurations));
  const auto explain_absence = [&](const std::string& scene) -> json {  // from the choice for all scenes
    const auto is_counted = [&](const analysis::Configuration& each) {
      return std::ranges::count(each.cells, scene, &records::CellRecord::scene) > 0;
    };
    const auto found =
        std::ranges::find(scopes.front().left_out, scene, [](const auto& each) { return each.place.scene; });
    const bool is_left_out = found != scopes.front().left_out.end();
    if (!is_left_out || std::ranges::any_of(scopes.front().configurations, is_counted)) return nullptr;
    return analysis::describe_state(found->state);
  };
  json data = json::array();
  for (const Scope& scope : scopes) {
    const std::string scene = scope.scenes.empty() ? "" : scope.scenes.front();
    analysis::AdviceRequest request;
    request.scenes = scope.scenes;
    const std::string judged = analysis::describe_judged_lights(analysis::advise(cells, request));
    data.push_back({{"scene", scene.empty() ? json() : json(scene)},
                    {"left_out", explain_absence(scene)},
                    {"judged", judged.empty() ? judged : judged + "."},
                    {"rows", list_rows(scope, places, choices)},
                    {"advice", list_advice(cells, scope, list_classes_of(scope, classes), choices, indices)}});
  }
  return data;
}

namespace {

json value_of(const std::optional<double>& value) { return value && std::isfinite(*value) ? json(*value) : json(); }

json path_of(const std::optional<std::string>& path) { return path ? json(encode_url_path(*path)) : json(); }

json make_measure(const Quantity& quantity) {
  static constexpr const char* kBetter[] = {"less", "more", "zero", "neither"};
  const metrics::Metric* metric = quantity.metric;
  const auto direction = metric ? metric->direction : metrics::MetricDirection::kLess;
  return {{"id", quantity.full_field()},
          {"title", quantity.title},
          {"text", quantity.meaning},
          {"unit", quantity.unit},
          {"option", quantity.option},
          {"group", metric ? metric->group() : "cost"},
          {"better", kBetter[static_cast<std::size_t>(direction)]}};
}

/// Everything that the table can show, and that limits can be set on: of what a frame costs in milliseconds, once.
json list_measures(std::vector<Quantity> quantities) {
  quantities.front().option = analysis::cost_spec(*quantities.front().cost).option;
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.tabled || !metric.limit.empty()) quantities.push_back(Quantity::of(metric));
  json measures = json::array();
  for (const Quantity& each : quantities) measures.push_back(make_measure(each));
  return measures;
}

/// How `advise` is asked for a cost, where `usual` is what it takes without.
std::string write_cost_options(const Quantity& choice, const analysis::CostKind& usual) {
  std::vector<std::string> options;
  if (*choice.cost != usual)
    options.push_back("--cheapest " + (choice.cost->gpu.empty() ? "time" : "gpu:" + choice.cost->gpu));
  if (choice.light == analysis::LightMotion::kStatic) options.emplace_back("--light-motion static");
  return fmt::format("{}", fmt::join(options, " "));
}

json list_values(const records::CellRecord& cell, const std::vector<Quantity>& costs) {
  json values;
  for (const Quantity& cost : costs) values[cost.full_field()] = describe_cost({&cell}, cost);
  for (const metrics::Metric& metric : metrics::metric_table())
    if (metric.tabled || !metric.limit.empty()) values[std::string(metric.path)] = value_of(metric.read(cell));
  return values;
}

/// Of times the 95 % intervals, or the quartiles where there are none.
json list_intervals(const records::CellRecord& cell, const std::vector<Quantity>& costs) {
  json intervals = json::object();
  for (const Quantity& choice : costs) {
    if (!choice.is(analysis::CostKind::kTime)) continue;
    const auto cost = analysis::measure_cost({&cell}, *choice.cost, choice.light);
    if (!cost) continue;
    const records::Interval& interval = cost->ci95 ? *cost->ci95 : cost->quartiles;
    intervals[choice.full_field()] = {interval.low, interval.high};
  }
  return intervals;
}

json make_cell(const records::CellRecord& cell, std::size_t configuration, std::size_t place,
               const std::vector<Quantity>& costs) {
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
  const std::string settings = records::describe_settings(cell).substr(std::string("view ").size() + cell.view.size()),
                    params = records::describe_params(records::named_params(cell));
  if (cell.external) return fmt::format("{} · {}", cell.filter, describe_engine(*cell.external));
  return cell.filter + (params.empty() ? "" : " · " + params) + settings;
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
                        const std::vector<Quantity>& choices, const std::vector<records::BiasCell>& biases) {
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
               {"hardens", analysis::hardens(configuration.cells)}};
  for (const Quantity& choice : choices)
    made[choice.full_field()] = counted.empty() ? json() : describe_cost(counted, choice);
  return made;
}

}  // namespace

json make_run_data(const records::RunRecord& run, const std::vector<records::CellRecord>& cells,
                   const std::vector<records::BiasCell>& biases) {
  const std::vector<const records::CellRecord*> all = analysis::point_to(cells);
  const std::vector<analysis::Place> places = analysis::list_places(all);
  const std::vector<std::string> filters = analysis::list_filters(cells);
  const std::vector<Quantity> choices = list_cost_choices(run, cells);
  json data{{"files", records::value_json(run.filter_files)},
            {"measures", list_measures(choices)},
            {"costs", json::array()},
            {"cost", choices.front().id},
            {"words", analysis::answer_words()},
            {"most_of_tie", analysis::kMostOfTie},
            {"setting", describe_setting(cells)},
            {"classes", json::array()},
            {"places", json::array()},
            {"truths", json::array()},
            {"configurations", json::array()},
            {"cells", json::array()}};
  for (const Quantity& choice : choices)
    data["costs"].push_back({{"id", choice.id},
                             {"field", choice.full_field()},
                             {"title", choice.title},
                             {"unit", choice.unit},
                             {"option", write_cost_options(choice, *choices.front().cost)},
                             {"text", choice.meaning},
                             {"gpu", choice.cost->gpu}});
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
