#include "report/analysis/picks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <optional>

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

std::string explain_balanced(const Candidate& fast, const Candidate& knee, const Candidate& best) {
  return fmt::format(
      "{} of what the best one gains, for {} of what it costs more",
      records::format_share((fast.rmse->value - knee.rmse->value) / (fast.rmse->value - best.rmse->value)),
      records::format_share((knee.cost.mean - fast.cost.mean) / (best.cost.mean - fast.cost.mean)));
}

std::string explain_best(const Candidate& fast, const Candidate& best, const CostKind& kind) {
  if (!are_costs_told_apart(fast, best, kind) || fast.cost.mean <= 0.0) return "the least RMSE";
  return fmt::format("the least RMSE, at {} times the cost of the fast one",
                     records::format_number(best.cost.mean / fast.cost.mean));
}

}  // namespace

std::vector<Pick> list_picks(const Advice& advice) {
  const std::vector<Candidate>& keeping = advice.keeping;
  const CostKind& kind = advice.request.cheapest;
  assert(!keeping.empty());
  std::vector<Pick> picks = {{{kFast}, 0, explain_fast(advice)}};
  const auto best = keeping.size() > 1 ? find_best(keeping) : std::nullopt;
  if (!best) return picks;
  if (*best == 0) {
    picks.front().names.emplace_back(kBest);
    return picks;
  }
  if (const auto knee = find_knee(keeping, *best, kind))
    picks.push_back({{kBalanced}, *knee, explain_balanced(keeping[0], keeping[*knee], keeping[*best])});
  picks.push_back({{kBest}, *best, explain_best(keeping[0], keeping[*best], kind)});
  return picks;
}

}  // namespace shadowbench::analysis
