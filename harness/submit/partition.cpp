#include "harness/submit/partition.h"

#include <algorithm>
#include <numeric>

namespace shadowbench::submit {

std::vector<options::CellRange> split_evenly(const std::vector<double>& costs, int tasks) {
  const double share = std::accumulate(costs.begin(), costs.end(), 0.0) / tasks;
  std::vector<options::CellRange> ranges;
  double before = 0.0;  // cost of the cells before this one
  int last = -1;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    const int task = std::min(static_cast<int>((before + 0.5 * costs[i]) / share), tasks - 1);
    if (task != last) ranges.push_back({static_cast<int>(i), static_cast<int>(i)});
    ++ranges.back().end;
    last = task;
    before += costs[i];
  }
  return ranges;
}

}  // namespace shadowbench::submit
