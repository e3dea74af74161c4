#include "report/analysis/picks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "report/analysis/advice_words.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

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
        !are_costs_told_apart(keeping[i], best, kind) || compare_costs(fast, keeping[i], kind).basis == Basis::kNone)
      continue;
    knee = i;
    most = below;
  }
  return knee;
}

std::string explain_fast(const Advice& advice) {
  return fmt::format("the {}{}", describe_choice(advice),
                     limits_what_is_seen(advice.request) ? " that keeps the limits"
                     : advice.compares_with_none         ? " that is clearly better than 'none'"
                                                         : "");
}

std::string explain_balanced(const Advice& advice, const Picks& picks) {
  const Candidate &fast = advice.keeping[picks.fast], &best = advice.keeping[*picks.best],
                  &knee = advice.keeping[*picks.balanced];
  return fmt::format(
      "{} of what the best one gains, for {} of what it costs more",
      records::format_share((fast.rmse->value - knee.rmse->value) / (fast.rmse->value - best.rmse->value)),
      records::format_share((knee.cost.mean - fast.cost.mean) / (best.cost.mean - fast.cost.mean)));
}

std::string explain_best(const Advice& advice, const Picks& picks) {
  const Candidate &fast = advice.keeping[picks.fast], &best = advice.keeping[*picks.best];
  if (!are_costs_told_apart(fast, best, advice.request.cheapest)) return "the least RMSE";
  if (fast.cost.mean <= 0.0) return "the least RMSE";
  return fmt::format("the least RMSE, at {} times the cost of the fast one",
                     records::format_number(best.cost.mean / fast.cost.mean));
}

}  // namespace

Picks find_picks(const Advice& advice) {
  assert(!advice.keeping.empty());
  Picks picks;
  const auto best = find_best(advice.keeping);
  if (!best || *best == picks.fast) return picks;
  picks.best = best;
  picks.balanced = find_knee(advice.keeping, *best, advice.request.cheapest);
  return picks;
}

std::vector<NamedPick> name_picks(const Advice& advice) {
  const Picks picks = find_picks(advice);
  const bool is_best = !picks.best && advice.keeping.size() > 1 && find_best(advice.keeping);
  std::vector<NamedPick> named = {{is_best ? "fast and best" : "fast", picks.fast, explain_fast(advice)}};
  if (picks.balanced) named.push_back({"balanced", *picks.balanced, explain_balanced(advice, picks)});
  if (picks.best) named.push_back({"best", *picks.best, explain_best(advice, picks)});
  return named;
}

}  // namespace shadowbench::analysis
