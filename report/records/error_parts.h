#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "reference/metrics/error_stats.h"
#include "report/records/format.h"
#include "report/records/records.h"

namespace shadowbench::records {

/// One of the parts that an error is the sum of.
struct ErrorPart {
  const char* id;       ///< its field in AttributionRecord: "discretisation"
  const char* name;     ///< for legends: "discretisation and bias"
  const char* meaning;  ///< ends the sentence "most of the error is estimator: ..."
  std::array<float, 3>
      color;  ///< for a display, sRGB; tells the parts apart by lightness alone, so in grey and to any eye
  AttributionPart AttributionRecord::*record;
};

/// Lists the parts in the order of their sum: numeric, estimator, discretisation, model.
const std::array<ErrorPart, metrics::kErrorParts>& list_error_parts();

/// One number per part, in the order of list_error_parts().
using PartValues = std::array<double, metrics::kErrorParts>;

/// One share per part. That of a filter without a scalar model has no numeric part: its estimator's includes it.
using PartShares = std::array<std::optional<double>, metrics::kErrorParts>;

/// Returns the shares of a cell's error, or nothing where one of them does not exist, the numeric part's aside.
std::optional<PartShares> list_shares(const CellRecord& cell);

/// Whether parts offset others: their shares are below 0, and those of the others add up to more than 100 %.
bool has_offsets(const PartShares& shares);

/// What is said of such shares where they stand.
inline constexpr const char* kOffsets = "parts below 0 offset the others";

/// Lists all parts with their shares: "numeric 0 %, estimator 71 %, discretisation 9 %, model 20 %".
std::string describe_shares(const PartShares& shares);

/// Why a cell shows no attribution: it is suspect, or what its `absent` holds for the attribution, one of its parts, or
/// the error.
std::string explain_no_attribution(const CellRecord& cell);

}  // namespace shadowbench::records
