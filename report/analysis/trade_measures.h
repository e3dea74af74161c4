#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reference/metrics/metric_table.h"
#include "report/analysis/front.h"
#include "report/analysis/limits.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

inline constexpr std::size_t kErrorMeasures = 4;
inline constexpr std::size_t kMovingCost = 0,
                             kStaticCost = 1;  ///< of the costs: choose_cost(), the light moving or static

/// One axis of the trade.
struct Measure {
  std::string id;           ///< in file names, CSV, JSON and links: "rmse", "moving", "gpu.navi21.static"
  std::string name;         ///< for axes and choices: "RMSE to the area truth"
  std::string meaning;      ///< what it is and what its interval is; of a frame also what is left out
  const char* over_scenes;  ///< how one number is made of several scenes'
  Estimate (*combine)(const std::vector<Estimate>&);  ///< makes it; requires at least one scene
  const metrics::Metric* metric;                      ///< where it is read from; null for what a frame costs
  std::optional<CostKind> cost = {};                  ///< nothing of an error
  LightMotion light = LightMotion::kMoving;           ///< of what a frame costs

  bool is(CostKind::Kind kind) const { return cost && cost->kind == kind; }

  /// The field of a cell, and of the page's data: "time_ms.moving".
  std::string field() const;
};

/// The arithmetic mean over scenes, each of which counts the same. They are measured independently, so that the
/// distances to the ends of their intervals add up in quadrature. Requires at least one scene.
Estimate mean_over_scenes(const std::vector<Estimate>& estimates);

/// Lists the errors: rmse, kernel_rmse, leak, flip.
const std::array<Measure, kErrorMeasures>& list_error_measures();

/// The cost that all of a run's answer, tables, charts and pictures are in unless something else is asked for: of a
/// frame, in the run's clock; but where a software rasteriser drew all cells, whose times say nothing of a GPU, or
/// several kinds of machine did, on the first GPU that cells have an estimate for, if there is one.
CostKind choose_cost(const std::vector<records::CellRecord>& cells);

/// Describes the cost of a frame: its light, what is left out, and how sure it is.
Measure make_frame_measure(const CostKind& cost, LightMotion light,
                           const std::vector<const records::CellRecord*>& cells);

/// Lists the costs: of a frame, the light moving and static, by choose_cost() and by the others that the run has; then
/// fetches and bytes.
std::vector<Measure> list_cost_measures(const std::vector<records::CellRecord>& cells = {});

/// Names the GPUs that cells have costs on.
std::vector<std::string> list_gpus(const std::vector<const records::CellRecord*>& cells);

/// The unit of what a frame costs: "ms (CPU)"; empty for all else.
std::string unit_of(const Measure& measure, const records::GlRecord& gl);

/// Names a measure with its unit: "time of the lookup, ms: CPU time (software rasteriser)".
std::string name_axis(const Measure& measure, const records::GlRecord& gl);

/// Writes a value of a measure for people, without its unit except for bytes: "0.0512", "1.5 MiB".
std::string format_value(const Measure& measure, double value);

/// Writes an estimate with its interval where it has one: "3.9 [3.8, 4.1]".
std::string format_estimate(const Measure& measure, const Estimate& estimate);

/// A value or the reason why there is none.
struct Measured {
  std::optional<Estimate> estimate;
  std::string absent;
};

/// Reads an error from a cell; `measure` is of list_error_measures().
/// RMSE to the area truth: its 95 % interval; see find_rmse_reach(). The others have no interval in the record.
Measured read_error(const records::CellRecord& cell, const Measure& measure);

/// The RMSE over cells of several places: the root of the mean square. Nothing where a cell has none, or there is none.
std::optional<Estimate> combine_rmse(const std::vector<const records::CellRecord*>& cells);

/// Reads a cost from a cell; `measure` is of list_cost_measures(). Times: frame_time(), with
/// its interval.
Measured read_cost(const records::CellRecord& cell, const Measure& measure);

}  // namespace shadowbench::analysis
