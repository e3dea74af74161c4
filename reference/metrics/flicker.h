#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shadowbench::metrics {

/// How much images of the same receivers differ that are independent of each other.
struct Change {
  double value = 0.0;                ///< root mean square over receivers and pairs of images
  std::optional<double> reach = {};  ///< half-width of its 95 % interval, by the jackknife; none for two groups
};

/// How much visibility changes between frames that are independent of each other, where the truth has none. Every
/// `group` images that follow each other are no such frames, being chosen to differ: only pairs of two groups count, so
/// that the result does not depend on how large the groups are. `mask` is not 0 where a pixel counts; a receiver that
/// is not finite in one image is left out. Nothing for fewer than two groups or where no receiver is left. Source: the
/// mean over pairs is Hoeffding's U-statistic; its interval is Arvesen's (1969, Jackknifing U-Statistics, Annals of
/// Mathematical Statistics 40(6)).
std::optional<Change> measure_change(std::span<const std::span<const float>> images, std::size_t group,
                                     std::span<const std::uint8_t> mask);

}  // namespace shadowbench::metrics
