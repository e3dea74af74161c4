#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "reference/truth/visibility.h"

namespace shadowbench::truth {

/// What was traced for one view, as numbers of equal count for each layer.
using Layers = std::vector<std::vector<float>>;

/// What a run leaves of its cache, for prune(); the truths of a default run take some 15 MiB.
inline constexpr std::uintmax_t kMaxCacheBytes = std::uintmax_t{1} << 30;

/// Keeps what was traced between runs, one file each, named by all that the result depends on: geometry, receivers,
/// light, settings and the code that traces. The files can be deleted at any time.
class TruthCache {
 public:
  /// With an empty folder name nothing is kept. In a folder that holds other files, nothing is ever deleted; in one of
  /// our own, what killed processes left half-written is. `note` is called once if the folder cannot be written.
  TruthCache(std::filesystem::path folder, std::function<void(const std::string&)> note);

  /// Returns what was kept under a name, or nothing if there is no file, or one that is damaged, of another name, or of
  /// another size than `layers` times `values`.
  std::optional<Layers> load(const std::string& name, std::size_t layers, std::size_t values);

  void store(const std::string& name, const Layers& layers);

  /// Deletes the files that were used longest ago until the folder holds at most `max_bytes`: no others than this class
  /// wrote, and in a folder of our own.
  void prune(std::uintmax_t max_bytes) const;

  int loaded() const { return loaded_; }  ///< how often load() found what it was asked for
  int traced() const { return traced_; }  ///< how often it did not

 private:
  std::filesystem::path folder_;
  bool is_ours_;
  std::function<void(const std::string&)> note_;
  int loaded_ = 0;
  int traced_ = 0;

  std::filesystem::path path_of(const std::string& name) const { return folder_ / (name + ".truth"); }
};

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
