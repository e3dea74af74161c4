#pragma once

#include <cstdint>
#include <vector>

#include "filters/catalogue.h"
#include "harness/options/options.h"

namespace shadowbench::options {

/// The most lights that a timed frame may have.
inline constexpr int kMostLights = 16;

/// The most bytes that the maps of a frame's lights may take together.
inline constexpr std::int64_t kMostLightMapBytes = std::int64_t{1} << 30;

/// Counts the bytes of all maps that exist while frames with `lights` lights are timed: for each light a depth map
/// (three for a midpoint map) and one encoded map for each format that any of the filters stores. Filters share these
/// encoded maps, so that the number of filters does not count.
std::int64_t count_light_map_bytes(const RunOptions& options, int lights, int map_size);

/// Throws Error(kUsage) where the maps of `options.lights` would take more than kMostLightMapBytes.
void require_light_maps_fit(const RunOptions& options);

}  // namespace shadowbench::options
