#include "report/analysis/repeat.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "report/analysis/cell_group.h"

namespace shadowbench::analysis {
namespace {

constexpr double kLeastError = 1e-4;  // no picture of 8 bits shows less than forty times that

using NamedRatio = std::pair<const char*, std::optional<records::Ratio> records::RatioRecord::*>;
constexpr NamedRatio kRatios[] = {{"lookup", &records::RatioRecord::lookup},
                                  {"static", &records::RatioRecord::static_light},
                                  {"moving", &records::RatioRecord::moving}};

bool is_same(const records::Ratio& a, const records::Ratio& b) {
  return a.median == b.median && a.ci95.low == b.ci95.low && a.ci95.high == b.ci95.high;
}

bool is_own_reference(const records::Ratio& ratio) { return is_same(ratio, {1.0, {1.0, 1.0}}); }

bool repeats_lookup(const records::RatioRecord& ratios,
                    const std::optional<records::Ratio> records::RatioRecord::*which) {
  return which != &records::RatioRecord::lookup && ratios.lookup && is_same(*(ratios.*which), *ratios.lookup);
}

// Between the nearer ends, over the smaller of them; 0 where the intervals meet.
double measure_gap(const records::Interval& a, const records::Interval& b) {
  const double low = std::min(a.high, b.high), high = std::max(a.low, b.low);
  return high <= low ? 0.0 : low > 0.0 ? high / low - 1.0 : high;
}

void add_error(RepeatComparison& comparison, const records::CellRecord& a, const records::CellRecord& b) {
  if (!a.error.rmse || !b.error.rmse) return;
  ++comparison.errors;
  const Estimate gap = subtract(estimate_rmse(b), estimate_rmse(a));
  const bool is_apart = gap.low > 0.0 || gap.high < 0.0;
  if (is_apart && std::abs(gap.value) > kLeastError) comparison.errors_apart.push_back({&a, &b, gap});
}

void add_cell(RepeatComparison& comparison, const records::CellRecord& a, const records::CellRecord& b) {
  ++*comparison.record.cells;
  add_error(comparison, a, b);
  for (const auto& [name, which] : kRatios) {
    const std::optional<records::Ratio>&x = a.ratio_to_none.*which, &y = b.ratio_to_none.*which;
    if (!x || !y || (is_own_reference(*x) && is_own_reference(*y))) continue;
    if (repeats_lookup(a.ratio_to_none, which) && repeats_lookup(b.ratio_to_none, which)) continue;
    ++*comparison.record.of;
    const double gap = measure_gap(x->ci95, y->ci95);
    if (gap > 0.0)
      comparison.apart.push_back({&a, &b, name, gap});
    else
      ++*comparison.record.overlapping;
  }
}

}  // namespace

RepeatComparison compare_runs(const std::vector<records::CellRecord>& a, const std::vector<records::CellRecord>& b) {
  std::map<std::string, const records::CellRecord*> others;
  for (const records::CellRecord& cell : b) others[cell.key] = &cell;
  RepeatComparison comparison;
  comparison.record = {0, 0, 0};
  for (const records::CellRecord& cell : a) {
    const auto other = others.find(cell.key);
    if (other != others.end()) add_cell(comparison, cell, *other->second);
  }
  std::ranges::stable_sort(comparison.apart, std::greater(), &RatioApart::gap);
  std::ranges::stable_sort(comparison.errors_apart, std::greater(),
                           [](const ErrorApart& each) { return std::abs(each.gap.value); });
  return comparison;
}

std::string describe_overlap(const records::RepeatRecord& repeat) {
  return fmt::format("{} of {} ratio intervals overlap", repeat.overlapping.value_or(0), repeat.of.value_or(0));
}

}  // namespace shadowbench::analysis
