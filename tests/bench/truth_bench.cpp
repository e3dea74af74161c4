// What truth costs: rays per second beside a bare Embree loop, and whole views with and without the cache.

#include <benchmark/benchmark.h>
#include <tbb/concurrent_vector.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numeric>
#include <vector>

#include "harness/gl/context/context.h"
#include "harness/measure/view_receivers.h"
#include "harness/options/options.h"
#include "harness/render/gbuffer.h"
#include "harness/render/shader_library.h"
#include "harness/scene/load.h"
#include "harness/scene/scene.h"
#include "reference/truth/cached_tracer.h"
#include "reference/truth/embree.h"

namespace shadowbench::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// The median of some values, of an even number the upper one. Requires one or more.
double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + std::ssize(values) / 2);
  return values[values.size() / 2];
}

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// A built-in scene with the receivers that its camera sees.
struct View {
  View(const std::string& name, int width, int height)
      : scene(scene::load(name, {.scenes_folder = options::find_resources().scenes})) {
    static gl::ContextChoice choice = gl::create_context(gl::Backend::kAuto);
    render::ShaderLibrary shaders(options::find_resources().shaders);
    const render::Geometry geometry(scene);
    render::GBuffer gbuffer(width, height);
    gbuffer.draw(shaders, geometry, scene, scene.cameras.front());
    receivers = measure::read_view_receivers(gbuffer, scene.light);
  }

  scene::Scene scene;
  measure::ViewReceivers receivers;
};

/// An Embree scene without anything of ours around it.
class BareEmbree {
 public:
  explicit BareEmbree(const scene::Scene& scene) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    for (const scene::Mesh& mesh : scene.meshes) add(mesh);
    rtcCommitScene(scene_);
  }
  ~BareEmbree() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareEmbree(const BareEmbree&) = delete;
  BareEmbree& operator=(const BareEmbree&) = delete;

  /// Traces packets that lie ready, and resets what Embree overwrites.
  void trace(std::vector<RTCRay16>& packets, const std::vector<std::array<int, 16>>& valid) const {
    tbb::parallel_for(
        std::size_t{0}, packets.size(), std::size_t{64},
        [&](std::size_t begin) {
          for (std::size_t i = begin; i < std::min(begin + std::size_t{64}, packets.size()); ++i) {
            alignas(64) std::array<int, 16> active = valid[i];
            truth::occlude_packet(active.data(), scene_, &packets[i]);
            std::fill(std::begin(packets[i].tfar), std::end(packets[i].tfar), std::numeric_limits<float>::infinity());
          }
        });
  }

 private:
  RTCDevice device_ = rtcNewDevice(nullptr);
  RTCScene scene_ = rtcNewScene(device_);

  void add(const scene::Mesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.vertices.size()));
    for (const scene::Vertex& vertex : mesh.vertices) *vertices++ = vertex.position_ws;
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.indices.size() / 3));
    std::copy(mesh.indices.begin(), mesh.indices.end(), corners);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }
};

/// Packets as they are traced.
struct Recording {
  std::vector<RTCRay16> packets;
  std::vector<std::array<int, 16>> valid;
  double rays = 0.0;

  void add(const truth::RayPacket& packet) {
    std::memcpy(&packets.emplace_back(), &packet, sizeof(RTCRay16));
    valid.push_back(packet.active);
    rays -= std::accumulate(packet.active.begin(), packet.active.end(), 0);
  }
};

/// The same rays, traced by the truth and by a bare loop in turns: few enough of them to stay near the cores.
void occlusion_rays(benchmark::State& state, const char* scene) {
  const View view(scene, 160, 90);
  const truth::Occluders occluders(scene::list_occluders(view.scene));
  const BareEmbree bare(view.scene);
  const auto light = scene::make_area_light(view.scene.light);
  truth::TraceSettings settings;
  settings.standard_error = 1.0;
  settings.max_points = 16;
  tbb::concurrent_vector<truth::RayPacket> packets;
  settings.on_packet = [&](const truth::RayPacket& packet) { packets.push_back(packet); };
  truth::trace_area(occluders, view.receivers.image, light, settings);
  settings.on_packet = {};
  Recording recording;
  for (const truth::RayPacket& packet : packets) recording.add(packet);
  std::vector<double> ours, theirs, ratios;
  for (auto _ : state) {
    for (int round = 0; round < 41; ++round) {
      const auto first = Clock::now();
      benchmark::DoNotOptimize(truth::trace_area(occluders, view.receivers.image, light, settings));
      ours.push_back(recording.rays / seconds_since(first));
      const auto second = Clock::now();
      bare.trace(recording.packets, recording.valid);
      theirs.push_back(recording.rays / seconds_since(second));
      ratios.push_back(ours.back() / theirs.back());
    }
  }
  state.counters["rays_per_s"] = median(ours);
  state.counters["bare_rays_per_s"] = median(theirs);
  state.counters["ratio"] = median(ratios);
}
BENCHMARK_CAPTURE(occlusion_rays, cubes, "cubes")->Iterations(1);
BENCHMARK_CAPTURE(occlusion_rays, stack, "stack")->Iterations(1);
BENCHMARK_CAPTURE(occlusion_rays, fence, "fence")->Iterations(1);
BENCHMARK_CAPTURE(occlusion_rays, ball, "ball")->Iterations(1);
BENCHMARK_CAPTURE(occlusion_rays, steps, "steps")->Iterations(1);

void trace_view(const View& view, truth::TruthCache& cache) {
  truth::CachedTracer tracer([&] { return scene::list_occluders(view.scene); }, cache, 1);
  tracer.trace_view(view.receivers.image, scene::make_area_light(view.scene.light));
}

/// All that does not depend on the map, 960 x 540, standard error 0.005: traced, then read back.
void area_truth(benchmark::State& state, const char* scene) {
  const auto folder = std::filesystem::temp_directory_path() / ("shadowbench_truth_bench." + std::to_string(getpid()));
  const View view(scene, 960, 540);
  for (auto _ : state) {
    truth::TruthCache cache(folder, [](const std::string&) {});
    const auto cold = Clock::now();
    trace_view(view, cache);
    state.counters["cold_s"] = seconds_since(cold);
    const auto warm = Clock::now();
    trace_view(view, cache);
    state.counters["warm_s"] = seconds_since(warm);
    if (cache.loaded() != 1) state.SkipWithError("the cache did not hold the view");
  }
  std::filesystem::remove_all(folder);
}
BENCHMARK_CAPTURE(area_truth, cubes, "cubes")->Iterations(1);
BENCHMARK_CAPTURE(area_truth, stack, "stack")->Iterations(1);
BENCHMARK_CAPTURE(area_truth, fence, "fence")->Iterations(1);
BENCHMARK_CAPTURE(area_truth, ball, "ball")->Iterations(1);
BENCHMARK_CAPTURE(area_truth, steps, "steps")->Iterations(1);

}  // namespace
}  // namespace shadowbench::bench
