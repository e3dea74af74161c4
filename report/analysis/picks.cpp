#include "report/analysis/picks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>

#include "report/analysis/advice_words.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr const char* kNoBest = "; no best one is named, as RMSEs are too uncertain: take more --phases";

bool are_costs_told_apart(const Candidate& cheaper, const Candidate& dearer, const CostKind& kind) {
  return !compare_costs(cheaper, dearer, kind).tied;
}

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
  if (!are_costs_told_apart(fast, best, kind)) return std::nullopt;
  std::optional<std::size_t> knee;
  double most = 0.0;
  for (std::size_t i = 1; i < last; ++i) {
    const double below = measure_knee(fast, best, keeping[i]);
    if (below <= most || !is_clearly_less_error(*keeping[i].rmse, *fast.rmse) ||
        !are_costs_told_apart(keeping[i], best, kind))
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
    const bool apart = are_costs_told_apart(i < pick ? other : own, i < pick ? own : other, kind);
    if (!apart && !is_clearly_less_error(*other.rmse, *own.rmse) && !is_clearly_less_error(*own.rmse, *other.rmse))
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
  if (!are_costs_told_apart(fast, best, kind) || fast.cost.mean <= 0.0) return std::nullopt;
  return best.cost.mean / fast.cost.mean;
}

std::string explain_best(const Candidate& fast, const Candidate& best, const CostKind& kind) {
  const auto times = compare_with_fast(fast, best, kind);
  return "the least RMSE" +
         (times ? fmt::format(", at {} times the cost of the fast one", records::format_number(*times)) : "");
}

[[maybe_unused]] bool is_beaten(const Candidate& candidate, const Advice& advice) {
  const auto beats_it = [&](const Candidate& other) { return beats(other, candidate); };
  return std::ranges::any_of(advice.keeping, beats_it) || std::ranges::any_of(advice.beaten, beats_it) ||
         std::ranges::any_of(advice.no_gain, beats_it);
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
    assert(!is_beaten(candidate, advice));
    if (const std::string beaten = describe_larger_map(candidate, advice.beaten); !beaten.empty())
      pick.why += "; " + beaten;
    if (candidate.seam >= kVisibleSeam)
      pick.why += fmt::format("; its cascades show a seam of {}", records::format_number(candidate.seam));
  }
  return picks;
}

const std::map<std::string, std::string>& answer_words() {
  static const std::map<std::string, std::string> words = {
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
  const char* kind = !has_best ? "fast" : picks.size() == 1 ? "both" : times ? "dearer" : "best";
  return fmt::format(fmt::runtime(answer_words().at(kind)), fmt::arg("fast", fast.configuration.name),
                     fmt::arg("best", best.configuration.name), fmt::arg("times", records::format_number(times)));
}

std::string describe_larger_map(const Candidate& candidate, const std::vector<Candidate>& others) {
  const records::CellRecord& own = *candidate.configuration.cells.front();
  const Candidate* least = nullptr;
  for (const Candidate& other : others) {
    const records::CellRecord& cell = *other.configuration.cells.front();
    if (cell.map_size < own.map_size && cell.filter != own.filter && beats(candidate, other) &&
        (!least || other.rmse->value < least->rmse->value))
      least = &other;
  }
  return least ? fmt::format("its larger map beats {}", least->configuration.name) : "";
}

}  // namespace shadowbench::analysis
