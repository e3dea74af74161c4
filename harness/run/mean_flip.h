#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "reference/metrics/flip.h"
#include "report/image.h"

namespace shadowbench::run {

/// Gives the mean LDR-FLIP of two linear RGB pictures over the pixels where `mask` is not 0, or over all where it is
/// empty. FLIP itself always sees the whole pictures, clamped to [0,1] as a display does. Gives nothing where a pixel
/// of either is not finite, which would spread over its neighbours, or where no pixel counts. Requires three channels,
/// one size, and a mask of that size. Cost: as measure_flip().
std::optional<double> measure_mean_flip(const report::Image& a, const report::Image& b,
                                        std::span<const std::uint8_t> mask = {},
                                        double pixels_per_degree = reference::kDefaultPixelsPerDegree);

}  // namespace shadowbench::run
