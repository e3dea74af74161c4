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

constexpr std::size_t kMostListed = 8;

Row describe_candidate(const records::RunRecord& run, const analysis::Advice& advice,
                       const analysis::Candidate& candidate, std::string more) {
  return {candidate.configuration.name, analysis::format_cost(candidate.cost.mean, advice.request.cheapest, run.gl),
          candidate.rmse ? "RMSE " + records::format_number(candidate.rmse->value) : "", std::move(more)};
}

std::string list_some(const char* title, std::vector<Row> rows) {
  if (rows.empty()) return "";
  const std::size_t count = rows.size();
  rows.resize(std::min(count, kMostListed));
  return fmt::format("{}{}:\n{}", title, count > kMostListed ? fmt::format(", {} of {}", kMostListed, count) : "",
                     align(rows));
}

/// What keeps the limits, beside the advised one.
std::string list_front(const records::RunRecord& run, const analysis::Advice& advice) {
  std::vector<Row> rows;
  for (std::size_t i = 1; i < advice.keeping.size(); ++i)
    rows.push_back(describe_candidate(run, advice, advice.keeping[i], ""));
  return list_some("Others on the front", std::move(rows));
}

/// What breaks limits, the nearest first; where something keeps them, what is cheaper than that.
std::string list_failing(const records::RunRecord& run, const analysis::Advice& advice) {
  std::vector<Row> rows;
  for (const analysis::Candidate& each : advice.failing)
    if (advice.keeping.empty() || each.cost.mean < advice.keeping.front().cost.mean)
      rows.push_back(describe_candidate(run, advice, each, "breaks " + analysis::describe_broken(advice, each)));
  return list_some(advice.keeping.empty() ? "Nearest to the limits" : "Cheaper, outside the limits", std::move(rows));
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

}  // namespace

std::string make_answer_text(const records::RunRecord& run, const analysis::Advice& advice) {
  return wrap(analysis::describe_choice(advice)) + list_picks(run, advice);
}

std::string make_advice_text(const records::RunRecord& run, const analysis::Advice& advice) {
  if (advice.places.empty()) return wrap(fmt::format("Nothing fits: {}.", analysis::describe_failure(advice)));
  std::vector<std::string> sections;
  if (advice.keeping.empty()) {
    sections = {"Nothing fits.\n", list_failing(run, advice)};
  } else {
    sections = {wrap(analysis::describe_choice(advice)),
                list_picks(run, advice),
                describe_answer(run, advice),
                list_limits(run, advice),
                list_cells(run, advice),
                list_front(run, advice),
                list_failing(run, advice)};
  }
  sections.push_back(list_remarks(run, advice));
  if (const std::string judged = analysis::describe_judged_lights(advice); !judged.empty())
    sections.insert(sections.begin(), wrap(judged + "."));
  std::erase(sections, "");
  return fmt::format("{}", fmt::join(sections, "\n"));
}

namespace {

using nlohmann::json;
using records::value_json;

std::string name_of(const analysis::CostKind& cost) {
  switch (cost.kind) {
    case analysis::CostKind::kTime: return "time";
    case analysis::CostKind::kBytes: return "bytes";
    case analysis::CostKind::kFetches: return "fetches";
    case analysis::CostKind::kGpu: break;
  }
  return "gpu:" + cost.gpu;
}

json list_json(const auto& items, const auto& write) {
  json list = json::array();
  for (const auto& each : items) list.push_back(write(each));
  return list;
}

/// Where a cell was measured; its numbers are in results.json, under its key.
json cell_json(const records::CellRecord& cell) {
  return {{"key", cell.key}, {"scene", cell.scene}, {"view", cell.view}};
}

json verdict_json(const analysis::Demand& demand, const analysis::Verdict& verdict) {
  json written = {{"option", demand.spec ? demand.spec->option : "--requires"}, {"kept", verdict.kept}};
  if (!demand.spec) {
    written["claim"] = analysis::kContactHardening;
    return written;
  }
  written.update({{"field", demand.spec->field},
                  {"most", demand.most},
                  {"worst", *verdict.worst},
                  {"within_uncertainty", verdict.uncertain != nullptr}});
  written.update(cell_json(*verdict.where));
  written["nothing_to_see"] = list_json(verdict.nothing_to_see, [&](const auto* cell) {
    return json{
        {"scene", cell->scene}, {"view", cell->view}, {"reason", records::explain_absence(*cell, demand.spec->field)}};
  });
  return written;
}

json candidate_json(const analysis::Candidate& candidate, const analysis::Advice& advice) {
  const analysis::AdviceRequest& request = advice.request;
  json settings = records::cell_settings(*candidate.configuration.cells.front());
  settings.erase("scene");
  settings.erase("view");
  json limits = json::array();
  for (std::size_t i = 0; i < candidate.verdicts.size(); ++i)
    limits.push_back(verdict_json(request.demands[i], candidate.verdicts[i]));
  return {{"label", candidate.configuration.name},
          {"settings", std::move(settings)},
          {"cost",
           {{"mean", candidate.cost.mean},
            {"quartiles", value_json(candidate.cost.quartiles)},
            {"ci95", value_json(candidate.cost.ci95)}}},
          {"rmse", candidate.rmse ? json(candidate.rmse->value) : json()},
          {"limits", std::move(limits)},
          {"cells", list_json(candidate.configuration.cells, [&](const auto* cell) {
             json written = cell_json(*cell);
             written["cost"] = *analysis::cost_spec(request.cheapest).read(*cell, request.light);
             written["rmse"] = cell->error.rmse ? json(*cell->error.rmse) : json();
             return written;
           })}};
}

json request_json(const analysis::Advice& advice) {
  const analysis::AdviceRequest& request = advice.request;
  json limits = json::object(), claims = json::array();
  for (const analysis::Demand& demand : request.demands)
    if (demand.spec)
      limits[demand.spec->option] = demand.most;
    else
      claims.push_back(analysis::kContactHardening);
  return {{"limits", limits},
          {"requires", claims},
          {"light_motion", request.light == analysis::LightMotion::kMoving ? "moving" : "static"},
          {"cheapest", name_of(request.cheapest)},
          {"places", list_json(advice.places, [](const auto& place) {
             return json{{"scene", place.scene}, {"view", place.view}};
           })}};
}

json pick_json(const analysis::Pick& pick, const analysis::Advice& advice) {
  json written = candidate_json(advice.keeping[pick.index], advice);
  return {{"name", fmt::format("{}", fmt::join(pick.names, " and "))},
          {"label", written["label"]},
          {"why", pick.why},
          {"settings", written["settings"]},
          {"cost", written["cost"]["mean"]},
          {"rmse", written["rmse"]}};
}

}  // namespace

json make_advice_json(const records::RunRecord& run, const analysis::Advice& advice) {
  const bool fits = !advice.keeping.empty();
  const auto write_candidate = [&](const auto& each) { return candidate_json(each, advice); };
  const auto name = [](const auto& each) { return each.configuration.name; };
  const auto [judged, of] = analysis::count_judged_lights(advice);
  return {{"fits", fits},
          {"commit", run.commit},
          {"clock", records::describe_clock(run.gl)},
          {"time_unit", records::time_unit(run.gl)},
          {"software", run.gl.software},
          {"renderer", run.gl.renderer},
          {"asked", request_json(advice)},
          {"choice", fits ? analysis::describe_choice(advice) : analysis::describe_failure(advice)},
          {"picks", list_json(fits ? analysis::list_picks(advice) : std::vector<analysis::Pick>(),
                              [&](const auto& pick) { return pick_json(pick, advice); })},
          {"keeping", list_json(advice.keeping, write_candidate)},
          {"failing", list_json(advice.failing, write_candidate)},
          {"beaten", list_json(advice.beaten, name)},
          {"no_better_than_none", list_json(advice.no_gain, name)},
          {"not_judged", list_json(advice.unjudged,
                                   [&](const auto& each) {
                                     return json{{"label", name(each)}, {"reason", each.reason}};
                                   })},
          {"left_out", list_json(advice.left_out,
                                 [](const auto& each) {
                                   return json{{"scene", each.place.scene},
                                               {"view", each.place.view},
                                               {"tested", each.is_tested()},
                                               {"why", analysis::describe_state(each.state)}};
                                 })},
          {"lights", {{"judged", judged}, {"of", of}}},
          {"cost", analysis::describe_cost(advice)},
          {"notes", analysis::list_advice_notes(advice, run.gl)}};
}

}  // namespace shadowbench::pages
