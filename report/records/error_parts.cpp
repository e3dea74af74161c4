#include "report/records/error_parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/records/format.h"

namespace shadowbench::records {
namespace {

constexpr auto kNumeric = static_cast<std::size_t>(metrics::ErrorPart::kNumeric);

}  // namespace

const std::array<ErrorPart, metrics::kErrorParts>& list_error_parts() {
  static const std::array<ErrorPart, metrics::kErrorParts> kParts = {
      ErrorPart{"numeric", "numeric", "arithmetic precision", {0.20f, 0.20f, 0.20f}, &AttributionRecord::numeric},
      ErrorPart{"estimator",
                "estimator",
                "light bleeding of a bound, or noise of few taps",
                {0.94f, 0.75f, 0.19f},
                &AttributionRecord::estimator},
      ErrorPart{"discretisation",
                "discretisation and bias",
                "the map's resolution and the bias",
                {0.00f, 0.45f, 0.35f},
                &AttributionRecord::discretisation},
      ErrorPart{"model",
                "model",
                "the filter's kernel is not this light's penumbra",
                {0.80f, 0.47f, 0.65f},
                &AttributionRecord::model}};
  return kParts;
}

std::optional<PartShares> list_shares(const CellRecord& cell) {
  PartShares shares;
  for (std::size_t i = 0; i < metrics::kErrorParts; ++i) {
    shares[i] = (cell.attribution.*list_error_parts()[i].record).share;
    if (shares[i] ? !std::isfinite(*shares[i]) : i != kNumeric) return std::nullopt;
  }
  return shares;
}

bool has_offsets(const PartShares& shares) {
  return std::ranges::any_of(
      shares,
      [](const auto& share) {
        const double percent = std::round(100.0 * share.value_or(0.0));  // as format_share() shows it
        return percent < 0.0 || percent > 100.0;
      });
}

std::string describe_shares(const PartShares& shares) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < metrics::kErrorParts; ++i)
    if (shares[i]) texts.push_back(fmt::format("{} {}", list_error_parts()[i].id, format_share(*shares[i])));
  if (!shares[kNumeric]) texts.front() = "numeric and " + texts.front();
  const std::string note = has_offsets(shares) ? fmt::format("; {}", kOffsets) : "";
  return fmt::format("{}{}", fmt::join(texts, ", "), note);
}

std::string explain_no_attribution(const CellRecord& cell) {
  if (cell.status == CellStatus::kSuspect) return "the filter is suspect";
  for (const auto& [field, reason] : cell.absent)
    if (field == "attribution" || field.rfind("attribution.", 0) == 0) return reason;
  const auto found = cell.absent.find("error");
  return found == cell.absent.end() ? "not measured" : found->second;
}

}  // namespace shadowbench::records
