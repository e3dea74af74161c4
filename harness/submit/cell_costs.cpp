#include "harness/submit/cell_costs.h"

#include <iterator>

#include "harness/run/run_progress.h"

namespace shadowbench::submit {
namespace {

double count_megapixels(const records::CellRecord& cell) { return run::count_megapixels(cell.width, cell.height); }

double width_of(const records::CellRecord& cell) { return cell.kernel_radius_texels.value_or(0.0); }

}  // namespace

CellCosts::CellCosts(const std::vector<records::CellRecord>& measured) {
  for (const records::CellRecord& cell : measured) {
    if (!cell.measured_s || *cell.measured_s <= 0.0) continue;
    for (Point* point : {&by_filter_[cell.filter][width_of(cell)], &all_}) {
      point->seconds += *cell.measured_s / count_megapixels(cell);
      ++point->cells;
    }
  }
}

double CellCosts::expect_s(const records::CellRecord& cell) const {
  return is_empty() ? 1.0 : expect_for_megapixel(cell) * count_megapixels(cell);
}

double CellCosts::expect_for_megapixel(const records::CellRecord& cell) const {
  const auto filter = by_filter_.find(cell.filter);
  if (filter == by_filter_.end()) return all_.mean();
  const std::map<double, Point>& points = filter->second;
  const double width = width_of(cell);
  const auto wider = points.lower_bound(width);
  if (wider == points.begin()) return wider->second.mean();
  const auto narrower = std::prev(wider);
  if (wider == points.end()) return narrower->second.mean();
  const double part = (width - narrower->first) / (wider->first - narrower->first);
  return (1.0 - part) * narrower->second.mean() + part * wider->second.mean();
}

}  // namespace shadowbench::submit
