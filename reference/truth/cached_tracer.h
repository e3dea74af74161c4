#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reference/truth/truth_cache.h"
#include "reference/truth/visibility.h"

namespace shadowbench::truth {

/// What rays find for one view of one light; it does not depend on any shadow map.
struct ViewRays {
  TracedVisibility area;                 ///< the fraction of the light that is seen
  std::vector<float> hard;               ///< how much of the light's centre is seen
  std::vector<float> first_blockers_ws;  ///< see trace_first_blockers()
};

/// Of kernels; that of lights is TraceSettings' own.
inline constexpr double kKernelStandardError = 0.01;

/// Traces one scene, or takes from the cache what an earlier run traced. The acceleration structure is built when the
/// first rays are needed. Receivers without a `content` are always traced.
class CachedTracer {
 public:
  using MeshList = std::function<std::vector<OccluderMesh>()>;

  /// `cache`, and what `list_meshes` refers to, must outlive this object.
  CachedTracer(MeshList list_meshes, TruthCache& cache, std::uint32_t seed);

  /// Says from now on how much of an image is traced, 0 .. 1, from many threads.
  void listen(std::function<void(double part)> on_part) { settings_.on_part = std::move(on_part); }

  /// Shows from now on what is traced, tile by tile, from many threads: see TraceSettings. What the cache holds is not
  /// traced.
  void show(int coarsest, std::function<void(const TracedTile&)> on_tile) {
    settings_.coarsest = coarsest;
    settings_.on_tile = std::move(on_tile);
  }

  /// Lets tracing end with TracingStopped, from now on, where this asks for it. Nothing of it comes into the cache.
  void heed(std::stop_token stop) { settings_.stop = std::move(stop); }

  /// Cost: 64 rays for most pixels, up to 16384 at the edges of shadows.
  ViewRays trace_view(const ReceiverImage& receivers, const AreaLight& light);

  /// The share of an area light's light that arrives at each receiver, for pictures that are only looked at.
  /// Cost: 64 rays for each receiver, with which a penumbra has a standard error of about 0.01.
  std::vector<float> trace_light(const ReceiverImage& receivers, const AreaLight& light);

  /// Traces a kernel within a standard error of `kKernelStandardError`: a part of an error is the mean over many
  /// pixels, off which its `variance` can be taken. Cost: as trace_view(), about half of its rays.
  TracedVisibility trace_kernel(const ReceiverImage& receivers, const filters::Kernel& kernel, const MapGrid& grid);

  /// Traces disks of a radius for each receiver. Error and cost: as trace_kernel().
  TracedVisibility trace_disks(const ReceiverImage& receivers, std::span<const float> radii_texels,
                               const MapGrid& grid);

  /// Traces a square, with just enough rays to see where they all agree. Cost: 64 rays a pixel, at edges fewer.
  TracedVisibility trace_surroundings(const ReceiverImage& receivers, double half_width_texels, const MapGrid& grid);

 private:
  MeshList list_meshes_;
  TruthCache& cache_;
  TraceSettings settings_;
  std::string geometry_;  ///< names all meshes and the code that traces; empty until it is needed
  std::optional<Occluders> occluders_;
  std::map<AreaLight::Shape, SampleSets> samples_;  ///< of lights, made when they are first needed

  const std::string& geometry();
  const Occluders& occluders();
  const SampleSets& samples(const AreaLight& light);
  TraceSettings within(double standard_error) const;

  /// Returns the `count` layers that `what` names: from the cache, or from `trace`, and then kept.
  Layers find_or_trace(const ReceiverImage& receivers, const std::string& what, std::size_t count,
                       const std::function<Layers()>& trace);
  TracedVisibility find_or_trace(const ReceiverImage& receivers, const std::string& what,
                                 const std::function<TracedVisibility()>& trace);
};

}  // namespace shadowbench::truth
