#include "report/analysis/differences.h"

#include <fmt/format.h>

#include <algorithm>

#include "reference/metrics/error_stats.h"
#include "report/analysis/cell_group.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

bool has_replicates(const records::CellRecord& cell) {
  return cell.status == records::CellStatus::kOk && cell.error.rmse && cell.rmse_replicates;
}

/// The differences that are found in four of five runs, for every two cells of one class, in the places of all groups.
std::vector<double> list_least_differences(const std::vector<records::CellRecord>& cells) {
  std::vector<double> differences;
  for (const CellGroup& group : group_cells(cells)) {
    for (std::size_t i = 0; i < group.cells.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const records::CellRecord &a = group.cells[i], &b = group.cells[k];
        if (!has_replicates(a) || !has_replicates(b) || !find_class(a) || find_class(a) != find_class(b)) continue;
        const std::size_t count = a.rmse_replicates->size();
        if (count != b.rmse_replicates->size()) continue;
        const Estimate gap = subtract(estimate_rmse(a), estimate_rmse(b));
        const double power = metrics::find_student_t(count, 0.8) / metrics::find_student_t(count);
        differences.push_back((gap.high - gap.value) * (1.0 + power));
      }
    }
  }
  return differences;
}

}  // namespace

std::string describe_power(const std::vector<records::CellRecord>& cells) {
  std::vector<double> differences = list_least_differences(cells);
  if (differences.empty()) return {};
  std::ranges::sort(differences);
  const auto at = [&](double share) {
    const auto place = static_cast<std::size_t>(share * static_cast<double>(differences.size()));
    return records::format_number(differences[place]);
  };
  return fmt::format(
      "With {} phases of the map's grid, four of five runs tell RMSEs of one class and scene apart that differ by {} "
      "(half of the {} pairs) or {} (nine tenths).",
      std::ranges::find_if(cells, has_replicates)->phases.value_or(0), at(0.5), differences.size(), at(0.9));
}

}  // namespace shadowbench::analysis
