#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>

#include "base/error.h"
#include "harness/stress/synthetic_scene.h"
#include "report/records/text_table.h"

namespace shadowbench::stress {
namespace map_size {

constexpr int kReceivers = 65;
constexpr int kLargestModelled = 256;  // texels per side; of larger maps, no model is made
constexpr float kOccluder = 0.3f, kReceiver = 0.6f;
constexpr double kSpareMemory = 1.5;  // of the map's bytes: drivers keep some beside it

/// Occluders stand on the left half, the receivers' own surface on the right one; a map of one texel holds an occluder.
SyntheticScene make_halves(int size) {
  SyntheticScene scene{size, make_split_depths(size, kOccluder, kReceiver), {}};
  for (int i = 0; i < kReceivers; ++i) {
    // Not on borders between texels, where rounding decides which of them is read.
    scene.receivers.emplace_back((static_cast<float>(i) + 0.377f) / static_cast<float>(kReceivers), 0.4931f, kReceiver);
  }
  return scene;
}

/// Keeps the receivers whose kernel meets neither the edge in the middle nor the border, and gives their visibility: a
/// comparison is dark or lit. What other filters are is what their formula makes of the two depths: a truncated series
/// of waves, for instance, leaves light behind an occluder.
std::vector<double> keep_clear(SyntheticScene& scene, const AxisInputs& inputs, const filters::FilterRequest& request) {
  const double reach_texels = filters::radius_texels(request.spec, request.values) + 1.0,
               dark = look_at_one_depth(inputs, request, kOccluder, kReceiver),
               lit = look_at_one_depth(inputs, request, kReceiver, kReceiver);
  std::vector<glm::vec3> kept;
  std::vector<double> expected;
  for (const glm::vec3& receiver : scene.receivers) {
    const double x = static_cast<double>(receiver.x) * scene.size, edge = (scene.size + 1) / 2;
    if (std::min({x, scene.size - x, std::abs(x - edge)}) <= reach_texels) continue;
    kept.push_back(receiver);
    expected.push_back(x < edge ? dark : lit);
  }
  scene.receivers = std::move(kept);
  return expected;
}

/// The lookup is made for each size and given up again, and with it the map.
Observation observe(const AxisInputs& inputs, const filters::FilterRequest& request, int size, double& lost) {
  SyntheticScene scene = make_halves(size);
  const filters::Precision precision = expected_precision(request.spec);
  const auto see = [&](filters::Precision of) {
    return make_model_lookup(inputs, request, of)(scene, request.values).visibility;
  };
  const std::vector<double> expected = size <= kLargestModelled ? see(precision) : keep_clear(scene, inputs, request);
  if (size <= kLargestModelled && precision != filters::Precision::kDouble)
    lost = std::max(lost, find_largest_error(expected, see(filters::Precision::kDouble)));
  if (scene.receivers.empty()) return {};  // the kernel meets the edge or the border everywhere
  return judge(make_gl_lookup(inputs, request)(scene, request.values), {expected, kVisibleError, 0});
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request) {
  Case item = start_case(inputs, request, "half of the map dark", Level::kGl);
  if (!item.is_available()) return item;
  item.theories = {
      {std::nullopt, TheoryKind::kQuantum, "none: a map of one texel is a map", "by definition", Verdict::kDegraded}};
  const auto lost = std::make_shared<double>(0.0);  // by what the filter packs
  item.observe = [&inputs, request, lost](double size) {
    return observe(inputs, request, static_cast<int>(size), *lost);
  };
  item.remark = [lost](const records::StressCase&) {
    return *lost <= kVisibleError
               ? std::vector<std::string>()
               : std::vector{fmt::format("what the filter packs is off from exact arithmetic by up to {:.2g}, as its "
                                         "scalar model packs it; the map's size adds nothing to that",
                                         *lost)};
  };
  return item;
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

/// Draws one occluder into a map and looks two receivers up, one behind it, one beside it.
std::string look_once(const AxisInputs& inputs, int size) {
  const filters::Catalogue catalogue(inputs.resources.filters);
  scene::Scene square;
  square.materials.emplace_back();
  scene::Mesh mesh;
  for (const auto& [x, y] : {std::pair(-0.5f, -0.5f), std::pair(-0.25f, -0.5f), std::pair(-0.5f, -0.25f)})
    mesh.vertices.push_back({{x, y, kOccluder}, {}, {}});
  mesh.indices = {0, 1, 2};
  square.meshes = {mesh};
  scene::LightFrustum frustum = make_axis_frustum(2.0, size);  // clip space is the world
  frustum.uv_depth_from_world = {
      {0.5f, 0.0f, 0.0f, 0.0f}, {0.0f, 0.5f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f, 0.0f}, {0.5f, 0.5f, 0.0f, 1.0f}};
  FilterBench bench(inputs, catalogue.parse_requests("none").front());
  bench.resize({size, 2});
  bench.map().draw(bench.shaders(), render::Geometry(square), frustum);
  bench.upload_receivers({{-0.45f, -0.45f, kReceiver}, {0.5f, 0.5f, kReceiver}}, {0.0f, 0.0f, -1.0f});
  const std::vector<float> seen = bench.look_up({frustum, 0.0, {}, inputs.seed, {}}, bench.request().values);
  return seen[0] == 0.0f && seen[1] == 1.0f
             ? "ok: dark behind an occluder, lit beside it"
             : fmt::format("wrong: {} behind an occluder, {} beside it", seen[0], seen[1]);
}

std::string try_size(const AxisInputs& inputs, int size, int limit) {
  const double bytes = 4.0 * size * size;
  const std::optional<double> available = find_available_bytes();
  if (size <= limit && available && *available < kSpareMemory * bytes) {
    return fmt::format("not available: it needs {} with what drivers keep beside it, and {} of memory are free",
                       mebibytes(kSpareMemory * bytes), mebibytes(*available));
  }
  try {
    return look_once(inputs, size);
  } catch (const Error& error) {
    return fmt::format("refused: {}", error.what());
  }
}

std::vector<Exhibit> make_exhibits(const AxisInputs& inputs) {
  const int limit = inputs.renderer->context->info().max_texture_size;
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
        {fmt::format("{}", size), mebibytes(4.0 * size * size), try_size(inputs, size, limit)});
  return {exhibit};
}

}  // namespace map_size

Axis make_map_size_axis() {
  using namespace map_size;
  Axis axis;
  axis.title = "Size of the map: against the scalar model up to 256 texels, then against the model of one depth";
  axis.quantity = "texels per side";
  axis.range = {1.0, 4096.0};
  axis.limits = {1.0, 8192.0};
  axis.coarse_samples = 25;
  axis.whole = true;
  axis.measured = "largest error of visibility";
  axis.bound = kVisibleError;
  axis.broken_when =
      "texels of the map overflowed, or visibility is not finite, all lit or all dark where it must not be";
  axis.make_cases = [](const AxisInputs& inputs) { return make_gl_cases(inputs, make_case); };
  axis.make_exhibits = make_exhibits;
  return axis;
}

}  // namespace shadowbench::stress
