#include "report/analysis/ranking.h"

#include <algorithm>

namespace shadowbench::analysis {
namespace {

records::Interval lookup_interval(const records::CellRecord& cell, bool by_ratio) {
  return by_ratio ? cell.ratio_to_none.lookup->ci95
                  : records::Interval{cell.time_ms.lookup->q1, cell.time_ms.lookup->q3};
}

double lookup_median(const records::CellRecord& cell, bool by_ratio) {
  return by_ratio ? cell.ratio_to_none.lookup->median : cell.time_ms.lookup->median;
}

bool overlap(const records::Interval& a, const records::Interval& b) { return a.low <= b.high && b.low <= a.high; }

}  // namespace

std::vector<std::vector<std::size_t>> rank_lookups(const std::vector<records::CellRecord>& cells) {
  std::vector<std::size_t> order;
  bool by_ratio = true;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].time_ms.lookup) {
      order.push_back(i);
      by_ratio = by_ratio && cells[i].ratio_to_none.lookup.has_value();
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return lookup_median(cells[a], by_ratio) < lookup_median(cells[b], by_ratio);
  });
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t i : order) {
    const bool tied = !groups.empty() && overlap(lookup_interval(cells[groups.back().front()], by_ratio),
                                                 lookup_interval(cells[i], by_ratio));
    if (!tied) groups.emplace_back();
    groups.back().push_back(i);
  }
  return groups;
}

}  // namespace shadowbench::analysis
