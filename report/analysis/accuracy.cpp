#include "report/analysis/accuracy.h"

#include <algorithm>
#include <numeric>

namespace shadowbench::analysis {
namespace {

constexpr double kDominatingShare = 0.5;

double truth_se(const records::CellRecord& cell) { return cell.truth.se.value_or(0.0); }

// Indices of the parts, largest share first.
std::array<std::size_t, metrics::kErrorParts> order_parts(const records::PartShares& shares) {
  std::array<std::size_t, metrics::kErrorParts> order{};
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return shares[a] > shares[b]; });
  return order;
}

}  // namespace

double find_rmse_reach(const records::CellRecord& cell) {
  return cell.rmse_ci95 ? 0.5 * (cell.rmse_ci95->high - cell.rmse_ci95->low) : truth_se(cell);
}

std::optional<std::size_t> find_dominating_part(const records::PartShares& shares) {
  const auto order = order_parts(shares);
  const bool one_is = shares[order[0]] > kDominatingShare && shares[order[1]] <= kDominatingShare;
  return one_is ? std::optional(order[0]) : std::nullopt;
}

bool is_lost_in_truth(const records::CellRecord& cell) {
  return cell.error.rmse && cell.truth.se && *cell.error.rmse <= *cell.truth.se;
}

}  // namespace shadowbench::analysis
