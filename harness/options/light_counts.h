#pragma once

#include <cstdint>
#include <vector>

#include "filters/catalogue.h"
#include "harness/options/options.h"

namespace shadowbench::options {

/// Most lights of a frame that is timed.
inline constexpr int kMostLights = 16;

/// Most bytes that the maps of a frame's lights may take together.
inline constexpr std::int64_t kMostLightMapBytes = std::int64_t{1} << 30;

/// Gives the bytes of all maps that are there while frames of so many lights are timed: a depth map for each light
/// (three for a midpoint map) and, for each format that one of the filters stores, an encoded map for each light.
/// Filters take turns in the encoded maps, so that their number does not count.
std::int64_t count_light_map_bytes(const RunOptions& options, int lights, int map_size);

/// Throws Error(kUsage) where the maps of `options.lights` would take more than kMostLightMapBytes.
void require_light_maps_fit(const RunOptions& options);

}  // namespace shadowbench::options
