#include "report/analysis/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "reference/metrics/error_stats.h"
#include "report/analysis/cells.h"
#include "report/records/format.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

Estimate subtract(const Estimate& a, const Estimate& b) {
  const double difference = a.value - b.value;
  double reach = std::max(a.high - a.value, b.high - b.value);
  if (a.replicates.size() == b.replicates.size() && a.replicates.size() > 1) {
    std::vector<double> differences;
    std::ranges::transform(a.replicates, b.replicates, std::back_inserter(differences), std::minus());
    const metrics::MeanInterval interval = *metrics::find_mean_interval(differences);
    reach = interval.high - interval.mean;
  }
  return {difference, difference - reach, difference + reach};
}

bool is_clearly_less_error(const Estimate& a, const Estimate& b) { return subtract(b, a).low > 0.0; }

bool is_clearly_less_cost(const Estimate& a, const Estimate& b) { return a.high < b.low; }

namespace {

constexpr const char* kMaxMs = "--max-ms";

std::optional<double> read_estimate(const records::CellRecord& cell, const std::string& gpu, LightMotion light) {
  if (!cell.gpu) return std::nullopt;
  const auto found = cell.gpu->find(gpu);
  if (found == cell.gpu->end() || !found->second.estimate) return std::nullopt;
  return records::frame_ms(*found->second.estimate, light == LightMotion::kMoving);
}

}  // namespace

Quantity Quantity::of(const metrics::Metric& metric) {
  return {.id = std::string(metric.name()),
          .title = std::string(metric.title),
          .meaning = metric.definition,
          .field = std::string(metric.path),
          .option = std::string(metric.limit),
          .unit = std::string(metric.unit),
          .metric = &metric};
}

std::optional<double> Quantity::read(const records::CellRecord& cell, LightMotion at) const {
  if (metric) return metric->read(cell);
  if (is(CostKind::kGpu)) return read_estimate(cell, cost->gpu, at);
  const auto& time = frame_time(cell, at);
  return time ? std::optional(time->median) : std::nullopt;
}

std::span<const Quantity> limit_table() {
  static const std::vector<Quantity> table = [] {
    std::vector<Quantity> limits;
    for (const metrics::Metric& metric : metrics::metric_table())
      if (!metric.limit.empty()) {
        Quantity& limit = limits.emplace_back(Quantity::of(metric));
        limit.meaning = fmt::format("{}: {}, {} (see 'list metrics')", metric.title, metric.unit,
                                    metrics::describe_range(metric.range));
      }
    limits.push_back({.id = "time",
                      .title = "time of a frame",
                      .meaning = "a frame, ms: its estimate, or its median time; see --cheapest",
                      .field = "time_ms",
                      .option = kMaxMs,
                      .cost = CostKind::kTime});
    return limits;
  }();
  return table;
}

const Quantity& limit_of(std::string_view field) { return *std::ranges::find(limit_table(), field, &Quantity::field); }

const Quantity& cost_spec(const CostKind& cost) {
  switch (cost.kind) {
    case CostKind::kTime: return limit_of("time_ms");
    case CostKind::kBytes: return limit_of("cost.map_bytes");
    case CostKind::kFetches: return limit_of("cost.fetches");
    case CostKind::kGpu: break;
  }
  static std::map<std::string, Quantity> specs;
  return specs
      .try_emplace(cost.gpu, Quantity{.id = "gpu." + cost.gpu,
                                      .title = "estimated milliseconds of a frame",
                                      .meaning = "",
                                      .field = fmt::format("gpu.{}.frame_ms", cost.gpu),
                                      .option = kMaxMs,
                                      .cost = cost})
      .first->second;
}

const std::optional<records::OwnTime>& frame_time(const records::CellRecord& cell, LightMotion light) {
  return light == LightMotion::kStatic ? cell.time_ms.static_light : cell.time_ms.moving;
}

const std::optional<records::Ratio>& frame_ratio(const records::CellRecord& cell, LightMotion light) {
  return light == LightMotion::kStatic ? cell.ratio_to_none.static_light : cell.ratio_to_none.moving;
}

std::string describe_demand(const Demand& demand) {
  return demand.spec ? fmt::format("{} {}", demand.spec->option, demand.most)
                     : fmt::format("--requires {}", kContactHardening);
}

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

Measured read_frame(const records::CellRecord& cell, const Quantity& cost) {
  const auto value = cost_spec(*cost.cost).read(cell, cost.light);
  if (!value) return miss(cell, cost.full_field());
  if (!cost.is(CostKind::kTime)) return {exact(*value), {}};
  const records::Interval& interval = frame_time(cell, cost.light)->ci95;
  return {Estimate{*value, interval.low, interval.high}, {}};
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

Quantity make_measure(std::string_view path, const char* interval, const char* over_scenes,
                      Estimate (*combine)(const std::vector<Estimate>&)) {
  Quantity measure = Quantity::of(metrics::find_metric(path));
  measure.meaning += fmt::format("; {}", interval);
  measure.over_scenes = over_scenes;
  measure.combine = combine;
  return measure;
}

Quantity make_count_measure(std::string_view path, const char* interval, CostKind::Kind kind) {
  Quantity measure = make_measure(path, interval, kMean, mean_over_scenes);
  measure.cost = kind;
  return measure;
}

// "480x270", of cells of one size; else in words.
std::string describe_picture(const std::vector<const records::CellRecord*>& cells) {
  std::set<std::pair<int, int>> sizes;
  for (const records::CellRecord* cell : cells) sizes.insert({cell->width, cell->height});
  return sizes.size() == 1 ? fmt::format("of a {}x{} frame", sizes.begin()->first, sizes.begin()->second)
                           : "of a frame, of each picture's size,";
}

const char* name_light(LightMotion light) { return light == LightMotion::kMoving ? "moving" : "static"; }

bool has_estimate(const std::vector<records::CellRecord>& cells, const CostKind& gpu) {
  return std::ranges::any_of(
      cells, [&](const auto& cell) { return cost_spec(gpu).read(cell, LightMotion::kMoving).has_value(); });
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

const std::array<Quantity, kErrorMeasures>& list_error_measures() {
  static const char* const kRootMeanSquare = "root mean square over the scenes";
  static const std::array<Quantity, kErrorMeasures> kMeasures = {
      make_measure(kRmse, "interval: 95 %, over sub-texel offsets of the map", kRootMeanSquare, root_mean_square),
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

CostKind choose_cost(const std::vector<records::CellRecord>& cells) {
  const auto is_of_cpu = [](const auto& cell) { return cell.external || (cell.machine && cell.machine->software); };
  if (mixes_machines(cells) || std::ranges::all_of(cells, is_of_cpu))
    for (const std::string& gpu : list_gpus(point_to(cells)))
      if (const CostKind cost(CostKind::kGpu, gpu); has_estimate(cells, cost)) return cost;
  return CostKind::kTime;
}

Quantity make_frame_measure(const CostKind& cost, LightMotion light,
                            const std::vector<const records::CellRecord*>& cells) {
  const bool is_moving = light == LightMotion::kMoving;
  Quantity made{.id = name_light(light),
                .title = {},
                .meaning = {},
                .field = cost_spec(cost).field,
                .cost = cost,
                .light = light,
                .over_scenes = kMean,
                .combine = mean_over_scenes};
  if (cost.kind == CostKind::kGpu) {
    made.id = fmt::format("gpu.{}.{}", cost.gpu, made.id);
    made.title = fmt::format("estimate for {}, {} light", cost.gpu, name_light(light));
    made.meaning = fmt::format(
        "ms of a {}x{} frame with one map, estimated for {}, {} light: {}; left out: what every lookup pays. "
        "Published times were missed by a factor of at most {}",
        records::kGpuFrameWidth, records::kGpuFrameHeight, cost.gpu, name_light(light),
        is_moving ? "a lower bound of the map, prefilter and lookups" : "lookups", records::kEstimateFactor);
  } else {
    made.title =
        is_moving ? "time of map, prefilter and filter, moving light" : "time of the filter alone, static light";
    made.meaning = fmt::format(
        "ms {} with one map, measured, {} light: {}; left out: what every lookup pays, which one that reads nothing "
        "tells in each round; interval: 95 % of the median",
        describe_picture(cells), name_light(light), is_moving ? "map, prefilter and lookups" : "lookups");
  }
  return made;
}

std::vector<Quantity> list_cost_measures(const std::vector<records::CellRecord>& cells) {
  const std::vector<const records::CellRecord*> all = point_to(cells);
  std::vector<CostKind> costs = {choose_cost(cells)};
  const auto add = [&](const CostKind& cost) {
    if (cost != costs.front()) costs.push_back(cost);
  };
  if (!mixes_machines(cells)) add(CostKind::kTime);
  for (const std::string& gpu : list_gpus(all)) add({CostKind::kGpu, gpu});
  std::vector<Quantity> measures;
  for (const CostKind& cost : costs)
    for (const LightMotion light : {LightMotion::kMoving, LightMotion::kStatic})
      measures.push_back(make_frame_measure(cost, light, all));
  measures.push_back(make_count_measure("cost.fetches", "no interval", CostKind::kFetches));
  measures.push_back(make_count_measure("cost.map_bytes", "exact", CostKind::kBytes));
  measures.back().id = "bytes";
  return measures;
}

std::string Quantity::full_field() const { return metric ? field : fmt::format("{}.{}", field, name_light(light)); }

std::string unit_of(const Quantity& measure, const records::GlRecord& gl) {
  if (measure.is(CostKind::kTime)) return records::time_unit(gl);
  return measure.is(CostKind::kGpu) ? "ms" : "";
}

std::string name_axis(const Quantity& measure, const records::GlRecord& gl) {
  if (measure.is(CostKind::kTime)) return fmt::format("{}, ms: {}", measure.title, records::describe_clock(gl));
  if (!measure.is(CostKind::kGpu)) return measure.title;
  return fmt::format("{}, ms of a {}x{} frame", measure.title, records::kGpuFrameWidth, records::kGpuFrameHeight);
}

std::string format_value(const Quantity& measure, double value) {
  return measure.is(CostKind::kBytes) ? records::format_bytes(value) : records::format_number(value);
}

std::string format_estimate(const Quantity& measure, const Estimate& estimate) {
  const std::string value = format_value(measure, estimate.value);
  if (estimate.low == estimate.high) return value;
  return fmt::format("{} [{}, {}]", value, format_value(measure, estimate.low), format_value(measure, estimate.high));
}

Measured read_error(const records::CellRecord& cell, const Quantity& measure) {
  const metrics::Metric& metric = *measure.metric;
  Measured error = read_metric(cell, metric);
  if (error.estimate && metric.path == kRmse) error.estimate = estimate_rmse(cell);
  return error;
}

std::optional<Estimate> combine_rmse(const std::vector<const records::CellRecord*>& cells) {
  std::vector<Estimate> estimates;
  for (const records::CellRecord* cell : cells) {
    if (!cell->error.rmse) return std::nullopt;
    estimates.push_back(estimate_rmse(*cell));
  }
  return estimates.empty() ? std::nullopt : std::optional(root_mean_square(estimates));
}

Measured read_cost(const records::CellRecord& cell, const Quantity& cost) {
  return cost.metric ? read_metric(cell, *cost.metric) : read_frame(cell, cost);
}

}  // namespace shadowbench::analysis
