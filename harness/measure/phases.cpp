#include "harness/measure/phases.h"

#include <algorithm>
#include <cmath>

#include "filters/random.h"

namespace shadowbench::measure {
namespace {

constexpr std::size_t kFewestOfPairs = 8;
constexpr const char* kOnePhase = "one phase of the map's grid tells nothing of the others; see --phases";

double wrap(double shift) { return shift < 0.5 ? shift : shift - 1.0; }

double draw(std::uint32_t seed, std::size_t number) {
  return filters::hash_bits(filters::hash_bits(seed) + static_cast<std::uint32_t>(number)) * 0x1p-32;
}

}  // namespace

std::size_t count_phases_of_group(std::size_t phases) { return phases >= kFewestOfPairs && phases % 2 == 0 ? 2 : 1; }

std::vector<glm::dvec2> list_phase_shifts(int count, std::uint32_t seed) {
  const std::size_t of_group = count_phases_of_group(static_cast<std::size_t>(count));
  std::vector<glm::dvec2> shifts;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::size_t group = i / of_group;
    const double half = i % of_group == 0 ? 0.0 : 0.5;
    const glm::dvec2 start =
        group == 0 ? glm::dvec2(0.0) : glm::dvec2(draw(seed, 2 * group), draw(seed, 2 * group + 1));
    shifts.emplace_back(wrap(std::fmod(start.x + half, 1.0)), wrap(std::fmod(start.y + half, 1.0)));
  }
  return shifts;
}

void note_errors(records::CellRecord& record, const std::vector<metrics::ErrorStats>& phases, std::size_t group) {
  metrics::ErrorStats sum;
  std::vector<double> replicates(phases.size() / group);
  for (const metrics::ErrorStats& stats : phases) {
    sum.rmse += stats.rmse;
    sum.mae += stats.mae;
    sum.p95 += stats.p95;
    sum.mean += stats.mean;
    sum.max = std::max(sum.max, stats.max);
  }
  for (std::size_t i = 0; i < replicates.size() * group; ++i)
    replicates[i / group] += phases[i].rmse / static_cast<double>(group);
  const auto count = static_cast<double>(phases.size());
  record.error.rmse = sum.rmse / count;
  record.error.mae = sum.mae / count;
  record.error.p95 = sum.p95 / count;
  record.error.max = sum.max;
  record.error.mean = sum.mean / count;
  record.phases = static_cast<std::int64_t>(phases.size());
  const auto interval = metrics::find_mean_interval(replicates);
  if (!interval) return;
  record.rmse_ci95 = records::Interval{interval->low, interval->high};
  record.rmse_replicates = std::move(replicates);
}

void note_flicker(records::CellRecord& record, const std::optional<metrics::Change>& change) {
  for (const char* field : {"error.flicker", "error.flicker_ci95", "error.rmse_ci95", "error.rmse_replicates"})
    if (!change) record.absent[field] = kOnePhase;
  if (!change) return;
  record.error.flicker = change->value;
  if (change->reach)
    record.flicker_ci95 =
        records::Interval{std::max(0.0, change->value - *change->reach), change->value + *change->reach};
  else
    record.absent["error.flicker_ci95"] = "two phases have no interval; see --phases";
}

}  // namespace shadowbench::measure
