#include "report/analysis/advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <tuple>
#include <variant>

#include "base/error.h"
#include "base/text.h"
#include "report/analysis/cells.h"
#include "report/analysis/measures.h"
#include "report/records/format.h"
#include "report/records/records.h"

namespace shadowbench::analysis {
namespace {

constexpr const char* kGrowth = "penumbra.growth";
constexpr double kLeastGrowth = 0.5;  ///< nearer to the truth's 1 than to the 0 of one width for all

}  // namespace

std::string find_doubt(const std::vector<const records::CellRecord*>& cells) {
  const std::string doubt = fmt::format("'{}' is claimed, not shown: ", kContactHardening);
  const records::CellRecord* least = nullptr;
  for (const records::CellRecord* cell : cells)
    if (cell->penumbra.growth && (!least || *cell->penumbra.growth < *least->penumbra.growth)) least = cell;
  if (!least) return doubt + records::explain_absence(*cells.front(), kGrowth);
  if (*least->penumbra.growth >= kLeastGrowth) return "";
  return fmt::format("{}on {} its penumbrae widen by {} where the truth's widen by 1, and {} is the least", doubt,
                     least->scene, records::format_number(least->penumbra.growth), kLeastGrowth);
}

bool hardens(const std::vector<const records::CellRecord*>& cells) {
  return std::ranges::count(cells.front()->claims, kContactHardening) > 0 && find_doubt(cells).empty();
}

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr const char* kUnfiltered = "none";
constexpr const char* kRmseField = "error.rmse";

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::kUsage, message); }

void require_scenes(const std::vector<records::CellRecord>& cells, const std::vector<std::string>& wanted) {
  std::set<std::string> known;
  for (const records::CellRecord& cell : cells) known.insert(cell.scene);
  for (const std::string& scene : wanted) {
    if (known.contains(scene)) continue;
    refuse(fmt::format("--scene: the run has no '{}'; it has {}", scene, fmt::join(known, ", ")));
  }
}

void require_size(const std::vector<records::CellRecord>& cells, std::pair<int, int> wanted) {
  std::set<std::string> known;
  for (const records::CellRecord& cell : cells) {
    if (std::pair(cell.width, cell.height) == wanted) return;
    known.insert(fmt::format("{}x{}", cell.width, cell.height));
  }
  refuse(fmt::format("--size: the run has no pictures of {}x{}; it has {}", wanted.first, wanted.second,
                     fmt::join(known, ", ")));
}

// The cells that are asked about, but for those of places that say nothing of which filter is better.
std::vector<const records::CellRecord*> leave_out(std::vector<const records::CellRecord*> chosen, Advice& advice) {
  advice.left_out = list_left_out(chosen);
  std::erase_if(chosen, [&](const auto* cell) { return is_left_out(*cell, advice.left_out); });
  return chosen;
}

// The cells that are asked about, of every class. Those of filters for teaching are named in `teaching` instead.
std::vector<const records::CellRecord*> choose_cells(const std::vector<records::CellRecord>& cells,
                                                     const AdviceRequest& request, Advice& advice) {
  if (cells.empty()) throw Error(ErrorKind::kInput, "the run holds no cell: nothing can be advised; run it again");
  require_scenes(cells, request.scenes);
  if (request.size) require_size(cells, *request.size);
  std::vector<const records::CellRecord*> chosen;
  for (const records::CellRecord& cell : cells) {
    const bool scene_fits = request.scenes.empty() || std::ranges::count(request.scenes, cell.scene) > 0;
    const bool size_fits = !request.size || std::pair(cell.width, cell.height) == *request.size;
    if (!scene_fits || !size_fits || cell.external) continue;
    if (cell.teaching)
      advice.teaching.insert(cell.filter);
    else
      chosen.push_back(&cell);
  }
  if (chosen.empty() && !advice.teaching.empty())
    refuse(fmt::format("the run has filters for teaching alone ({}), which are not advised",
                       fmt::join(advice.teaching, ", ")));
  return leave_out(std::move(chosen), advice);
}

std::vector<const records::CellRecord*> choose_class(std::vector<const records::CellRecord*> cells,
                                                     const std::string& width_class) {
  if (width_class.empty() || cells.empty()) return cells;
  std::erase_if(cells, [&](const records::CellRecord* cell) { return cell->kernel.width_class != width_class; });
  if (cells.empty())
    refuse(fmt::format("--class: the run has no {} kernel; its tables say of each filter which it has", width_class));
  return cells;
}

// Says why a value cannot be had; empty where it can.
std::string find_gap(const std::vector<const records::CellRecord*>& cells, const Quantity& spec, LightMotion light,
                     const std::vector<Place>& places) {
  for (const records::CellRecord* cell : cells) {
    if (spec.read(*cell, light)) continue;
    return fmt::format("no {} on {}: {}", spec.field, describe_place(place_of(*cell), places),
                       records::explain_absence(*cell, spec.field));
  }
  return {};
}

std::string find_missing_cell(const Configuration& configuration, const std::vector<Place>& places) {
  for (const Place& place : places) {
    const auto cell = std::ranges::find_if(configuration.cells, [&](const auto* c) { return place_of(*c) == place; });
    if (cell == configuration.cells.end()) return "not measured on " + describe_place(place, places);
    if ((*cell)->status != records::CellStatus::kOk) {
      return fmt::format("{} on {} ({})", records::is_drawn(**cell) ? "wrong" : "did not finish",
                         describe_place(place, places), records::describe_status(**cell));
    }
  }
  return {};
}

Verdict judge_hardening(const Configuration& configuration) {
  if (std::ranges::count(configuration.cells.front()->claims, kContactHardening) == 0) return {false};
  Verdict verdict;
  verdict.absent = find_doubt(configuration.cells);
  verdict.kept = verdict.absent.empty();
  return verdict;
}

std::variant<Candidate, Unjudged> judge(const Configuration& configuration, const Advice& advice, bool needs_rmse) {
  const AdviceRequest& request = advice.request;
  if (std::string gap = find_missing_cell(configuration, advice.places); !gap.empty())
    return Unjudged{configuration, std::move(gap)};
  Candidate candidate{configuration, {}, {}, combine_rmse(configuration.cells)};
  candidate.seam = find_seam(configuration.cells);
  for (const Demand& demand : request.demands) {
    Verdict verdict =
        demand.spec ? judge_limit(configuration, demand, request.light, advice.places) : judge_hardening(configuration);
    if (!verdict.absent.empty()) return Unjudged{configuration, verdict.absent};
    candidate.verdicts.push_back(std::move(verdict));
  }
  std::string gap = find_gap(configuration.cells, cost_spec(request.cheapest), request.light, advice.places);
  if (gap.empty() && needs_rmse)
    gap = find_gap(configuration.cells, limit_of(kRmseField), request.light, advice.places);
  if (!gap.empty()) return Unjudged{configuration, std::move(gap)};
  candidate.cost = *measure_cost(configuration.cells, request.cheapest, request.light);
  return candidate;
}

double sum_times(const Candidate& candidate, LightMotion light) {
  double sum = 0.0;
  for (const records::CellRecord* cell : candidate.configuration.cells)
    sum += cost_spec(CostKind::kTime).read(*cell, light).value_or(kInfinity);
  return sum;
}

void sort_by_cost(std::vector<Candidate>& candidates, const AdviceRequest& request) {
  const auto key = [&](const Candidate& candidate) {
    return std::tuple(candidate.cost.mean, candidate.rmse ? candidate.rmse->value : kInfinity,
                      sum_times(candidate, request.light));
  };
  std::ranges::stable_sort(candidates, {}, key);
}

// Finds the cheapest configuration without a filter, whatever it keeps and how wide kernels are to be, and says of each
// candidate whether it is clearly better.
void compare_with_unfiltered(Advice& advice, const std::vector<const records::CellRecord*>& cells) {
  std::vector<Candidate> candidates;
  for (const Configuration& configuration : list_configurations(cells)) {
    if (configuration.cells.front()->filter != kUnfiltered) continue;
    if (!find_missing_cell(configuration, advice.places).empty()) continue;
    const auto cost = measure_cost(configuration.cells, advice.request.cheapest, advice.request.light);
    const auto rmse = combine_rmse(configuration.cells);
    if (cost && rmse) candidates.push_back({configuration, *cost, {}, rmse});
  }
  if (candidates.empty()) return;
  sort_by_cost(candidates, advice.request);
  const Candidate& cheapest = candidates.front();
  advice.unfiltered = cheapest.configuration.name;
  for (auto* list : {&advice.keeping, &advice.failing})
    for (Candidate& each : *list) each.gains = each.rmse && is_clearly_less_error(*each.rmse, *cheapest.rmse);
}

// Moves to another list what a test finds among candidates; both keep their order.
template <class Test>
std::vector<Candidate> take_out(std::vector<Candidate>& from, Test test) {
  const auto found = std::ranges::stable_partition(from, std::not_fn(test));
  std::vector<Candidate> taken(std::make_move_iterator(found.begin()), std::make_move_iterator(found.end()));
  from.erase(found.begin(), found.end());
  return taken;
}

// Keeps the front, of candidates that are sorted by cost and then RMSE: each must have less RMSE, or a smaller seam,
// than each before it that is kept.
void take_out_beaten(Advice& advice) {
  std::vector<std::pair<double, double>> kept;
  advice.beaten = take_out(advice.keeping, [&](const Candidate& each) {
    if (!each.rmse) return false;
    const std::pair own(each.rmse->value, each.seam);
    const auto covers = [&](const auto& other) { return other.first <= own.first && other.second <= own.second; };
    if (std::ranges::any_of(kept, covers)) return true;
    kept.push_back(own);
    return false;
  });
}

void take_out_no_gain(Advice& advice) {
  if (std::ranges::any_of(advice.keeping, &Candidate::gains))
    advice.no_gain = take_out(advice.keeping, std::not_fn(&Candidate::gains));
}

// How many limits a candidate breaks, and how far beyond one it is at most; beyond a limit of 0, or without a claim,
// infinitely.
std::pair<int, double> measure_excess(const Candidate& candidate, const std::vector<Demand>& demands) {
  std::pair<int, double> broken;
  for (std::size_t i = 0; i < demands.size(); ++i) {
    if (candidate.verdicts[i].kept) continue;
    const double worst = candidate.verdicts[i].worst.value_or(kInfinity);
    ++broken.first;
    broken.second = std::max(broken.second, demands[i].most > 0.0 ? worst / demands[i].most : kInfinity);
  }
  return broken;
}

void require_gpu(const std::vector<records::CellRecord>& cells, const std::string& gpu) {
  const std::vector<std::string> known = list_gpus(point_to(cells));
  if (known.empty()) throw Error(ErrorKind::kUsage, "the run has no costs on GPUs: run it again, with --gpu");
  if (std::ranges::find(known, gpu) == known.end())
    throw Error(ErrorKind::kUsage,
                fmt::format("the run has no costs on '{}'{}", gpu, did_you_mean_or_known(gpu, known)));
}

}  // namespace

bool limits_what_is_seen(const AdviceRequest& request) {
  return std::ranges::any_of(
      request.demands,
      [](const Demand& each) { return each.spec && each.spec->metric && each.spec->metric->group() != "cost"; });
}

Verdict judge_limit(const Configuration& configuration, const Demand& demand, LightMotion light,
                    const std::vector<Place>& places) {
  Verdict verdict;
  const Quantity& spec = *demand.spec;
  std::vector<const records::CellRecord*> telling;
  for (const records::CellRecord* cell : configuration.cells) {
    const bool tells = spec.read(*cell, light) || !records::has_nothing_to_see(*cell, spec.field);
    (tells ? telling : verdict.nothing_to_see).push_back(cell);
  }
  verdict.absent = telling.empty() ? fmt::format("no {} anywhere: {}", spec.field,
                                                 records::explain_absence(*configuration.cells.front(), spec.field))
                                   : find_gap(telling, spec, light, places);
  if (!verdict.absent.empty()) return verdict;
  const auto value_of = [&](const records::CellRecord* cell) { return *spec.read(*cell, light); };
  verdict.where = *std::ranges::max_element(telling, {}, value_of);
  verdict.worst = value_of(verdict.where);
  verdict.kept = *verdict.worst <= demand.most;
  for (const records::CellRecord* cell : telling)
    if (verdict.kept && spec.field == kRmseField && demand.most - value_of(cell) < find_rmse_reach(*cell))
      verdict.uncertain = cell;
  return verdict;
}

double find_seam(const std::vector<const records::CellRecord*>& cells) {
  double seam = 0.0;
  for (const records::CellRecord* cell : cells) seam = std::max(seam, cell->artefact.seam.value_or(0.0));
  return seam;
}

std::optional<Cost> measure_cost(const std::vector<const records::CellRecord*>& cells, const CostKind& kind,
                                 LightMotion light) {
  std::vector<Estimate> quartiles, ci95;
  for (const records::CellRecord* cell : cells) {
    const auto value = cost_spec(kind).read(*cell, light);
    if (!value) return std::nullopt;
    if (kind == CostKind::kTime) {
      const records::OwnTime& time = *frame_time(*cell, light);
      quartiles.push_back({*value, time.q1, time.q3});
      ci95.push_back({*value, time.ci95.low, time.ci95.high});
    } else {
      quartiles.push_back({*value, *value, *value});
    }
  }
  const Estimate mean = mean_over_scenes(quartiles);
  Cost cost{mean.value, {mean.low, mean.high}, {}};
  if (ci95.empty()) return cost;
  const Estimate interval = mean_over_scenes(ci95);
  cost.ci95 = records::Interval{interval.low, interval.high};
  return cost;
}

bool are_costs_tied(const Candidate& cheaper, const Candidate& dearer, const CostKind& kind) {
  const Cost &a = cheaper.cost, &b = dearer.cost;
  if (kind != CostKind::kTime) return b.mean <= a.mean;
  const bool alike = cheaper.configuration.surroundings == dearer.configuration.surroundings;
  return a.ci95 && b.ci95 && alike ? a.ci95->high >= b.ci95->low : a.quartiles.high >= b.quartiles.low;
}

Advice advise(const std::vector<records::CellRecord>& cells, const AdviceRequest& request) {
  if (request.cheapest.kind == CostKind::kGpu) require_gpu(cells, request.cheapest.gpu);
  Advice advice;
  advice.request = request;
  const std::vector<const records::CellRecord*> asked = choose_cells(cells, request, advice),
                                                chosen = choose_class(asked, request.width_class);
  advice.places = list_places(chosen);
  const bool has_errors = std::ranges::any_of(asked, [](const auto* cell) { return cell->error.rmse.has_value(); });
  for (const Configuration& configuration : list_configurations(chosen)) {
    auto verdict = judge(configuration, advice, has_errors);
    if (auto* unjudged = std::get_if<Unjudged>(&verdict)) {
      advice.unjudged.push_back(std::move(*unjudged));
      continue;
    }
    auto& candidate = std::get<Candidate>(verdict);
    const bool keeps = std::ranges::all_of(candidate.verdicts, &Verdict::kept);
    (keeps ? advice.keeping : advice.failing).push_back(std::move(candidate));
  }
  sort_by_cost(advice.keeping, advice.request);
  compare_with_unfiltered(advice, asked);
  if (!request.whole) take_out_beaten(advice);
  if (!request.whole && !limits_what_is_seen(request)) take_out_no_gain(advice);
  sort_by_cost(advice.failing, advice.request);
  std::ranges::stable_sort(advice.failing, {}, [&](const auto& each) { return measure_excess(each, request.demands); });
  return advice;
}

namespace {

constexpr const char* kNoBest = "; no best one is named, as RMSEs are too uncertain: take more --phases";

// How far a candidate is below the straight line between two others, in the plane where they are (0, 1) and (1, 0).
double measure_knee(const Candidate& fast, const Candidate& best, const Candidate& candidate) {
  const double cost = (candidate.cost.mean - fast.cost.mean) / (best.cost.mean - fast.cost.mean);
  const double error = (candidate.rmse->value - best.rmse->value) / (fast.rmse->value - best.rmse->value);
  return 1.0 - cost - error;
}

std::optional<std::size_t> find_best(const std::vector<Candidate>& keeping) {
  if (!std::ranges::all_of(keeping, [](const Candidate& each) { return each.rmse.has_value(); })) return std::nullopt;
  const auto value = [](const Candidate& each) { return each.rmse->value; };
  const Candidate& least = *std::ranges::min_element(keeping, {}, value);
  const auto best = std::ranges::find_if(
      keeping, [&](const Candidate& each) { return !is_clearly_less_error(*least.rmse, *each.rmse); });
  if (value(*best) > kMostOfTie * value(least)) return std::nullopt;
  return static_cast<std::size_t>(best - keeping.begin());
}

std::optional<std::size_t> find_knee(const std::vector<Candidate>& keeping, std::size_t last, const CostKind& kind) {
  const Candidate &fast = keeping.front(), &best = keeping[last];
  if (are_costs_tied(fast, best, kind)) return std::nullopt;
  std::optional<std::size_t> knee;
  double most = 0.0;
  for (std::size_t i = 1; i < last; ++i) {
    const double below = measure_knee(fast, best, keeping[i]);
    if (below <= most || !is_clearly_less_error(*keeping[i].rmse, *fast.rmse) || are_costs_tied(keeping[i], best, kind))
      continue;
    knee = i;
    most = below;
  }
  return knee;
}

// Of those whose cost and RMSE cannot be told from a pick's, the one with the smallest seam.
std::size_t avoid_seam(const std::vector<Candidate>& keeping, std::size_t pick, const CostKind& kind) {
  const Candidate& own = keeping[pick];
  std::size_t least = pick;
  for (std::size_t i = 0; own.rmse && i < keeping.size(); ++i) {
    const Candidate& other = keeping[i];
    if (other.seam >= keeping[least].seam || !other.rmse) continue;
    const bool tied = are_costs_tied(i < pick ? other : own, i < pick ? own : other, kind);
    if (tied && !is_clearly_less_error(*other.rmse, *own.rmse) && !is_clearly_less_error(*own.rmse, *other.rmse))
      least = i;
  }
  return least;
}

std::string explain_fast(const Advice& advice) {
  const bool gains = advice.keeping.front().gains && !limits_what_is_seen(advice.request);
  return fmt::format("the cheapest{}", gains                            ? " clearly better than " + advice.unfiltered
                                       : advice.request.demands.empty() ? ""
                                                                        : " that keeps the limits");
}

std::string explain_balanced(const Candidate& fast, const Candidate& knee, const Candidate& best) {
  const double gain = (fast.rmse->value - knee.rmse->value) / (fast.rmse->value - best.rmse->value);
  const double extra = (knee.cost.mean - fast.cost.mean) / (best.cost.mean - fast.cost.mean);
  return fmt::format(fmt::runtime(answer_words().at("balanced")), fmt::arg("gain", records::format_share(gain)),
                     fmt::arg("extra", records::format_share(extra)));
}

/// How many times the cost of the fast one; nothing where that cannot be said.
std::optional<double> compare_with_fast(const Candidate& fast, const Candidate& best, const CostKind& kind) {
  if (are_costs_tied(fast, best, kind) || fast.cost.mean <= 0.0) return std::nullopt;
  return best.cost.mean / fast.cost.mean;
}

std::string explain_best(const Candidate& fast, const Candidate& best, const CostKind& kind) {
  const auto times = compare_with_fast(fast, best, kind);
  return "the least RMSE" +
         (times ? fmt::format(", at {} times the cost of the fast one", records::format_number(*times)) : "");
}

std::vector<Pick> choose_picks(const Advice& advice) {
  const std::vector<Candidate>& keeping = advice.keeping;
  const CostKind& kind = advice.request.cheapest;
  std::vector<Pick> picks = {{{kFast}, 0, explain_fast(advice)}};
  const bool has_others = keeping.size() + advice.beaten.size() + advice.no_gain.size() > 1;
  const auto least = has_others ? find_best(keeping) : std::nullopt;
  if (!least && has_others && keeping.back().rmse) picks.front().why += kNoBest;
  if (!least) return picks;
  const std::size_t best = avoid_seam(keeping, *least, kind);
  if (best == 0) {
    picks.front().names.emplace_back(kBest);
    return picks;
  }
  if (const auto found = find_knee(keeping, *least, kind)) {
    const std::size_t knee = avoid_seam(keeping, *found, kind);
    if (knee != best)
      picks.push_back({{kBalanced}, knee, explain_balanced(keeping[0], keeping[knee], keeping[*least])});
  }
  picks.push_back({{kBest}, best, explain_best(keeping[0], keeping[best], kind)});
  return picks;
}

}  // namespace

std::vector<Pick> list_picks(const Advice& advice) {
  assert(!advice.keeping.empty());
  std::vector<Pick> picks = choose_picks(advice);
  for (Pick& pick : picks) {
    const Candidate& candidate = advice.keeping[pick.index];
    if (candidate.seam >= kVisibleSeam)
      pick.why += fmt::format("; its cascades show a seam of {}", records::format_number(candidate.seam));
  }
  return picks;
}

const std::map<std::string, std::string>& answer_words() {
  static const std::map<std::string, std::string> words = {
      {"unmeasured", "The cheapest is {fast}; its error was not measured."},
      {"fast", "Use {fast}."},
      {"both", "Use {fast}: the cheapest, with the least error."},
      {"best", "Use {fast}. Where shadows must look right, use {best}."},
      {"dearer", "Use {fast}. Where shadows must look right, pay {times} times as much for {best}."},
      {"less", ", {share} below no filter"},
      {"balanced", "{gain} of the quality gain for {extra} of the extra cost"},
      {"fails", "Nothing keeps these limits."},
      {"unjudged", "Nothing can be judged: a value, a time or a scene is missing for every filter."}};
  return words;
}

std::string describe_choice(const Advice& advice) {
  const std::vector<Pick> picks = choose_picks(advice);
  const Candidate &fast = advice.keeping.front(), &best = advice.keeping[picks.back().index];
  const bool has_best = picks.back().names.back() == kBest;
  const auto times = compare_with_fast(fast, best, advice.request.cheapest);
  const char* kind = !fast.rmse          ? "unmeasured"
                     : !has_best         ? "fast"
                     : picks.size() == 1 ? "both"
                     : times             ? "dearer"
                                         : "best";
  return fmt::format(fmt::runtime(answer_words().at(kind)), fmt::arg("fast", fast.configuration.name),
                     fmt::arg("best", best.configuration.name), fmt::arg("times", records::format_number(times)));
}

}  // namespace shadowbench::analysis
