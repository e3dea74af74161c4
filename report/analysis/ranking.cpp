#include "report/analysis/ranking.h"

#include <algorithm>

#include "report/analysis/limits.h"

namespace shadowbench::analysis {
namespace {

struct RankedCost {
  std::size_t cell = 0;
  records::Quartiles time;
  std::optional<records::Interval> ci95;
};

bool overlap(const records::Interval& a, const records::Interval& b) { return a.low <= b.high && b.low <= a.high; }

}  // namespace

std::vector<std::vector<std::size_t>> rank_costs(const std::vector<records::CellRecord>& cells) {
  std::vector<RankedCost> costs;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (const auto time = frame_time(cells[i], LightMotion::kMoving))
      costs.push_back({i, *time, frame_interval(cells[i], LightMotion::kMoving)});
  const bool all_have = std::ranges::all_of(
      costs, [](const RankedCost& cost) { return cost.ci95.has_value(); });
  const auto interval = [&](const RankedCost& cost) {
    return all_have ? *cost.ci95 : records::Interval{cost.time.q1, cost.time.q3};
  };
  std::ranges::stable_sort(costs, {}, [](const RankedCost& cost) { return cost.time.median; });
  std::vector<std::vector<std::size_t>> groups;
  const RankedCost* first = nullptr;
  for (const RankedCost& cost : costs) {
    if (!first || !overlap(interval(*first), interval(cost))) {
      first = &cost;
      groups.emplace_back();
    }
    groups.back().push_back(cost.cell);
  }
  return groups;
}

}  // namespace shadowbench::analysis
