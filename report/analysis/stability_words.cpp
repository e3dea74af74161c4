#include "report/analysis/stability_words.h"

#include <fmt/format.h>

#include <cmath>

#include "filters/store_format.h"
#include "report/analysis/cell_group.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

constexpr double kVisibleDifference = 1.0 / 255.0;  // of visibility: one step of a picture

double count_texels(const records::CellRecord& cell) {
  return static_cast<double>(cell.map_size) * static_cast<double>(cell.map_size);
}

std::string share_of_map(const records::CellRecord& cell, std::int64_t texels) {
  return records::format_number(100.0 * static_cast<double>(texels) / count_texels(cell)) + " % of its map's texels";
}

std::int64_t count_broken(const records::StabilityRecord& s) {
  return s.overflow_texels.value_or(0) + s.nan_texels.value_or(0);
}

/// "r16f holds numbers up to 65504 (e^11.09)"; empty where the cell has no store.
std::string describe_limit(const records::CellRecord& cell) {
  const auto found = cell.params.find("store");
  if (found == cell.params.end() || !std::holds_alternative<std::string>(found->second)) return {};
  const auto& store = std::get<std::string>(found->second);
  const double largest = filters::largest_number(filters::store_precision(store));
  return fmt::format("{} holds numbers up to {:.6g} (e^{:.2f})", store, largest, std::log(largest));
}

std::string describe_overflow(const records::CellRecord& cell) {
  std::string text = fmt::format("{} overflowed", share_of_map(cell, count_broken(cell.stability)));
  const std::string limit = describe_limit(cell);
  if (!limit.empty()) text += ": " + limit;
  if (cell.stability.safe_exponent)
    text += fmt::format("; an exponent of {:.4g} is safe here", *cell.stability.safe_exponent);
  return text;
}

std::string describe_variance(const records::CellRecord& cell) {
  return fmt::format("the variance of {} is below 0 before the clamp, down to {:.2g}",
                     share_of_map(cell, *cell.stability.negative_variance_texels),
                     cell.stability.lowest_variance.value_or(0.0));
}

std::string describe_bound(const records::StabilityRecord& s) {
  std::string text = fmt::format(
      "darker than the percentage-closer filter that it bounds, by up to {}; at {} receivers by more than rounding "
      "explains",
      records::format_number(*s.bound_shortfall_max), s.bound_violations.value_or(0));
  if (s.bound_exact_violations.value_or(0) > 0) {
    text += fmt::format(", and at {} in exact arithmetic too: with these parameters it is no bound",
                        *s.bound_exact_violations);
  }
  return text;
}

std::vector<std::string> list_troubles(const records::CellRecord& cell) {
  const records::StabilityRecord& s = cell.stability;
  std::vector<std::string> troubles;
  if (count_broken(s) > 0) troubles.push_back(describe_overflow(cell));
  if (s.negative_variance_texels.value_or(0) > 0) troubles.push_back(describe_variance(cell));
  if (s.half_difference_max.value_or(0.0) > kVisibleDifference) troubles.push_back(caption_difference(cell));
  if (s.bound_violations.value_or(0) > 0 || s.bound_shortfall_max.value_or(0.0) > kVisibleDifference)
    troubles.push_back("it is " + describe_bound(s));
  return troubles;
}

}  // namespace

std::vector<std::string> describe_stability(const CellGroup& group) {
  std::vector<std::string> sentences;
  for (const records::CellRecord& cell : group.cells)
    for (const std::string& trouble : list_troubles(cell))
      sentences.push_back(fmt::format("{}: {}.", group.names.name(cell), trouble));
  return sentences;
}

std::string caption_texels(const records::CellRecord& cell) {
  const records::StabilityRecord& s = cell.stability;
  if (!s.overflow_texels) return {};
  if (count_broken(s) > 0) return describe_overflow(cell) + " · magenta: overflow";
  std::string text = describe_limit(cell);
  if (s.headroom) text += fmt::format(" · {} left at the largest texel", records::format_number(*s.headroom));
  if (s.safe_exponent) text += fmt::format(" · safe up to an exponent of {:.4g}", *s.safe_exponent);
  return text;
}

std::string caption_variance(const records::CellRecord& cell) {
  if (!cell.stability.negative_variance_texels) return {};
  if (*cell.stability.negative_variance_texels == 0) return "red: below 0, which no texel is";
  return describe_variance(cell) + " · red: below 0";
}

std::string caption_difference(const records::CellRecord& cell) {
  const records::StabilityRecord& s = cell.stability;
  if (!s.half_difference_max || !s.half_difference_rms) return {};
  return fmt::format("the 16-bit store's visibility is up to {} off that of the 32-bit store (RMS {})",
                     records::format_number(*s.half_difference_max), records::format_number(*s.half_difference_rms));
}

std::string caption_bound(const records::CellRecord& cell) {
  const records::StabilityRecord& s = cell.stability;
  if (!s.bound_shortfall_max) return {};
  if (*s.bound_shortfall_max <= 0.0) return "kept at every receiver";
  return describe_bound(s) + " · magenta: that";
}

}  // namespace shadowbench::analysis
