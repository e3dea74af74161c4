#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "reference/metrics/metric_table.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// Which passes a frame pays for: map, prefilter and the filter's own lookup (moving), or that lookup alone (static).
enum class LightMotion { kMoving, kStatic };

/// What is to be cheap: the time of a frame, the maps' bytes, fetches, or the estimate of a frame on a GPU.
struct CostKind {
  enum Kind { kTime, kBytes, kFetches, kGpu };

  // NOLINTNEXTLINE(google-explicit-constructor): a kind alone is a cost, but for GPUs
  CostKind(Kind of = kTime, std::string on = {}) : kind(of), gpu(std::move(on)) {}

  Kind kind;
  std::string gpu;  ///< its name; empty but for kGpu

  bool operator==(const CostKind&) const = default;

  /// Whether it is the milliseconds of a frame.
  bool is_of_frame() const { return kind == kTime || kind == kGpu; }
};

/// One number of a cell that may be limited; less is better.
struct LimitSpec {
  std::string option;             ///< "--max-rmse"
  std::string field;              ///< of the record: "error.rmse"; "time_ms" for a sum over passes
  std::string text;               ///< for help
  const metrics::Metric* metric;  ///< null: the time of a frame, or an estimate
  std::string gpu = {};           ///< of an estimate: the GPU that it is for

  std::optional<double> read(const records::CellRecord& cell, LightMotion light) const;
};

/// Lists everything that may be limited: the metrics of the table that have an option, and the time of a frame.
std::span<const LimitSpec> limit_table();

/// The row of a field. Requires that there is one.
const LimitSpec& limit_of(std::string_view field);

/// What a cost is read by, and limited: of a frame, by --max-ms.
const LimitSpec& cost_spec(const CostKind& cost);

/// What a filter costs in one frame, without what every lookup pays. Nothing where a pass that is paid was not timed.
const std::optional<records::OwnTime>& frame_time(const records::CellRecord& cell, LightMotion light);

/// Returns the ratio to `none` of what one frame takes, what every lookup pays included.
const std::optional<records::Ratio>& frame_ratio(const records::CellRecord& cell, LightMotion light);

/// One thing asked of a configuration: a limit, or, without `spec`, a claim of its filter.
struct Demand {
  const LimitSpec* spec = nullptr;
  double most = 0.0;  ///< a value of this size keeps the limit
  std::string claim;
};

/// Writes a demand as the command line has it: "--max-rmse 0.05".
std::string describe_demand(const Demand& demand);

}  // namespace shadowbench::analysis
