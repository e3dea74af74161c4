#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "filters/base/error.h"
#include "harness/stress/probe.h"
#include "report/records/text_table.h"

namespace shadowbench::stress {
namespace map_size {

constexpr double kBound = 0.02;  // of visibility: five steps of an 8-bit picture
constexpr int kReceivers = 65;
constexpr int kLargestModelled = 256;  // texels per side; what lies beyond is told by construction
constexpr float kOccluder = 0.3f, kReceiver = 0.6f;
constexpr double kSpareMemory = 1.5;  // of the map's bytes: drivers keep some beside it

/// Occluders on the left half, the receivers' own surface on the right one; a map of one texel holds an occluder.
ProbeScene make_halves(int size) {
  ProbeScene scene;
  scene.size = size;
  scene.depths.resize(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (std::size_t i = 0; i < scene.depths.size(); ++i) {
    const auto x = static_cast<int>(i % static_cast<std::size_t>(size));
    scene.depths[i] = 2 * x < size ? kOccluder : kReceiver;
  }
  for (int i = 0; i < kReceivers; ++i) {
    // Not on borders between texels, where rounding decides which of them is read.
    scene.receivers.emplace_back((static_cast<float>(i) + 0.377f) / static_cast<float>(kReceivers), 0.4931f, kReceiver);
  }
  return scene;
}

/// Keeps the receivers from which neither the edge in the middle nor the border is within reach, and tells what they
/// see.
std::vector<double> keep_clear(ProbeScene& scene, double reach_texels) {
  std::vector<glm::vec3> kept;
  std::vector<double> expected;
  for (const glm::vec3& receiver : scene.receivers) {
    const double x = static_cast<double>(receiver.x) * scene.size, edge = (scene.size + 1) / 2;
    if (std::min({x, scene.size - x, std::abs(x - edge)}) <= reach_texels) continue;
    kept.push_back(receiver);
    expected.push_back(x < edge ? 0.0 : 1.0);
  }
  scene.receivers = std::move(kept);
  return expected;
}

/// The probe is made for each size and given up again, and with it the map.
Observation observe(const StressContext& context, const filters::FilterRequest& request, int size) {
  ProbeScene scene = make_halves(size);
  const double reach = filters::radius_texels(request.spec, request.values) + 1.0;
  const bool modelled = size <= kLargestModelled && filters::make_model(request.spec.id) != nullptr;
  const std::vector<double> expected =
      modelled ? make_model_probe(context, request, filters::Precision::kDouble)->look(scene, request.values).visibility
               : keep_clear(scene, reach);
  if (scene.receivers.empty()) return {};  // without a model, a map that is smaller than the kernel tells nothing
  return judge(make_gl_probe(context, request)->look(scene, request.values), {expected, kBound, 0});
}

Case make_case(const StressContext& context, const filters::FilterRequest& request) {
  constexpr const char* kVariant = "half of the map dark";
  if (!context.renderer) return make_absent_case(request.spec.id, kVariant, Level::kGl, "there is no GL");
  Case item = start_case(request, kVariant, Level::kGl);
  item.theories = {
      {std::nullopt, TheoryKind::kQuantum, "none: a map of one texel is a map", "by definition", Verdict::kDegraded}};
  item.observe = [&context, request](double size) { return observe(context, request, static_cast<int>(size)); };
  return item;
}

std::vector<Case> make_cases(const StressContext& context) {
  std::vector<Case> cases;
  for (const filters::FilterRequest& request : context.filters) cases.push_back(make_case(context, request));
  return cases;
}

/// MemAvailable of Linux; empty elsewhere.
std::optional<double> find_available_bytes() {
  std::ifstream file("/proc/meminfo");
  std::string name;
  double kibibytes = 0.0;
  for (std::string rest; file >> name >> kibibytes; std::getline(file, rest))
    if (name == "MemAvailable:") return kibibytes * 1024.0;
  return std::nullopt;
}

std::string mebibytes(double bytes) { return fmt::format("{:.0f} MiB", bytes / (1 << 20)); }

/// A map that one occluder was drawn into; two receivers, one behind it, one beside it.
std::string look_once(const StressContext& context, int size) {
  const filters::Catalogue catalogue(context.resources.filters);
  render::ShadowMap map(size);
  scene::Scene square;
  square.materials.emplace_back();
  scene::Mesh mesh;
  for (const auto& [x, y] : {std::pair(-0.5f, -0.5f), std::pair(-0.25f, -0.5f), std::pair(-0.5f, -0.25f)})
    mesh.vertices.push_back({{x, y, kOccluder}, {}, {}});
  mesh.indices = {0, 1, 2};
  square.meshes = {mesh};
  scene::LightFrustum frustum;  // clip space is the world
  frustum.width_ws = 2.0;
  frustum.texel_size_ws = 2.0 / size;
  frustum.depth_range_ws = 1.0;
  frustum.uv_depth_from_world = {
      {0.5f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.5f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f, 0.0f}, {0.5f, 0.5f, 0.0f, 1.0f}};
  render::ShaderLibrary& shaders = context.renderer->shaders;
  map.draw(shaders, render::Geometry(square), frustum);
  render::GBuffer gbuffer(2, 1);
  gbuffer.upload(std::vector{-0.45f, -0.45f, kReceiver, 1.0f, 0.5f, 0.5f, kReceiver, 1.0f},
                 std::vector{0.0f, 0.0f, -1.0f, 0.0f, 0.0f, 0.0f, -1.0f, 0.0f});
  render::ImageTarget target("lookup at the limit", GL_R32F, 2, 1);
  render::FilterPasses(shaders, catalogue.parse_requests("none").front(), map, {frustum, 0.0, {}, context.seed, {}})
      .lookup(gbuffer, map, target);
  const std::vector<float> seen = target.texture().read_floats(1);
  return seen[0] == 0.0f && seen[1] == 1.0f
             ? "ok: dark behind an occluder, lit beside it"
             : fmt::format("wrong: {} behind an occluder, {} beside it", seen[0], seen[1]);
}

std::string try_size(const StressContext& context, int size, int limit) {
  const double bytes = 4.0 * size * size;
  const std::optional<double> available = find_available_bytes();
  if (size <= limit && available && *available < kSpareMemory * bytes) {
    return fmt::format("not available: it needs {} with what drivers keep beside it, and {} of memory are free",
                       mebibytes(kSpareMemory * bytes), mebibytes(*available));
  }
  try {
    return look_once(context, size);
  } catch (const Error& error) {
    return fmt::format("refused: {}", error.what());
  }
}

std::vector<Exhibit> make_exhibits(const StressContext& context) {
  if (!context.renderer) return {};
  const int limit = context.renderer->context->info().max_texture_size;
  Exhibit exhibit;
  exhibit.id = "limit";
  exhibit.title = "At this GL's limit";
  exhibit.sentences = {
      fmt::format("This GL gives textures of up to {} texels per side. One map of that size is allocated, drawn and "
                  "looked up once, where memory allows; what is larger is an "
                  "error before anything is allocated.",
                  limit)};
  exhibit.table = records::TextTable{{"map", "bytes of depth", "one allocation and one lookup, filter none"}, {}};
  for (const int size : {limit, limit + 1, 2 * limit})
    exhibit.table->rows.push_back(
        {fmt::format("{}", size), mebibytes(4.0 * size * size), try_size(context, size, limit)});
  return {exhibit};
}

}  // namespace map_size

Axis make_map_size_axis() {
  using namespace map_size;
  Axis axis;
  axis.title = "Size of the map: against the model in double up to 256 texels, then by construction";
  axis.quantity = "texels per side";
  axis.range = {1.0, 4096.0};
  axis.limits = {1.0, 8192.0};
  axis.coarse_samples = 25;
  axis.whole = true;
  axis.measured = "largest error of visibility";
  axis.bound = kBound;
  axis.broken_when =
      "texels of the map overflowed, or visibility is not finite, all lit or all dark where it must not be";
  axis.make_cases = make_cases;
  axis.make_exhibits = make_exhibits;
  return axis;
}

}  // namespace shadowbench::stress
