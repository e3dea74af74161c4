#include "reference/metrics/flicker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "reference/metrics/error_stats.h"

namespace shadowbench::metrics {

std::optional<Change> measure_change(std::span<const std::span<const float>> images, std::size_t group,
                                     std::span<const std::uint8_t> mask) {
  assert(group > 0 && images.size() % group == 0);
  const std::size_t groups = images.size() / group;
  const double all = static_cast<double>(images.size()), own = static_cast<double>(group);
  std::vector<double> of_group(groups);  // of the pairs that it is one side of
  std::vector<double> sums(groups), powers(groups);
  std::size_t receivers = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    const auto is_finite = [&](std::span<const float> image) { return std::isfinite(image[i]); };
    if (mask[i] == 0 || !std::ranges::all_of(images, is_finite)) continue;
    ++receivers;
    double sum = 0.0, power = 0.0;
    for (std::size_t g = 0; g < groups; ++g) {
      sums[g] = powers[g] = 0.0;
      for (std::size_t k = g * group; k < (g + 1) * group; ++k) {
        const double value = static_cast<double>(images[k][i]) - static_cast<double>(images[0][i]);
        sums[g] += value;
        powers[g] += value * value;
      }
      sum += sums[g];
      power += powers[g];
    }
    for (std::size_t g = 0; g < groups; ++g)
      of_group[g] += (all - own) * powers[g] + own * (power - powers[g]) - 2.0 * sums[g] * (sum - sums[g]);
  }
  const double squares = 0.5 * std::accumulate(of_group.begin(), of_group.end(), 0.0);
  if (groups < 2 || receivers == 0) return std::nullopt;
  const auto mean_of = [&](double sum, std::size_t count) {
    const double pairs = 0.5 * static_cast<double>(count * (count - 1) * group * group * receivers);
    return std::sqrt(std::max(0.0, sum) / pairs);
  };
  Change change{mean_of(squares, groups)};
  if (groups < 3) return change;
  std::vector<double> pseudo_values;
  for (const double each : of_group)
    pseudo_values.push_back(static_cast<double>(groups) * change.value -
                            static_cast<double>(groups - 1) * mean_of(squares - each, groups - 1));
  const MeanInterval interval = *find_mean_interval(pseudo_values);
  change.reach = interval.high - interval.mean;
  return change;
}

}  // namespace shadowbench::metrics
