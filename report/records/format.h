#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "reference/metrics/error_stats.h"
#include "report/records/records.h"

namespace shadowbench::records {

/// Stands in a text for a value that does not exist.
inline constexpr const char* kNothing = "–";

/// Writes a number for people: three significant digits, no exponent where it can be helped.
std::string format_number(double value);

template <class T>
std::string format_number(const std::optional<T>& value) {
  return value ? format_number(static_cast<double>(*value)) : kNothing;
}

/// Writes bytes for people: "1.5 MiB".
std::string format_bytes(double bytes);

/// Writes a share for people, in whole percent: "71 %".
std::string format_share(double share);

/// Writes a rate for people, in percent with three digits: "4.2 %".
std::string format_rate(double rate);
std::string format_rate(const std::optional<double>& rate);

/// Writes a value with its interval for people: "1.09 [1.08, 1.1]".
std::string format_interval(double value, const Interval& interval);

/// Writes a ratio for people, likewise.
std::string format_ratio(const std::optional<records::Ratio>& ratio);

/// Names the clock that a run's times come from: "CPU time (software rasteriser)".
std::string describe_clock(const records::GlRecord& gl);
std::string describe_clock(const MachineKind& kind);

/// Names the unit of a run's times where room is short: "ms (CPU)", "ms (GPU)",
/// "ms (GL timer)" or "ms".
std::string time_unit(const records::GlRecord& gl);

/// Names a kind of machine: "AMD EPYC 7B13, 2 cores, llvmpipe (LLVM 15.0.6, 256 bits), CPU time (software rasteriser)".
std::string describe_machine_kind(const MachineKind& kind);

/// Lists parameters: "radius 4, store rg32f".
std::string describe_params(const records::ParamMap& params);

/// The record of a kernel of this width, with its class.
records::KernelRecord make_kernel_record(std::optional<double> sigma_texels);

/// A kernel's width with its class: "0.645 texels (medium)".
std::string describe_kernel(const records::KernelRecord& kernel);

/// How well the map's texels are spent: "3.2 map texels per pixel (worst 0.4), 61 % of the map used"; empty where
/// that was not measured.
std::string describe_coverage(const records::CoverageRecord& coverage);

/// Lists the parts of a bias that are there, or "none"; lengths in all units where the map's scale is known.
std::string describe_bias(const records::BiasRecord& bias, const records::MapScaleRecord& scale = {});

/// Lists the settings outside the map that are not the right ones; empty where all are.
std::string describe_range(const RangeRule& range);

/// Lists what all cells of one table share: view, map, picture size, bias.
std::string describe_settings(const records::CellRecord& cell);

/// How a cell ended: "ok", "timeout: no answer after 10 s".
std::string describe_status(const records::CellRecord& cell);

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
