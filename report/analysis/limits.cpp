#include "report/analysis/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "report/records/gpu_frame.h"

namespace shadowbench::analysis {
namespace {

constexpr const char* kMaxMs = "--max-ms";

void add(records::Quartiles& sum, const records::Quartiles& pass) {
  sum.median += pass.median;
  sum.q1 += pass.q1;
  sum.q3 += pass.q3;
  sum.n = std::min(sum.n, pass.n);
}

std::optional<double> read_estimate(const records::CellRecord& cell, const std::string& gpu, LightMotion light) {
  if (!cell.gpu) return std::nullopt;
  const auto found = cell.gpu->find(gpu);
  if (found == cell.gpu->end() || !found->second.estimate) return std::nullopt;
  return records::frame_ms(*found->second.estimate, light == LightMotion::kMoving);
}

const std::optional<records::OwnTime>& own_time(const records::CellRecord& cell, LightMotion light) {
  return light == LightMotion::kStatic ? cell.time_ms.static_light : cell.time_ms.moving;
}

}  // namespace

std::optional<double> LimitSpec::read(const records::CellRecord& cell, LightMotion light) const {
  if (metric) return metric->read(cell);
  if (!gpu.empty()) return read_estimate(cell, gpu, light);
  const auto time = frame_time(cell, light);
  return time ? std::optional(time->median) : std::nullopt;
}

std::span<const LimitSpec> limit_table() {
  static const std::vector<LimitSpec> table = [] {
    std::vector<LimitSpec> limits;
    for (const metrics::Metric& metric : metrics::metric_table())
      if (!metric.limit.empty())
        limits.push_back({std::string(metric.limit), std::string(metric.path),
                          fmt::format("{}: {}, {} (see 'list metrics')", metric.title, metric.unit,
                                      metrics::describe_range(metric.range)),
                          &metric});
    limits.push_back({kMaxMs, "time_ms", "a frame, ms: its estimate, or its median time; see --cheapest", nullptr});
    return limits;
  }();
  return table;
}

const LimitSpec& limit_of(std::string_view field) {
  return *std::ranges::find(limit_table(), field, &LimitSpec::field);
}

const LimitSpec& cost_spec(const CostKind& cost) {
  switch (cost.kind) {
    case CostKind::kTime: return limit_of("time_ms");
    case CostKind::kBytes: return limit_of("cost.map_bytes");
    case CostKind::kFetches: return limit_of("cost.fetches");
    case CostKind::kGpu: break;
  }
  static std::map<std::string, LimitSpec> specs;
  return specs
      .try_emplace(cost.gpu, LimitSpec{kMaxMs, fmt::format("gpu.{}.frame_ms", cost.gpu),
                                       "estimated milliseconds of a frame", nullptr, cost.gpu})
      .first->second;
}

std::optional<records::Quartiles> frame_time(const records::CellRecord& cell, LightMotion light) {
  if (const auto& own = own_time(cell, light)) return *own;
  const records::TimeRecord& time = cell.time_ms;
  if (!time.lookup) return std::nullopt;
  records::Quartiles sum = *time.lookup;
  if (light == LightMotion::kStatic) return sum;
  // A filter that looks up the depth map itself has no prefilter to time.
  const bool prefilters = time.prefilter || cell.cost.prefilter_texels.value_or(0) > 0;
  if (!time.map || (prefilters && !time.prefilter)) return std::nullopt;
  add(sum, *time.map);
  if (prefilters) add(sum, *time.prefilter);
  return sum;
}

std::optional<records::Interval> frame_interval(const records::CellRecord& cell, LightMotion light) {
  if (const auto& own = own_time(cell, light)) return own->ci95;
  const auto time = frame_time(cell, light);
  const auto& ratio = frame_ratio(cell, light);
  if (!time || !ratio || !(ratio->median > 0.0)) return std::nullopt;
  const double scale = time->median / ratio->median;
  return records::Interval{scale * ratio->ci95.low, scale * ratio->ci95.high};
}

const std::optional<records::Ratio>& frame_ratio(const records::CellRecord& cell, LightMotion light) {
  return light == LightMotion::kStatic ? cell.ratio_to_none.static_light : cell.ratio_to_none.moving;
}

std::string describe_demand(const Demand& demand) {
  return demand.spec ? fmt::format("{} {}", demand.spec->option, demand.most) : "--requires " + demand.claim;
}

}  // namespace shadowbench::analysis
