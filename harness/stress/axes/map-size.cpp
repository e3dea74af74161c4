#include <algorithm>
#include <cmath>

#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace map_size {

constexpr int kReceivers = 65;
constexpr int kLargestModelled = 256;  // texels per side; of larger maps, no model is made
constexpr float kOccluder = 0.3f, kReceiver = 0.6f;

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
Observation observe(const AxisInputs& inputs, const filters::FilterRequest& request, int size) {
  SyntheticScene scene = make_halves(size);
  const std::vector<double> expected =
      size <= kLargestModelled
          ? make_model_lookup(inputs, request, expected_precision(request.spec))(scene, request.values).visibility
          : keep_clear(scene, inputs, request);
  if (scene.receivers.empty()) return {};  // the kernel meets the edge or the border everywhere
  return judge(make_gl_lookup(inputs, request)(scene, request.values), {expected, kVisibleError, 0});
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request) {
  Case item = start_case(inputs, request, "half of the map dark", Level::kGl);
  if (!item.is_available()) return item;
  item.theories = {
      {std::nullopt, TheoryKind::kQuantum, "none: a map of one texel is a map", "by definition", Verdict::kDegraded}};
  item.observe = [&inputs, request](double size) { return observe(inputs, request, static_cast<int>(size)); };
  return item;
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  std::vector<Case> cases;
  for (const filters::FilterRequest& request : inputs.filters) cases.push_back(make_case(inputs, request));
  return cases;
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
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
