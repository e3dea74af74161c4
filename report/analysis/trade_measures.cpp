#include "report/analysis/trade_measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "reference/metrics/error_stats.h"
#include "report/analysis/cell_group.h"
#include "report/analysis/configuration.h"
#include "report/analysis/limits.h"
#include "report/analysis/machines/machine_kinds.h"
#include "report/records/absence.h"
#include "report/records/format.h"

namespace shadowbench::analysis {
namespace {

Estimate exact(double value) { return {value, value, value}; }

Measured miss(const records::CellRecord& cell, std::string_view path) {
  if (!records::is_drawn(cell)) return {std::nullopt, "the cell did not finish"};
  return {std::nullopt, fmt::format("{}: {}", path, records::explain_absence(cell, std::string(path)))};
}

Measured read_metric(const records::CellRecord& cell, const metrics::Metric& metric) {
  const std::optional<double> value = metric.read(cell);
  return value && std::isfinite(*value) ? Measured{exact(*value), {}} : miss(cell, metric.path);
}

Measured read_time(const records::CellRecord& cell, LightMotion light) {
  const auto time = frame_time(cell, light);
  if (!time) return miss(cell, light == LightMotion::kMoving ? "time_ms.moving" : "time_ms.static");
  const auto interval = frame_interval(cell, light);
  return {interval ? Estimate{time->median, interval->low, interval->high} : Estimate{time->median, time->q1, time->q3},
          {}};
}

Measured read_ratio(const records::CellRecord& cell, LightMotion light) {
  const auto& ratio = frame_ratio(cell, light);
  if (!ratio) return miss(cell, light == LightMotion::kMoving ? "ratio_to_none.moving" : "ratio_to_none.static");
  return {Estimate{ratio->median, ratio->ci95.low, ratio->ci95.high}, {}};
}

Estimate worst_of(const std::vector<Estimate>& estimates) {
  const auto less = [](const Estimate& a, const Estimate& b) { return a.value < b.value; };
  return exact(std::max_element(estimates.begin(), estimates.end(), less)->value);
}

// What the groups of phases found of several scenes together; nothing where the scenes do not have as many.
std::vector<double> combine_replicates(const std::vector<Estimate>& estimates) {
  std::vector<double> squares(estimates.front().replicates.size());
  for (const Estimate& each : estimates) {
    if (each.replicates.size() != squares.size()) return {};
    for (std::size_t i = 0; i < squares.size(); ++i) squares[i] += each.replicates[i] * each.replicates[i];
  }
  for (double& square : squares) square = std::sqrt(square / static_cast<double>(estimates.size()));
  return squares;
}

// With groups of phases the interval is theirs. Without, each scene's standard error moves the result by its own
// share; scenes' truths are independent.
Estimate root_mean_square(const std::vector<Estimate>& estimates) {
  double squares = 0.0, variance = 0.0;
  for (const Estimate& each : estimates) {
    const double se = each.high - each.value;
    squares += each.value * each.value;
    variance += each.value * each.value * se * se;
  }
  const double count = static_cast<double>(estimates.size());
  const double rms = std::sqrt(squares / count);
  double reach = rms > 0.0 ? std::sqrt(variance) / (count * rms) : 0.0;
  std::vector<double> replicates = combine_replicates(estimates);
  if (const auto interval = metrics::find_mean_interval(replicates)) reach = interval->high - interval->mean;
  return {rms, std::max(0.0, rms - reach), rms + reach, std::move(replicates)};
}

constexpr const char* kMean = "mean over the scenes";
constexpr const char* kRmse = "error.rmse";

Measure make_measure(std::string_view path, const char* interval, const char* over_scenes,
                     Estimate (*combine)(const std::vector<Estimate>&)) {
  const metrics::Metric& metric = metrics::find_metric(path);
  return {std::string(metric.name()),
          std::string(metric.title),
          fmt::format("{}; {}", metric.definition, interval),
          over_scenes,
          combine,
          &metric,
          false,
          false};
}

Measure make_time_measure(const char* id, const char* name, const char* meaning) {
  return {id, name, meaning, kMean, mean_over_scenes, nullptr, true, false};
}

Measure make_ratio_measure(const char* id, const char* name, const char* frame) {
  return {id,
          name,
          fmt::format("time of {} over that of 'none' in the same rounds, and so on the same machine, map and picture; "
                      "on a map of another size it is the ratio to another 'none', so that each size of map has fronts "
                      "of its own; interval: 95 % of the median",
                      frame),
          kMean,
          mean_over_scenes,
          nullptr,
          false,
          false,
          {},
          true};
}

// What a frame costs, the light moving and static, in milliseconds.
std::array<Measure, 2> list_time_measures() {
  return {make_time_measure("moving", "time of map, prefilter and filter, moving light",
                            "what the filter costs while light or casters move: map, prefilter and lookup, less a "
                            "lookup that reads nothing, per round; interval: 95 % of the median"),
          make_time_measure("static", "time of the filter alone, static light",
                            "what the filter costs while they stand still: its lookup, less a lookup that reads "
                            "nothing, per round; interval: 95 % of the median")};
}

std::array<Measure, 2> list_ratio_measures() {
  return {make_ratio_measure("moving_ratio", "ratio to 'none' on the same map, moving light",
                             "a whole frame whose light or casters move (map, prefilter and lookup)"),
          make_ratio_measure("static_ratio", "ratio to 'none' on the same map, static light",
                             "a whole frame whose light and casters stand still (the lookup alone)")};
}

}  // namespace

Estimate mean_over_scenes(const std::vector<Estimate>& estimates) {
  double sum = 0.0, below = 0.0, above = 0.0;
  for (const Estimate& each : estimates) {
    sum += each.value;
    below += std::pow(each.value - each.low, 2);
    above += std::pow(each.high - each.value, 2);
  }
  const double count = static_cast<double>(estimates.size());
  const double mean = sum / count;
  return {mean, mean - std::sqrt(below) / count, mean + std::sqrt(above) / count};
}

const std::array<Measure, kErrorMeasures>& list_error_measures() {
  static const char* const kRootMeanSquare = "root mean square over the scenes";
  static const std::array<Measure, kErrorMeasures> kMeasures = {
      make_measure(kRmse, "interval: 95 %, over the phases of the map's grid", kRootMeanSquare, root_mean_square),
      make_measure("error.kernel_rmse", "no interval", kRootMeanSquare, root_mean_square),
      make_measure("artefact.leak", "no interval", "the worst scene", worst_of),
      make_measure("error.flip", "no interval", kMean, mean_over_scenes)};
  return kMeasures;
}

std::vector<std::string> list_gpus(const std::vector<const records::CellRecord*>& cells) {
  std::set<std::string> gpus;
  for (const records::CellRecord* cell : cells)
    if (cell->gpu)
      for (const auto& [name, record] : *cell->gpu) gpus.insert(name);
  return {gpus.begin(), gpus.end()};
}

std::vector<Measure> list_cost_measures(const std::vector<records::CellRecord>& cells) {
  Measure bytes = make_measure("cost.map_bytes", "exact", kMean, mean_over_scenes);
  bytes.id = "bytes";
  bytes.is_bytes = true;
  const auto frame = mixes_machines(cells) ? list_ratio_measures() : list_time_measures();
  std::vector<Measure> measures = {frame[kMovingCost], frame[kStaticCost],
                                   make_measure("cost.fetches", "no interval", kMean, mean_over_scenes), bytes};
  for (const std::string& gpu : list_gpus(point_to(cells))) {
    measures.push_back({"gpu_" + gpu, fmt::format("estimate on {}, us", gpu),
                        "microseconds of the prefilter and of a million receivers' lookups on that GPU, which was not "
                        "there: made of its compiler's facts; no interval",
                        kMean, mean_over_scenes, nullptr, false, false, gpu});
  }
  return measures;
}

std::string name_axis(const Measure& measure, const records::GlRecord& gl) {
  return measure.is_time ? fmt::format("{}, ms: {}", measure.name, records::describe_clock(gl)) : measure.name;
}

std::string format_value(const Measure& measure, double value) {
  return measure.is_bytes ? records::format_bytes(value) : records::format_number(value);
}

std::string format_estimate(const Measure& measure, const Estimate& estimate) {
  const std::string value = format_value(measure, estimate.value);
  if (estimate.low == estimate.high) return value;
  return fmt::format("{} [{}, {}]", value, format_value(measure, estimate.low), format_value(measure, estimate.high));
}

Measured read_error(const records::CellRecord& cell, const Measure& measure) {
  const metrics::Metric& metric = *measure.metric;
  Measured error = read_metric(cell, metric);
  if (error.estimate && metric.path == kRmse) error.estimate = estimate_rmse(cell);
  return error;
}

Measured read_cost(const records::CellRecord& cell, const Measure& cost) {
  if (cost.metric) return read_metric(cell, *cost.metric);
  if (!cost.gpu.empty()) {
    const LimitSpec& spec = cost_spec({CostKind::kGpu, cost.gpu});
    const auto value = spec.read(cell, LightMotion::kMoving);
    return value ? Measured{exact(*value), {}} : miss(cell, spec.field);
  }
  const LightMotion light = cost.id.starts_with("moving") ? LightMotion::kMoving : LightMotion::kStatic;
  return cost.is_ratio ? read_ratio(cell, light) : read_time(cell, light);
}

bool is_reference(const records::CellRecord& cell) {
  const auto& ratio = cell.ratio_to_none.lookup;
  return ratio && ratio->median == 1.0 && ratio->ci95.low == 1.0 && ratio->ci95.high == 1.0;
}

}  // namespace shadowbench::analysis
