#include "report/analysis/front.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <numeric>
#include <optional>
#include <tuple>

#include "reference/metrics/error_stats.h"

namespace shadowbench::analysis {
namespace {

std::vector<std::size_t> order_by_cost(const std::vector<FrontPoint>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(points[a].cost.value, points[a].error.value) <
           std::tie(points[b].cost.value, points[b].error.value);
  });
  return order;
}

// The place that the members give to a point, the cheapest member first; none where it belongs among them.
std::optional<Placement> place_point(const std::vector<FrontPoint>& points, const std::vector<std::size_t>& members,
                                     const FrontPoint& point) {
  for (const std::size_t member : members)
    if (dominates(points[member], point)) return Placement{Standing::kDominated, member};
  for (const std::size_t member : members)
    if (is_tied(points[member], point)) return Placement{Standing::kTied, member};
  return std::nullopt;
}

}  // namespace

Estimate subtract(const Estimate& a, const Estimate& b) {
  const double difference = a.value - b.value;
  double reach = std::max(a.high - a.value, b.high - b.value);
  if (a.replicates.size() == b.replicates.size() && a.replicates.size() > 1) {
    std::vector<double> differences;
    std::ranges::transform(a.replicates, b.replicates, std::back_inserter(differences), std::minus());
    const metrics::MeanInterval interval = *metrics::find_mean_interval(differences);
    reach = interval.high - interval.mean;
  }
  return {difference, difference - reach, difference + reach};
}

bool is_clearly_less_error(const Estimate& a, const Estimate& b) { return subtract(b, a).low > 0.0; }

bool is_clearly_less_cost(const Estimate& a, const Estimate& b) { return a.high < b.low; }

bool dominates(const FrontPoint& a, const FrontPoint& b) {
  if (a.group != b.group || a.cost.value > b.cost.value || is_clearly_less_error(b.error, a.error)) return false;
  return is_clearly_less_error(a.error, b.error) || is_clearly_less_cost(a.cost, b.cost);
}

bool is_tied(const FrontPoint& a, const FrontPoint& b) {
  return a.group == b.group && !is_clearly_less_error(a.error, b.error) && !is_clearly_less_error(b.error, a.error) &&
         !is_clearly_less_cost(a.cost, b.cost) && !is_clearly_less_cost(b.cost, a.cost);
}

std::vector<Placement> find_front(const std::vector<FrontPoint>& points) {
  std::vector<Placement> placements(points.size());
  std::vector<std::size_t> members;
  for (const std::size_t i : order_by_cost(points)) {
    if (!points[i].group) {
      placements[i] = {Standing::kApart, i};
      continue;
    }
    const auto place = place_point(points, members, points[i]);
    placements[i] = place ? *place : Placement{Standing::kFront, i};
    if (!place) members.push_back(i);
  }
  return placements;
}

std::vector<std::size_t> list_members(const std::vector<FrontPoint>& points, const std::vector<Placement>& placements) {
  std::vector<std::size_t> members = order_by_cost(points);
  std::erase_if(
      members, [&](std::size_t i) { return placements[i].standing != Standing::kFront; });
  std::ranges::stable_sort(members, {}, [&](std::size_t i) { return points[i].group; });
  return members;
}

}  // namespace shadowbench::analysis
