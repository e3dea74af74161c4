#include "harness/measure/phases.h"

#include <algorithm>
#include <cmath>

#include "filters/random.h"
#include "reference/metrics/metric_table.h"

namespace shadowbench::measure {
namespace {

constexpr std::size_t kFewestOfPairs = 8;
constexpr const char* kFewPhases = "flicker needs eight sub-texel offsets of the map or more; see --phases";
constexpr const char* kOnePhase = "one phase of the map's grid tells nothing of the others; see --phases";

double wrap(double shift) { return shift < 0.5 ? shift : shift - 1.0; }

double draw(std::uint32_t seed, std::size_t number) {
  return filters::hash_bits(filters::hash_bits(seed) + static_cast<std::uint32_t>(number)) * 0x1p-32;
}

}  // namespace

std::size_t count_phases_of_group(std::size_t phases) { return phases >= kFewestOfPairs && phases % 2 == 0 ? 2 : 1; }

std::vector<glm::dvec2> list_phase_shifts(int count, std::uint32_t seed) {
  if (count == 1) return {glm::dvec2(0.0)};
  const std::size_t of_group = count_phases_of_group(static_cast<std::size_t>(count));
  std::vector<glm::dvec2> shifts;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::size_t group = i / of_group;
    const double half = i % of_group == 0 ? 0.0 : 0.5;
    const glm::dvec2 start(draw(seed, 2 * group), draw(seed, 2 * group + 1));
    shifts.emplace_back(wrap(std::fmod(start.x + half, 1.0)), wrap(std::fmod(start.y + half, 1.0)));
  }
  return shifts;
}

void note_errors(records::CellRecord& record, const std::vector<metrics::ErrorStats>& phases, std::size_t group) {
  using Number = std::optional<double>& (*)(metrics::MetricValues&);
  const auto count = static_cast<double>(phases.size());
  for (const metrics::Metric& metric : metrics::metric_table()) {
    if (!metric.statistic) continue;
    double sum = 0.0, largest = 0.0;
    for (const metrics::ErrorStats& stats : phases) {
      sum += stats.*metric.statistic;
      largest = std::max(largest, stats.*metric.statistic);
    }
    std::get<Number>(metric.member)(record) = metric.statistic == &metrics::ErrorStats::max ? largest : sum / count;
  }
  std::vector<double> replicates(phases.size() / group);
  for (std::size_t i = 0; i < replicates.size() * group; ++i)
    replicates[i / group] += phases[i].rmse / static_cast<double>(group);
  record.phases = static_cast<std::int64_t>(phases.size());
  const auto interval = metrics::find_mean_interval(replicates);
  if (!interval) {
    record.absent["error.rmse_ci95"] = record.absent["error.rmse_replicates"] = kOnePhase;
    return;
  }
  record.rmse_ci95 = records::Interval{interval->low, interval->high};
  record.rmse_replicates = std::move(replicates);
}

void note_flicker(records::CellRecord& record, const std::optional<metrics::Change>& change) {
  const bool is_few = record.phases.value_or(1) < static_cast<std::int64_t>(kFewestOfPairs);
  if (is_few || !change || !change->reach) {
    record.absent["error.flicker"] = record.absent["error.flicker_ci95"] = kFewPhases;
    return;
  }
  record.error.flicker = change->value;
  record.flicker_ci95 =
      records::Interval{std::max(0.0, change->value - *change->reach), change->value + *change->reach};
}

void note_step(records::CellRecord& record, const std::optional<metrics::Change>& change) {
  record.absent["error.flicker_ci95"] = "the flicker is of one step of the camera";
  if (change)
    record.error.flicker = change->value;
  else
    record.absent["error.flicker"] = "no receiver is finite both before and after a step of the camera";
}

}  // namespace shadowbench::measure
