#pragma once

#include <cstdint>

#include "filters/depth_map.h"
#include "filters/filter_spec.h"
#include "filters/tracked.h"

namespace shadowbench::filters {

/// Everything a model may look at besides the receiver.
struct ModelInput {
  const FilterSpec& spec;
  const ParamValues& values;       ///< complete
  const DepthMap& map;             ///< must outlive what is prepared from it
  GlAccuracy accuracy;             ///< used by Precision::kTracked only
  std::uint32_t seed = 0;          ///< of the run: rotations
  double plane_max_tangent = 0.0;  ///< with receiver-plane bias: steeper planes are treated as this steep; 0: without
};

}  // namespace shadowbench::filters
