#include "report/analysis/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "report/records/gpu_frame.h"

namespace shadowbench::analysis {
namespace {

constexpr const char* kMaxMs = "--max-ms";

std::optional<double> read_estimate(const records::CellRecord& cell, const std::string& gpu, LightMotion light) {
  if (!cell.gpu) return std::nullopt;
  const auto found = cell.gpu->find(gpu);
  if (found == cell.gpu->end() || !found->second.estimate) return std::nullopt;
  return records::frame_ms(*found->second.estimate, light == LightMotion::kMoving);
}

}  // namespace

std::optional<double> LimitSpec::read(const records::CellRecord& cell, LightMotion light) const {
  if (metric) return metric->read(cell);
  if (!gpu.empty()) return read_estimate(cell, gpu, light);
  const auto& time = frame_time(cell, light);
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

const std::optional<records::OwnTime>& frame_time(const records::CellRecord& cell, LightMotion light) {
  return light == LightMotion::kStatic ? cell.time_ms.static_light : cell.time_ms.moving;
}

const std::optional<records::Ratio>& frame_ratio(const records::CellRecord& cell, LightMotion light) {
  return light == LightMotion::kStatic ? cell.ratio_to_none.static_light : cell.ratio_to_none.moving;
}

std::string describe_demand(const Demand& demand) {
  return demand.spec ? fmt::format("{} {}", demand.spec->option, demand.most) : "--requires " + demand.claim;
}

}  // namespace shadowbench::analysis
