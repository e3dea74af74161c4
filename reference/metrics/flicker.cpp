#include "reference/metrics/flicker.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "reference/metrics/error_stats.h"

namespace shadowbench::metrics {
namespace {

double square_change(float now, float before) {
  const double change = static_cast<double>(now) - static_cast<double>(before);
  return change * change;
}

double root_mean(double squares, std::int64_t count) {
  return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0.0;
}

}  // namespace

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

FlickerMeter::FlickerMeter(std::vector<std::uint8_t> mask)
    : mask_(std::move(mask)), excess_(mask_.size()), excess_steps_(mask_.size()) {}

void FlickerMeter::Turn::follow(float value) {
  const float gone = value - farthest;
  if (way == 0) {
    if (std::abs(gone) <= kReturn) return;
    way = gone > 0.0f ? 1 : -1;
    farthest = value;
  } else if (gone * static_cast<float>(way) >= 0.0f) {
    farthest = value;
  } else if (std::abs(gone) > kReturn) {
    way = static_cast<std::int8_t>(-way);
    farthest = value;
    returned = true;
  }
}

void FlickerMeter::begin(Track& track, std::span<const float> values) const {
  track.last.assign(values.begin(), values.end());
  track.turns.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) track.turns[i].farthest = values[i];
}

void FlickerMeter::step(Track& track, std::span<const float> values) const {
  double squares = 0.0;
  std::int64_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!mask_[i] || !std::isfinite(values[i])) continue;
    Turn& turn = track.turns[i];
    if (!std::isfinite(turn.farthest)) turn.farthest = values[i];
    turn.follow(values[i]);
    if (!std::isfinite(track.last[i])) continue;
    squares += square_change(values[i], track.last[i]);
    ++count;
  }
  track.squares += squares;
  track.steps += count;
  track.step_change.push_back(root_mean(squares, count));
}

void FlickerMeter::compare(std::span<const float> image, std::span<const float> truth) {
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (!mask_[i]) continue;
    if (!std::isfinite(image[i]) || !std::isfinite(image_.last[i])) {
      ++not_finite_;
      continue;
    }
    const double excess = (static_cast<double>(image[i]) - static_cast<double>(image_.last[i])) -
                          (static_cast<double>(truth[i]) - static_cast<double>(truth_.last[i]));
    excess_[i] += excess * excess;
    ++excess_steps_[i];
  }
}

void FlickerMeter::add(std::span<const float> image, std::span<const float> truth) {
  assert(image.size() == mask_.size() && truth.size() == mask_.size());
  if (frames_++ == 0) {
    begin(image_, image);
    begin(truth_, truth);
    return;
  }
  compare(image, truth);
  step(image_, image);
  step(truth_, truth);
  image_.last.assign(image.begin(), image.end());
  truth_.last.assign(truth.begin(), truth.end());
}

double FlickerMeter::share_returned(const Track& track) const {
  double returned = 0.0, receivers = 0.0;
  for (std::size_t i = 0; i < mask_.size(); ++i) {
    receivers += mask_[i] ? 1.0 : 0.0;
    returned += mask_[i] && track.turns[i].returned ? 1.0 : 0.0;
  }
  return returned / receivers;
}

std::optional<FlickerStats> FlickerMeter::finish() const {
  FlickerStats stats;
  stats.receivers = static_cast<std::int64_t>(mask_.size()) - std::count(mask_.begin(), mask_.end(), 0);
  if (stats.receivers == 0 || frames_ < 2) return std::nullopt;
  stats.not_finite = not_finite_;
  stats.change = root_mean(image_.squares, image_.steps);
  stats.truth_change = root_mean(truth_.squares, truth_.steps);
  stats.returning = share_returned(image_);
  stats.truth_returning = share_returned(truth_);
  stats.step_change = image_.step_change;
  stats.truth_step_change = truth_.step_change;
  double squares = 0.0;
  std::int64_t steps = 0;
  for (std::size_t i = 0; i < mask_.size(); ++i) {
    stats.by_pixel.push_back(static_cast<float>(root_mean(excess_[i], excess_steps_[i])));
    squares += excess_[i];
    steps += excess_steps_[i];
  }
  stats.flicker = root_mean(squares, steps);
  return stats;
}

}  // namespace shadowbench::metrics
