#pragma once

#include <cstdint>
#include <vector>

#include "filters/filter_spec.h"
#include "filters/tracked.h"

namespace shadowbench::filters {

/// A depth map as read back from the GL; row 0 is v = 0, depth in [0,1].
struct DepthMap {
  int size = 0;              ///< texels per side
  std::vector<float> depth;  ///< size * size
};

/// Everything a model may look at besides the receiver.
struct ModelInput {
  const FilterSpec& spec;
  const ParamValues& values;  ///< complete
  const DepthMap& map;        ///< must outlive what is prepared from it
  GlAccuracy accuracy;        ///< used by Precision::kTracked only
  std::uint32_t seed = 0;     ///< of the run: rotations
  double plane_max_tangent = 0.0;  ///< with receiver-plane bias: steeper planes are treated as this steep; 0: without
};

}  // namespace shadowbench::filters
