#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reference/metrics/metric_table.h"
#include "report/analysis/front.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

inline constexpr std::size_t kErrorMeasures = 4;
inline constexpr std::size_t kMovingCost = 0,
                             kStaticCost = 1;  ///< of the costs: of a frame, the light moving or static

/// One axis of the trade.
struct Measure {
  std::string id;                                     ///< in file names, CSV and JSON: "rmse"
  std::string name;                                   ///< for axes and sentences: "RMSE to the area truth"
  std::string meaning;                                ///< what it is and what its interval is
  const char* over_scenes;                            ///< how one number is made of several scenes'
  Estimate (*combine)(const std::vector<Estimate>&);  ///< makes it; requires at least one scene
  const metrics::Metric* metric;                      ///< where it is read from; null for what a frame costs
  bool is_time;                                       ///< milliseconds of the run's clock
  bool is_bytes;
  std::string gpu = {};   ///< of an estimate: the GPU that it is for
  bool is_ratio = false;  ///< to the time of `none` on a map and a picture of the same size
};

/// The arithmetic mean over scenes, each of which counts the same. They are measured independently, so that the
/// distances to the ends of their intervals add up in quadrature. Requires at least one scene.
Estimate mean_over_scenes(const std::vector<Estimate>& estimates);

/// Lists the errors: rmse, kernel_rmse, leak, flip.
const std::array<Measure, kErrorMeasures>& list_error_measures();

/// Lists the costs: moving, static, fetches, bytes, and an estimate for each GPU that a cell names. The first is what
/// is compared unless something else is asked for. Where several kinds of machine measured the cells, moving_ratio and
/// static_ratio stand in place of the first two.
std::vector<Measure> list_cost_measures(const std::vector<records::CellRecord>& cells = {});

/// Names the GPUs that cells have costs on.
std::vector<std::string> list_gpus(const std::vector<const records::CellRecord*>& cells);

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

/// Reads a cost from a cell; `measure` is of list_cost_measures(). Times: frame_time() with
/// frame_interval(), or where that is missing with the quartiles. Ratios: frame_ratio() with its interval.
Measured read_cost(const records::CellRecord& cell, const Measure& measure);

/// Whether a cell is the one that ratios refer to: its own ratio is exactly 1 [1, 1].
bool is_reference(const records::CellRecord& cell);

}  // namespace shadowbench::analysis
