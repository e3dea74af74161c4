#include "report/pages/answer/advice_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "report/analysis/advice_words.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/picks.h"
#include "report/document/markdown.h"
#include "report/records/format.h"

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

// Breaks a paragraph at spaces; all lines but the first are indented.
std::string wrap(const std::string& text) {
  std::string result, line;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (!line.empty() && document::count_shown(line) + 1 + document::count_shown(word) > kColumns) {
      result += line + "\n";
      line.assign(1, ' ');
    }
    if (!line.empty()) line += ' ';
    line += word;
    begin = end + 1;
  }
  return result + line + "\n";
}

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
  const std::string unit = is_time ? " " + records::time_unit(run.gl) : demand.spec->gpu.empty() ? "" : " ms";
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

Row describe_cell(const records::CellRecord& cell, const analysis::Advice& advice) {
  const bool is_estimate = advice.request.cheapest.kind == analysis::CostKind::kGpu;
  const auto cost = measure_shown(cell, advice);
  return {place_name(cell, advice),
          cost ? records::format_number(cost->mean) : records::kNothing,
          cost && !is_estimate ? fmt::format("{} .. {}", records::format_number(cost->quartiles.low),
                                             records::format_number(cost->quartiles.high))
                               : records::kNothing,
          records::format_ratio(analysis::frame_ratio(cell, advice.request.light)),
          records::format_number(cell.error.rmse),
          records::format_number(cell.cost.map_bytes),
          records::format_number(cell.cost.fetches),
          cell.key};
}

std::string list_cells(const records::RunRecord& run, const analysis::Advice& advice) {
  const std::string& gpu = advice.request.cheapest.gpu;
  std::vector<Row> rows = {{"scene", gpu.empty() ? records::time_unit(run.gl) : "ms, " + gpu, "quartiles",
                            "/ none [95 %]", "RMSE", "bytes", "fetches", "cell"}};
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

}  // namespace shadowbench::pages
