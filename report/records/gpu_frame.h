#pragma once

#include "report/records/records.h"

namespace shadowbench::records {

/// The frame that a cost on a GPU is of: each of its pixels is a receiver that is looked up.
inline constexpr int kGpuFrameWidth = 1920, kGpuFrameHeight = 1080;

/// By which factor estimates missed published times at most; harness/gpu/README.md has them side by side.
inline constexpr double kEstimateFactor = 1.6;

/// Milliseconds that the lookups of such a frame take of what a million receivers take, microseconds.
inline constexpr double lookups_ms(double million_us) {
  return million_us * (1e-6 * kGpuFrameWidth * kGpuFrameHeight) * 1e-3;
}

/// What such a frame costs by an estimate, milliseconds: its lookups, and where light or casters move the prefilter of
/// one map and a lower bound of drawing it. What every lookup pays is in no estimate.
inline double frame_ms(const GpuEstimateRecord& estimate, bool is_moving) {
  return lookups_ms(estimate.lookup_us) + (is_moving ? 1e-3 * (estimate.prefilter_us + estimate.map_us) : 0.0);
}

}  // namespace shadowbench::records
