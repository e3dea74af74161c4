#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "reference/metrics/flip.h"
#include "report/images/image.h"

namespace shadowbench::measure {

/// Looks at a linear RGB picture as FLIP does, clamped to [0,1] as a display does. Gives nothing where a pixel is not
/// finite, which would spread over its neighbours. Requires three channels.
std::optional<metrics::FlipView> view_picture(const images::Image& picture,
                                              double pixels_per_degree = metrics::kDefaultPixelsPerDegree);

/// The mean of values over the pixels where `mask` is not 0, or over all where it is empty; nothing where none counts.
std::optional<double> find_mean(std::span<const float> values, std::span<const std::uint8_t> mask);

/// The mean LDR-FLIP of two pictures over the pixels where `mask` is not 0, or over all where it is empty; FLIP
/// itself has seen the whole pictures. Gives nothing where one of them is missing, or where no pixel counts. Requires
/// one size, and a mask of that size.
std::optional<double> measure_mean_flip(const std::optional<metrics::FlipView>& a,
                                        const std::optional<metrics::FlipView>& b,
                                        std::span<const std::uint8_t> mask = {});

/// The same of pictures that are compared only once.
std::optional<double> measure_mean_flip(const images::Image& a, const images::Image& b,
                                        std::span<const std::uint8_t> mask = {},
                                        double pixels_per_degree = metrics::kDefaultPixelsPerDegree);

}  // namespace shadowbench::measure
