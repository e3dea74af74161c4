#include "reference/truth/cached_tracer.h"

#include <fmt/format.h>

#include "base/content_hash.h"
#include "reference/truth/embree.h"

namespace shadowbench::truth {
namespace {

/// Names the code that traces: it changes with the sources of this folder and of the kernels, and with Embree's
/// version.
constexpr const char* kVersion = SHADOWBENCH_TRUTH_SOURCES " Embree " RTC_VERSION_STRING;
constexpr std::size_t kTracedLayers = 5;
constexpr std::size_t kViewLayers = kTracedLayers + 4;

std::string name_geometry(const std::vector<OccluderMesh>& meshes) {
  ContentHash hash;
  hash.add(kVersion);
  for (const OccluderMesh& mesh : meshes) {
    hash.add_values(std::span<const glm::vec3>(mesh.positions));
    hash.add_values(std::span<const std::uint32_t>(mesh.indices));
    if (!mesh.cut_out) continue;
    const CutOut& holes = *mesh.cut_out;
    hash.add_values(std::span<const glm::vec2>(holes.uvs));
    hash.add(fmt::format("{} {} {} {} {}", holes.width, holes.height, holes.base_alpha, holes.cutoff, holes.dims));
    hash.add_values(std::span<const std::uint8_t>(holes.alpha));
  }
  return hash.name();
}

std::string name_vector(const glm::dvec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

std::string name_grid(const MapGrid& grid) {
  std::string name = fmt::format("texel {} light {} right {} up {}", grid.texel_size_ws, name_vector(grid.to_light),
                                 name_vector(grid.right), name_vector(grid.up));
  if (grid.lamp) name += fmt::format(" lamp {} {}", name_vector(grid.lamp->position_ws), grid.lamp->reference_m);
  if (grid.curved) name += " " + grid.curved->name;
  return name;
}

std::string name_light(const AreaLight& light) {
  return fmt::format("light {} at {} u {} v {}", static_cast<int>(light.shape()),
                     name_vector(light.centre_direction(glm::dvec3(0.0))), name_vector(light.half_u()),
                     name_vector(light.half_v()));
}

Layers to_layers(const TracedVisibility& traced) {
  return {traced.visibility,
          traced.standard_error,
          {traced.unanimous.begin(), traced.unanimous.end()},
          {traced.rays.begin(), traced.rays.end()},
          traced.variance};
}

TracedVisibility from_layers(Layers layers) {
  return {.visibility = std::move(layers[0]),
          .standard_error = std::move(layers[1]),
          .unanimous = {layers[2].begin(), layers[2].end()},
          .rays = {layers[3].begin(), layers[3].end()},
          .variance = std::move(layers[4])};
}

}  // namespace

CachedTracer::CachedTracer(MeshList list_meshes, TruthCache& cache, std::uint32_t seed)
    : list_meshes_(std::move(list_meshes)), cache_(cache) {
  settings_.seed = seed;
}

const std::string& CachedTracer::geometry() {
  if (geometry_.empty()) geometry_ = name_geometry(list_meshes_());
  return geometry_;
}

const Occluders& CachedTracer::occluders() {
  if (!occluders_) occluders_.emplace(list_meshes_());
  return *occluders_;
}

const SampleSets& CachedTracer::samples(const AreaLight& light) {
  const auto found = samples_.find(light.shape());
  if (found != samples_.end()) return found->second;
  return samples_.emplace(light.shape(), make_light_samples(light, settings_)).first->second;
}

TraceSettings CachedTracer::within(double standard_error) const {
  TraceSettings settings = settings_;
  settings.standard_error = standard_error;
  return settings;
}

Layers CachedTracer::find_or_trace(const ReceiverImage& receivers, const std::string& what, std::size_t count,
                                   const std::function<Layers()>& trace) {
  if (receivers.content.empty()) return trace();
  ContentHash hash;
  for (const std::string& part :
       {geometry(), receivers.content, what,
        fmt::format("{} {} {}", settings_.standard_error, settings_.max_points, settings_.seed)})
    hash.add(part);
  const std::string name = hash.name();
  if (auto kept = cache_.load(name, count, receivers.points.size())) return std::move(*kept);
  Layers layers = trace();
  cache_.store(name, layers);
  return layers;
}

ViewRays CachedTracer::trace_view(const ReceiverImage& receivers, const AreaLight& light) {
  Layers layers = find_or_trace(receivers, name_light(light), kViewLayers, [&] {
    const TracedVisibility area = trace_area(occluders(), receivers, light, settings_, samples(light));
    Layers traced = to_layers(area);
    traced.push_back(area.ratio);
    traced.push_back(area.ratio_error);
    traced.push_back(trace_hard(occluders(), receivers, light, settings_.stop));
    traced.push_back(trace_first_blockers(occluders(), receivers, light, settings_.stop));
    return traced;
  });
  std::vector<float> hard = std::move(layers[kViewLayers - 2]), blockers = std::move(layers[kViewLayers - 1]);
  TracedVisibility area = from_layers(layers);
  area.ratio = std::move(layers[kTracedLayers]);
  area.ratio_error = std::move(layers[kTracedLayers + 1]);
  return {std::move(area), std::move(hard), std::move(blockers)};
}

std::vector<float> CachedTracer::trace_light(const ReceiverImage& receivers, const AreaLight& light) {
  TraceSettings few = settings_;
  few.max_points = kFirstPoints;
  const auto trace = [&] { return Layers{trace_area(occluders(), receivers, light, few).ratio}; };
  return find_or_trace(receivers, name_light(light) + " by few rays", 1, trace).front();
}

TracedVisibility CachedTracer::find_or_trace(const ReceiverImage& receivers, const std::string& what,
                                             const std::function<TracedVisibility()>& trace) {
  return from_layers(find_or_trace(
      receivers, what, kTracedLayers, [&] { return to_layers(trace()); }));
}

TracedVisibility CachedTracer::trace_kernel(const ReceiverImage& receivers, const filters::Kernel& kernel,
                                            const MapGrid& grid) {
  return find_or_trace(
      receivers, fmt::format("kernel {} {} within {}", kernel.name(), name_grid(grid), kKernelStandardError),
      [&] { return truth::trace_kernel(occluders(), receivers, kernel, grid, within(kKernelStandardError)); });
}

TracedVisibility CachedTracer::trace_disks(const ReceiverImage& receivers, std::span<const float> radii_texels,
                                           const MapGrid& grid) {
  ContentHash radii;
  radii.add_values(radii_texels);
  return find_or_trace(
      receivers, fmt::format("disks {} {} within {}", radii.name(), name_grid(grid), kKernelStandardError),
      [&] { return truth::trace_disks(occluders(), receivers, radii_texels, grid, within(kKernelStandardError)); });
}

TracedVisibility CachedTracer::trace_surroundings(const ReceiverImage& receivers, double half_width_texels,
                                                  const MapGrid& grid) {
  return find_or_trace(
      receivers, fmt::format("square {} {}", half_width_texels, name_grid(grid)),
      [&] {
        TraceSettings rough = within(1.0);
        rough.max_points = kFirstPoints;
        return trace_square(occluders(), receivers, half_width_texels, grid, rough);
      });
}

}  // namespace shadowbench::truth
