#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reference/metrics/metric_table.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// A value with the ends of its interval; both ends equal the value where it is exact.
struct Estimate {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
  /// What each group of phases found: `value` is about their mean. Two estimates of as many groups were made of the
  /// same phases, and differ by less than each is uncertain. Empty: there are none.
  std::vector<double> replicates = {};
};

/// How much one error is above another, with the 95 % interval of the difference: of that of each group of phases,
/// where both have as many; else it reaches as far as the larger half-width of the two.
Estimate subtract(const Estimate& a, const Estimate& b);

/// Whether one error is smaller than another by more than is uncertain: the interval of subtract() is above 0. Exact
/// errors differ where they are not equal.
bool is_clearly_less_error(const Estimate& a, const Estimate& b);

/// One cost below another, their intervals not touching?
bool is_clearly_less_cost(const Estimate& a, const Estimate& b);

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

/// One number of a cell: an error, a fault, or a cost. Of what may be limited or is on an axis, less is better.
struct Quantity {
  std::string id;           ///< in file names, CSV, JSON and links: "rmse", "moving", "gpu.navi21.static"
  std::string title;        ///< for axes and choices: "RMSE to the area truth"
  std::string meaning;      ///< what it is and what its interval is; of a frame also what is left out
  std::string field;        ///< of the record: "error.rmse"; "time_ms" for a sum over passes
  std::string option = {};  ///< of `advise`, which limits it: "--max-rmse"; empty: none
  std::string unit = {};
  const metrics::Metric* metric = nullptr;                      ///< where it is read from; null for what a frame costs
  std::optional<CostKind> cost = {};                            ///< nothing of an error
  LightMotion light = LightMotion::kMoving;                     ///< of what a frame costs
  const char* over_scenes = "";                                 ///< how one number is made of several scenes'
  Estimate (*combine)(const std::vector<Estimate>&) = nullptr;  ///< makes it; requires at least one scene

  /// What a row of the metrics' table says.
  static Quantity of(const metrics::Metric& metric);

  bool is(CostKind::Kind kind) const { return cost && cost->kind == kind; }

  std::optional<double> read(const records::CellRecord& cell, LightMotion light) const;

  /// The field with its light: "time_ms.moving".
  std::string full_field() const;
};

/// Lists everything that may be limited: the metrics of the table that have an option, and the time of a frame.
std::span<const Quantity> limit_table();

/// The row of a field. Requires that there is one.
const Quantity& limit_of(std::string_view field);

/// What a cost is read by, and limited: of a frame, by --max-ms.
const Quantity& cost_spec(const CostKind& cost);

/// What a filter costs in one frame, without what every lookup pays. Nothing where a pass that is paid was not timed.
const std::optional<records::OwnTime>& frame_time(const records::CellRecord& cell, LightMotion light);

/// Returns the ratio to `none` of what one frame takes, what every lookup pays included.
const std::optional<records::Ratio>& frame_ratio(const records::CellRecord& cell, LightMotion light);

/// What a filter may claim whose penumbrae are narrow where caster and receiver touch, and widen with their distance.
inline constexpr const char* kContactHardening = "contact-hardening";

/// One thing asked of a configuration: a limit, or, without `spec`, that its filter hardens at contacts.
struct Demand {
  const Quantity* spec = nullptr;
  double most = 0.0;  ///< a value of this size keeps the limit
};

/// Writes a demand as the command line has it: "--max-rmse 0.05".
std::string describe_demand(const Demand& demand);

inline constexpr std::size_t kErrorMeasures = 4;
inline constexpr std::size_t kMovingCost = 0,
                             kStaticCost = 1;  ///< of the costs: choose_cost(), the light moving or static

/// The arithmetic mean over scenes, each of which counts the same. They are measured independently, so that the
/// distances to the ends of their intervals add up in quadrature. Requires at least one scene.
Estimate mean_over_scenes(const std::vector<Estimate>& estimates);

/// Lists the errors: rmse, kernel_rmse, leak, flip.
const std::array<Quantity, kErrorMeasures>& list_error_measures();

/// The cost that all of a run's answer, tables, charts and pictures are in unless something else is asked for: of a
/// frame, in the run's clock; but where a software rasteriser drew all cells, whose times say nothing of a GPU, or
/// several kinds of machine did, on the first GPU that cells have an estimate for, if there is one.
CostKind choose_cost(const std::vector<records::CellRecord>& cells);

/// Describes the cost of a frame: its light, what is left out, and how sure it is.
Quantity make_frame_measure(const CostKind& cost, LightMotion light,
                            const std::vector<const records::CellRecord*>& cells);

/// Lists the costs: of a frame, the light moving and static, by choose_cost() and by the others that the run has; then
/// fetches and bytes.
std::vector<Quantity> list_cost_measures(const std::vector<records::CellRecord>& cells = {});

/// Names the GPUs that cells have costs on.
std::vector<std::string> list_gpus(const std::vector<const records::CellRecord*>& cells);

/// The unit of what a frame costs: "ms (CPU)"; empty for all else.
std::string unit_of(const Quantity& measure, const records::GlRecord& gl);

/// Names a measure with its unit: "time of the lookup, ms: CPU time (software rasteriser)".
std::string name_axis(const Quantity& measure, const records::GlRecord& gl);

/// Writes a value of a measure for people, without its unit except for bytes: "0.0512", "1.5 MiB".
std::string format_value(const Quantity& measure, double value);

/// Writes an estimate with its interval where it has one: "3.9 [3.8, 4.1]".
std::string format_estimate(const Quantity& measure, const Estimate& estimate);

/// A value or the reason why there is none.
struct Measured {
  std::optional<Estimate> estimate;
  std::string absent;
};

/// Reads an error from a cell; `measure` is of list_error_measures().
/// RMSE to the area truth: its 95 % interval; see find_rmse_reach(). The others have no interval in the record.
Measured read_error(const records::CellRecord& cell, const Quantity& measure);

/// The RMSE over cells of several places: the root of the mean square. Nothing where a cell has none, or there is none.
std::optional<Estimate> combine_rmse(const std::vector<const records::CellRecord*>& cells);

/// Reads a cost from a cell; `measure` is of list_cost_measures(). Times: frame_time(), with
/// its interval.
Measured read_cost(const records::CellRecord& cell, const Quantity& measure);

}  // namespace shadowbench::analysis
