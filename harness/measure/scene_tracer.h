#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/measure/truth_cache.h"
#include "harness/measure/view_receivers.h"
#include "harness/scene/lights/light_fit.h"
#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"

namespace shadowbench::measure {

/// What rays say of one view, whatever the map.
struct ViewRays {
  truth::TracedVisibility area;          ///< the fraction of the light that is seen
  std::vector<float> hard;               ///< the light's centre
  std::vector<float> first_blockers_ws;  ///< see trace_first_blockers()
};

/// Makes what rays can hit of a scene: every caster, with the holes of its material.
truth::Occluders make_occluders(const scene::Scene& scene);

/// Traces one scene's views, or takes what an earlier run traced from the cache. Nothing is built for tracing until
/// something has to be traced.
class SceneTracer {
 public:
  /// `scene` and `cache` must outlive this object.
  SceneTracer(const scene::Scene& scene, TruthCache& cache, std::uint32_t seed);

  /// Cost: 64 rays for most pixels, up to 16384 at the edges of shadows.
  ViewRays trace_view(const ViewReceivers& receivers);

  /// Traces a filter's continuous kernel, as large as it is in a map of this frustum. Cost: as trace_view().
  truth::TracedVisibility trace_kernel(const ViewReceivers& receivers, const filters::Kernel& kernel,
                                       const scene::LightFrustum& frustum);

  /// Traces a square of a half-width in texels, only to find where its rays agree. Cost: 64 to 256 rays a pixel.
  truth::TracedVisibility trace_surroundings(const ViewReceivers& receivers, double half_width_texels,
                                             const scene::LightFrustum& frustum);

 private:
  const scene::Scene& scene_;
  TruthCache& cache_;
  std::uint32_t seed_;
  std::string geometry_;  ///< names all occluders and the code that traces; empty until something is traced
  std::optional<truth::Occluders> occluders_;

  const std::string& geometry();
  const truth::Occluders& occluders();
  truth::TraceSettings settings() const;

  /// Takes from the cache what `what` names, or traces and keeps it: parts of these names and of the receivers' size.
  std::vector<images::Part> find_or_trace(const ViewReceivers& receivers, const std::string& what,
                                          const std::vector<std::string>& part_names,
                                          const std::function<std::vector<images::Part>()>& trace);
};

}  // namespace shadowbench::measure
