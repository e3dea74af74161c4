#include "report/analysis/cell_group.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "filters/kernel.h"
#include "report/analysis/configuration.h"
#include "report/records/cell_key.h"
#include "report/records/json_values.h"

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

std::vector<CellGroup> group_cells(const std::vector<records::CellRecord>& cells) {
  std::vector<CellGroup> groups;
  std::map<std::string, std::size_t> places;
  for (const records::CellRecord& cell : cells) {
    auto settings = records::cell_settings(cell);
    settings.erase("filter");
    settings.erase("params");
    const auto [place, is_new] = places.emplace(records::dump_line(settings), groups.size());
    if (is_new) groups.push_back({cell.scene, {}});
    groups[place->second].cells.push_back(cell);
  }
  for (CellGroup& group : groups) group.names = records::CellNames(point_to(group.cells));
  return groups;
}

std::optional<std::vector<records::CellRecord>> leave_out_external(const std::vector<records::CellRecord>& cells) {
  const auto is_external = [](const records::CellRecord& cell) { return cell.external.has_value(); };
  if (std::ranges::none_of(cells, is_external)) return std::nullopt;
  std::vector<records::CellRecord> own = cells;
  std::erase_if(own, is_external);
  return own;
}

bool mixes_machines(const std::vector<records::CellRecord>& cells) {
  return std::ranges::any_of(
      cells, [&](const records::CellRecord& cell) { return cell.machine != cells.front().machine; });
}

std::optional<std::vector<records::CellRecord>> withhold_mixed_times(const std::vector<records::CellRecord>& cells) {
  if (!mixes_machines(cells)) return std::nullopt;
  std::vector<records::CellRecord> without = cells;
  for (records::CellRecord& cell : without) {
    std::erase_if(cell.absent, [](const auto& entry) { return entry.first.starts_with("time_ms"); });
    cell.time_ms = {};
    cell.absent["time_ms"] = "several kinds of machine measured the run, whose times do not compare";
  }
  return without;
}

std::optional<std::size_t> find_class(const records::CellRecord& cell) {
  const std::vector<std::string> names = filters::list_width_names();
  const auto found = std::ranges::find(names, cell.kernel.width_class.value_or(""));
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

std::string name_class(std::optional<std::size_t> width_class) {
  return width_class ? filters::list_width_names()[*width_class] : std::string();
}

double find_rmse_reach(const records::CellRecord& cell) {
  return cell.rmse_ci95 ? 0.5 * (cell.rmse_ci95->high - cell.rmse_ci95->low) : truth_se(cell);
}

Estimate estimate_rmse(const records::CellRecord& cell) {
  const double value = *cell.error.rmse, reach = find_rmse_reach(cell);
  return {value, std::max(0.0, value - reach), value + reach, cell.rmse_replicates.value_or(std::vector<double>())};
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
