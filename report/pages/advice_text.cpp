#include "report/pages/advice_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "report/analysis/advice.h"
#include "report/analysis/advice_words.h"
#include "report/analysis/cells.h"
#include "report/document/markdown.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"
#include "report/records/json_values.h"
#include "report/records/records.h"

namespace shadowbench::pages {
namespace {

constexpr std::size_t kColumns = 100;

using Row = std::vector<std::string>;

std::string align(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], document::count_shown(row[i]));
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line = " ";
    for (std::size_t i = 0; i < row.size(); ++i)
      line += fmt::format(" {}{} ", row[i], std::string(widths[i] - document::count_shown(row[i]), ' '));
    line.resize(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string wrap(const std::string& text) { return document::wrap(text, kColumns, 2) + "\n"; }

std::string place_name(const records::CellRecord& cell, const analysis::Advice& advice) {
  return analysis::describe_place(analysis::place_of(cell), advice.places);
}

std::string remark(const analysis::Demand& demand, const analysis::Verdict& verdict, analysis::LightMotion light) {
  if (verdict.uncertain) {
    return fmt::format("kept by less than {}, {}",
                       verdict.uncertain->rmse_ci95 ? "its interval over the phases of the map reaches"
                                                    : "the truth's own standard error",
                       records::format_number(analysis::find_rmse_reach(*verdict.uncertain)));
  }
  if (demand.spec == &analysis::cost_spec(analysis::CostKind::kTime)) {
    const double q3 = analysis::frame_time(*verdict.where, light)->q3;
    if (q3 > demand.most) return fmt::format("its upper quartile, {}, is over it", records::format_number(q3));
  }
  return "";
}

Row describe_limit(const analysis::Demand& demand, const analysis::Verdict& verdict, const records::RunRecord& run,
                   const analysis::Advice& advice) {
  if (!verdict.worst) return {analysis::describe_demand(demand), "shown"};
  const bool is_time = demand.spec == &analysis::cost_spec(analysis::CostKind::kTime);
  const std::string unit = is_time                                     ? " " + records::time_unit(run.gl)
                           : demand.spec->is(analysis::CostKind::kGpu) ? " ms"
                                                                       : "";
  const std::string worst = analysis::format_kept(*verdict.worst, demand.most);
  return {analysis::describe_demand(demand), worst + unit, place_name(*verdict.where, advice),
          remark(demand, verdict, advice.request.light)};
}

std::string list_limits(const records::RunRecord& run, const analysis::Advice& advice) {
  if (advice.request.demands.empty()) return "";
  std::vector<Row> rows = {{"limit", "worst", "on"}};
  for (std::size_t i = 0; i < advice.request.demands.size(); ++i)
    rows.push_back(describe_limit(advice.request.demands[i], advice.keeping.front().verdicts[i], run, advice));
  return align(rows);
}

/// The cost of a frame that the table has: the estimate that was asked for, else the time.
std::optional<analysis::Cost> measure_shown(const records::CellRecord& cell, const analysis::Advice& advice) {
  const analysis::CostKind& asked = advice.request.cheapest;
  const bool is_estimate = asked.kind == analysis::CostKind::kGpu;
  return analysis::measure_cost({&cell}, is_estimate ? asked : analysis::CostKind::kTime, advice.request.light);
}

/// A ratio to no filter, and whether its interval is wider than it.
std::string describe_ratio(const std::optional<records::Ratio>& ratio) {
  const bool is_imprecise = ratio && ratio->ci95.high - ratio->ci95.low > ratio->median;
  return records::format_ratio(ratio) + (is_imprecise ? " imprecise" : "");
}

Row describe_cell(const records::CellRecord& cell, const analysis::Advice& advice) {
  const bool is_estimate = advice.request.cheapest.kind == analysis::CostKind::kGpu;
  const auto cost = measure_shown(cell, advice);
  return {place_name(cell, advice),
          cost ? records::format_number(cost->mean) : records::kNothing,
          cost && !is_estimate ? fmt::format("{} .. {}", records::format_number(cost->quartiles.low),
                                             records::format_number(cost->quartiles.high))
                               : records::kNothing,
          describe_ratio(analysis::frame_ratio(cell, advice.request.light)),
          records::format_number(cell.error.rmse),
          cell.cost.map_bytes ? records::format_bytes(static_cast<double>(*cell.cost.map_bytes)) : records::kNothing,
          records::format_number(cell.cost.fetches)};
}

std::string list_cells(const records::RunRecord& run, const analysis::Advice& advice) {
  const std::string& gpu = advice.request.cheapest.gpu;
  std::vector<Row> rows = {{"scene", gpu.empty() ? records::time_unit(run.gl) : "ms, " + gpu, "quartiles",
                            "/ none [95 %]", "RMSE", "map", "fetches"}};
  bool timed = false;
  for (const records::CellRecord* cell : advice.keeping.front().configuration.cells) {
    rows.push_back(describe_cell(*cell, advice));
    timed = timed || measure_shown(*cell, advice);
  }
  for (Row& row : rows)
    if (!timed) row.erase(row.begin() + 1, row.begin() + 3);
  return align(rows);
}

std::string describe_second(const records::RunRecord& run, const analysis::Advice& advice) {
  if (advice.keeping.size() < 2) return "Runner-up: no other configuration on the front keeps the limits.\n";
  const analysis::Candidate& second = advice.keeping[1];
  return wrap(fmt::format("Runner-up: {}, {}; {}.", second.configuration.name,
                          analysis::format_cost(second.cost.mean, advice.request.cheapest, run.gl),
                          analysis::describe_runner_up(advice, run.gl)));
}

Row describe_relaxation(const records::RunRecord& run, const analysis::Advice& advice, std::size_t demand,
                        const analysis::Candidate& candidate) {
  const std::string limit = analysis::describe_demand(advice.request.demands[demand]);
  const auto worst = candidate.verdicts[demand].worst;
  const analysis::CostKind kind = advice.request.cheapest;
  const double of = advice.keeping.front().cost.mean;
  const double saved = analysis::compare_costs(candidate, advice.keeping.front(), kind).difference;
  return {worst ? fmt::format("{} -> {}", limit, analysis::format_limit(*worst)) : "without " + limit,
          fmt::format("saves {} ({:.0f} %)", analysis::format_cost(saved, kind, run.gl),
                      of > 0.0 ? 100.0 * saved / of : 0.0),
          candidate.configuration.name};
}

std::string list_relaxations(const records::RunRecord& run, const analysis::Advice& advice) {
  const auto buys_nothing = [](const analysis::Obstacle& each) { return each.buys.empty(); };
  if (advice.obstacles.empty()) return "";
  if (std::ranges::all_of(advice.obstacles, buys_nothing)) return "Relaxing one limit alone buys nothing.\n";
  std::vector<Row> rows;
  for (std::size_t i = 0; i < advice.obstacles.size(); ++i) {
    for (const std::size_t bought : advice.obstacles[i].buys)
      rows.push_back(describe_relaxation(run, advice, i, advice.failing[bought]));
    if (buys_nothing(advice.obstacles[i]))
      rows.push_back({analysis::describe_demand(advice.request.demands[i]), "relaxing it alone buys nothing"});
  }
  return fmt::format("A relaxed limit buys:\n{}", align(rows));
}

std::string list_obstacles(const analysis::Advice& advice) {
  std::vector<Row> rows = {{"limit", "fail it", "fail it alone", "no value", "would let through"}};
  for (std::size_t i = 0; i < advice.obstacles.size(); ++i) {
    const analysis::Obstacle& obstacle = advice.obstacles[i];
    Row row = {analysis::describe_demand(advice.request.demands[i]), fmt::format("{}", obstacle.failing),
               fmt::format("{}", obstacle.alone.size()), fmt::format("{}", obstacle.unknown)};
    if (!obstacle.alone.empty()) {
      const analysis::Candidate& nearest = advice.failing[obstacle.alone.front()];
      const auto worst = nearest.verdicts[i].worst;
      row.push_back((worst ? analysis::format_limit(*worst) : "none") + ": " + nearest.configuration.name);
    }
    rows.push_back(row);
  }
  return align(rows);
}

std::string list_remarks(const records::RunRecord& run, const analysis::Advice& advice) {
  const std::size_t judged =
      advice.keeping.size() + advice.beaten.size() + advice.no_gain.size() + advice.failing.size();
  std::vector<std::string> places;
  for (const analysis::Place& place : advice.places) places.push_back(analysis::describe_place(place, advice.places));
  std::string text = wrap(fmt::format("{} of {} configurations judged, on {}.", judged, judged + advice.unjudged.size(),
                                      fmt::join(places, ", ")));
  for (const std::string& reason : analysis::count_unjudged(advice)) text += wrap("Not judged, " + reason + ".");
  text += wrap(analysis::describe_cost(advice));
  for (const std::string& note : analysis::list_advice_notes(advice, run.gl)) text += wrap(note);
  return text;
}

/// Fast, balanced and best, a line each; nothing where one configuration is left.
std::string list_picks(const records::RunRecord& run, const analysis::Advice& advice) {
  if (advice.keeping.size() < 2) return "";
  std::vector<Row> rows;
  for (const analysis::Pick& pick : analysis::list_picks(advice)) {
    const analysis::Candidate& candidate = advice.keeping[pick.index];
    rows.push_back({fmt::format("{}:", fmt::join(pick.names, " and ")), candidate.configuration.name,
                    analysis::format_cost(candidate.cost.mean, advice.request.cheapest, run.gl),
                    candidate.rmse ? "RMSE " + records::format_number(candidate.rmse->value) : "", pick.why});
  }
  return align(rows);
}

std::string describe_answer(const records::RunRecord& run, const analysis::Advice& advice) {
  const analysis::Candidate& best = advice.keeping.front();
  const records::CellRecord& cell = *best.configuration.cells.front();
  std::vector<std::string> parts;
  if (cell.kernel.sigma_texels)
    parts.push_back(fmt::format("a kernel of {}", analysis::describe_kernel(best.configuration)));
  if (!cell.params.empty()) parts.push_back(records::describe_params(records::named_params(cell)));
  const std::string with = parts.empty() ? "" : wrap(fmt::format("with {}", fmt::join(parts, ", ")));
  return fmt::format("{}: {}{}; cheapest of {} on the front{}\n{}", best.configuration.name,
                     analysis::format_cost(best.cost.mean, advice.request.cheapest, run.gl),
                     analysis::describe_frame(advice.request), advice.keeping.size(),
                     advice.request.demands.empty() ? "" : " that keep the limits", with);
}

std::string describe_nearest(const analysis::Advice& advice) {
  return advice.closest ? wrap(analysis::describe_closest(advice) + ".") : "";
}

}  // namespace

std::string make_answer_text(const records::RunRecord& run, const analysis::Advice& advice) {
  return wrap(analysis::describe_choice(advice)) + list_picks(run, advice);
}

std::string make_advice_text(const records::RunRecord& run, const analysis::Advice& advice) {
  if (advice.places.empty()) return wrap(fmt::format("Nothing fits: {}.", analysis::describe_failure(advice)));
  std::vector<std::string> sections;
  if (advice.keeping.empty()) {
    sections = {"Nothing fits.\n", list_obstacles(advice), describe_nearest(advice)};
  } else {
    sections = {wrap(analysis::describe_choice(advice)),
                list_picks(run, advice),
                describe_answer(run, advice),
                list_limits(run, advice),
                list_cells(run, advice),
                describe_second(run, advice),
                list_relaxations(run, advice)};
  }
  sections.push_back(list_remarks(run, advice));
  if (const std::string judged = analysis::describe_judged_lights(advice); !judged.empty())
    sections.insert(sections.begin(), wrap(judged + "."));
  std::erase(sections, "");
  return fmt::format("{}", fmt::join(sections, "\n"));
}

namespace {

using Json = nlohmann::ordered_json;

std::string name_of(const analysis::CostKind& cost) {
  switch (cost.kind) {
    case analysis::CostKind::kTime: return "time";
    case analysis::CostKind::kBytes: return "bytes";
    case analysis::CostKind::kFetches: return "fetches";
    case analysis::CostKind::kGpu: break;
  }
  return "gpu:" + cost.gpu;
}

const char* name_of(analysis::Basis basis) {
  switch (basis) {
    case analysis::Basis::kExact: return "exact";
    case analysis::Basis::kInterval: return "ci95";
    case analysis::Basis::kQuartiles: break;
  }
  return "quartiles";
}

constexpr const char* kClaim = "a claim has no size";

Json interval_json(const records::Interval& interval) { return Json::array({interval.low, interval.high}); }

// Sets a value, or null and the reason.
template <class T>
void set(Json& object, const char* name, const std::optional<T>& value, const std::string& reason) {
  object[name] = value ? Json(records::value_json(*value)) : Json(nullptr);
  if (!value) object["absent"][name] = reason;
}

Json cell_json(const records::CellRecord& cell, const analysis::AdviceRequest& request) {
  const analysis::LightMotion light = request.light;
  Json json = {{"key", cell.key}, {"scene", cell.scene}, {"view", cell.view}};
  json["absent"] = Json::object();
  set(json, "cost", analysis::cost_spec(request.cheapest).read(cell, light),
      records::explain_absence(cell, analysis::cost_spec(request.cheapest).field));
  const auto& time = analysis::frame_time(cell, light);
  set(json, "time_ms", time ? std::optional<records::Quartiles>(*time) : std::nullopt,
      records::explain_absence(cell, "time_ms"));
  set(json, "ratio_to_none", analysis::frame_ratio(cell, light), records::explain_absence(cell, "ratio_to_none"));
  set(json, "rmse", cell.error.rmse, records::explain_absence(cell, "error.rmse"));
  set(json, "truth_se", cell.truth.se, records::explain_absence(cell, "truth.se"));
  set(json, "map_bytes", cell.cost.map_bytes, records::explain_absence(cell, "cost.map_bytes"));
  set(json, "fetches", cell.cost.fetches, records::explain_absence(cell, "cost.fetches"));
  return json;
}

Json demand_json(const analysis::Demand& demand) {
  const auto* spec = demand.spec;
  const auto when = [](bool exists, const std::string& value) { return exists ? std::optional(value) : std::nullopt; };
  Json json = {{"option", spec ? spec->option : "--requires"}};
  json["absent"] = Json::object();
  set(json, "claim", when(!spec, demand.claim), "this is a limit");
  set(json, "field", when(spec, spec ? spec->field : ""), kClaim);
  set(json, "most", spec ? std::optional(demand.most) : std::nullopt, kClaim);
  return json;
}

Json nothing_to_see_json(const analysis::Demand& demand, const analysis::Verdict& verdict) {
  Json list = Json::array();
  for (const records::CellRecord* cell : verdict.nothing_to_see) {
    list.push_back({{"scene", cell->scene},
                    {"view", cell->view},
                    {"reason", records::explain_absence(*cell, demand.spec->field)}});
  }
  return list;
}

Json verdict_json(const analysis::Demand& demand, const analysis::Verdict& verdict) {
  const records::CellRecord* cell = verdict.where;
  const auto of_cell = [&](std::string records::CellRecord::*field) {
    return cell ? std::optional(cell->*field) : std::nullopt;
  };
  Json json = demand_json(demand);
  json["kept"] = verdict.kept;
  set(json, "worst", verdict.worst, kClaim);
  set(json, "scene", of_cell(&records::CellRecord::scene), kClaim);
  set(json, "view", of_cell(&records::CellRecord::view), kClaim);
  set(json, "key", of_cell(&records::CellRecord::key), kClaim);
  json["within_uncertainty"] = verdict.uncertain != nullptr;
  json["nothing_to_see"] = nothing_to_see_json(demand, verdict);
  return json;
}

Json settings_json(const records::CellRecord& cell) {
  auto settings = records::cell_settings(cell);
  settings.erase("scene");
  settings.erase("view");
  return settings;
}

Json cost_json(const analysis::Cost& cost) {
  Json json = {{"mean", cost.mean}, {"quartiles", interval_json(cost.quartiles)}, {"ci95", nullptr}};
  json["absent"] = Json::object();
  if (cost.ci95)
    json["ci95"] = interval_json(*cost.ci95);
  else
    json["absent"]["ci95"] = "only times have an interval";
  return json;
}

Json candidate_json(const analysis::Candidate& candidate, const analysis::Advice& advice) {
  Json json = {{"label", candidate.configuration.name}};
  json["settings"] = settings_json(*candidate.configuration.cells.front());
  json["cost"] = cost_json(candidate.cost);
  json["limits"] = Json::array();
  for (std::size_t i = 0; i < candidate.verdicts.size(); ++i)
    json["limits"].push_back(verdict_json(advice.request.demands[i], candidate.verdicts[i]));
  json["cells"] = Json::array();
  for (const records::CellRecord* cell : candidate.configuration.cells)
    json["cells"].push_back(cell_json(*cell, advice.request));
  return json;
}

Json gap_json(const analysis::CostGap& gap) {
  return {{"difference", gap.difference}, {"share", gap.share}, {"tied", gap.tied}, {"basis", name_of(gap.basis)}};
}

Json request_json(const analysis::Advice& advice) {
  const analysis::AdviceRequest& request = advice.request;
  Json json = {{"limits", Json::object()}, {"requires", Json::array()}};
  for (const analysis::Demand& demand : request.demands)
    if (demand.spec)
      json["limits"][demand.spec->option] = demand.most;
    else
      json["requires"].push_back(demand.claim);
  json["light_motion"] = request.light == analysis::LightMotion::kMoving ? "moving" : "static";
  json["cheapest"] = name_of(request.cheapest);
  json["places"] = Json::array();
  for (const analysis::Place& place : advice.places)
    json["places"].push_back({{"scene", place.scene}, {"view", place.view}});
  return json;
}

Json unjudged_json(const analysis::Advice& advice) {
  Json list = Json::array();
  for (const analysis::Unjudged& unjudged : advice.unjudged)
    list.push_back({{"label", unjudged.configuration.name}, {"reason", unjudged.reason}});
  return list;
}

Json relaxed_json(const analysis::Advice& advice) {
  Json list = Json::array();
  for (std::size_t i = 0; i < advice.obstacles.size(); ++i) {
    for (const std::size_t bought : advice.obstacles[i].buys) {
      const analysis::Candidate& candidate = advice.failing[bought];
      const auto saving = analysis::compare_costs(candidate, advice.keeping.front(), advice.request.cheapest);
      Json json = verdict_json(advice.request.demands[i], candidate.verdicts[i]);
      json["label"] = candidate.configuration.name;
      json["cost"] = candidate.cost.mean;
      json["saves"] = saving.difference;
      json["basis"] = name_of(saving.basis);
      list.push_back(json);
    }
  }
  return list;
}

Json obstacle_json(const analysis::Advice& advice, std::size_t i) {
  const analysis::Obstacle& obstacle = advice.obstacles[i];
  Json json = demand_json(advice.request.demands[i]);
  json["fail"] = obstacle.failing;
  json["fail_alone"] = obstacle.alone.size();
  json["no_value"] = obstacle.unknown;
  std::optional<std::string> label;
  std::optional<double> worst;
  if (!obstacle.alone.empty()) {
    const analysis::Candidate& nearest = advice.failing[obstacle.alone.front()];
    label = nearest.configuration.name;
    worst = nearest.verdicts[i].worst;
  }
  set(json, "nearest_label", label, "no configuration fails this alone");
  set(json, "nearest_worst", worst, label ? kClaim : "no configuration fails this alone");
  return json;
}

Json picks_json(const analysis::Advice& advice) {
  Json list = Json::array();
  if (advice.keeping.empty()) return list;
  for (const analysis::Pick& pick : analysis::list_picks(advice)) {
    const analysis::Candidate& candidate = advice.keeping[pick.index];
    Json json = {{"name", fmt::format("{}", fmt::join(pick.names, " and "))},
                 {"label", candidate.configuration.name},
                 {"why", pick.why}};
    json["settings"] = settings_json(*candidate.configuration.cells.front());
    json["cost"] = candidate.cost.mean;
    json["absent"] = Json::object();
    set(json, "rmse", candidate.rmse ? std::optional(candidate.rmse->value) : std::nullopt, "a place has none");
    list.push_back(json);
  }
  return list;
}

Json names_json(const std::vector<analysis::Candidate>& candidates) {
  Json list = Json::array();
  for (const analysis::Candidate& each : candidates) list.push_back(each.configuration.name);
  return list;
}

Json left_out_json(const analysis::Advice& advice) {
  Json list = Json::array();
  for (const analysis::LeftOutPlace& each : advice.left_out)
    list.push_back({{"scene", each.place.scene},
                    {"view", each.place.view},
                    {"tested", each.is_tested()},
                    {"why", analysis::describe_state(each.state)}});
  return list;
}

void set_answer(Json& json, const analysis::Advice& advice, const records::GlRecord& gl) {
  const bool fits = !advice.keeping.empty();
  json["advised"] = fits ? candidate_json(advice.keeping[0], advice) : Json(nullptr);
  json["runner_up"] = nullptr;
  json["closest"] = !fits && advice.closest ? candidate_json(advice.failing[*advice.closest], advice) : Json(nullptr);
  json["absent"] = Json::object();
  if (!fits) json["absent"]["advised"] = analysis::describe_failure(advice);
  if (json["closest"].is_null()) json["absent"]["closest"] = fits ? "the limits are kept" : "nothing could be judged";
  if (advice.keeping.size() < 2) {
    json["absent"]["runner_up"] = "no other configuration on the front keeps the limits";
    return;
  }
  json["runner_up"] = candidate_json(advice.keeping[1], advice);
  json["runner_up"]["lost_by"] =
      gap_json(analysis::compare_costs(advice.keeping[0], advice.keeping[1], advice.request.cheapest));
  json["runner_up"]["why"] = analysis::describe_runner_up(advice, gl);
}

}  // namespace

Json make_advice_json(const records::RunRecord& run, const analysis::Advice& advice) {
  Json json = {{"fits", !advice.keeping.empty()},
               {"commit", run.commit},
               {"clock", records::describe_clock(run.gl)},
               {"time_unit", records::time_unit(run.gl)},
               {"software", run.gl.software},
               {"renderer", run.gl.renderer},
               {"asked", request_json(advice)}};
  json["choice"] = analysis::answer_words().at("fails");
  if (!advice.keeping.empty()) json["choice"] = analysis::describe_choice(advice);
  json["picks"] = picks_json(advice);
  set_answer(json, advice, run.gl);
  json["relaxed"] = relaxed_json(advice);
  json["limits"] = Json::array();
  for (std::size_t i = 0; i < advice.obstacles.size(); ++i) json["limits"].push_back(obstacle_json(advice, i));
  json["beaten"] = names_json(advice.beaten);
  json["no_better_than_none"] = names_json(advice.no_gain);
  json["left_out"] = left_out_json(advice);
  const auto [judged, of] = analysis::count_judged_lights(advice);
  json["lights"] = {{"judged", judged}, {"of", of}};
  json["keep"] = advice.keeping.size();
  json["fail"] = advice.failing.size();
  json["not_judged"] = unjudged_json(advice);
  json["cost"] = analysis::describe_cost(advice);
  json["notes"] = analysis::list_advice_notes(advice, run.gl);
  return json;
}

}  // namespace shadowbench::pages
