#pragma once

#include <memory>
#include <vector>

#include "harness/measure/renderer.h"
#include "harness/measure/scene_assets.h"
#include "harness/render/filter_passes.h"

namespace shadowbench::measure {

/// Lookups that read what filters read of their receivers, and nothing of the map: what a lookup takes longer than its
/// empty one is the filter's own time.
struct EmptyLookups {
  std::vector<std::unique_ptr<render::FilterPasses>> passes;  ///< no two read the same
  std::vector<std::size_t> of_filter;                         ///< index into `passes`, one per filter
};

/// Compiles those that these filters need, over the light's map.
EmptyLookups make_empty_lookups(Renderer& renderer, const options::RunOptions& options, const scene::Scene& scene,
                                const LightMap& light, const std::vector<render::FilterPasses*>& filters);

}  // namespace shadowbench::measure
