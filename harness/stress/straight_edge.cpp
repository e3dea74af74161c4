#include "harness/stress/straight_edge.h"

#include <algorithm>

#include "filters/percentage_closer.h"

namespace shadowbench::stress {
namespace {

constexpr int kEdgeSize = 2 * kWidestRadius + 4;  // a texel to spare: no rounding of a place reaches the border
constexpr int kEdgeReceivers = 37;                // no divisor of the steps: none falls on a texel's border
constexpr float kOccluder = 0.3f, kSurface = 0.6f;

}  // namespace

SyntheticScene make_straight_edge(double radius_texels) {
  SyntheticScene scene;
  scene.size = kEdgeSize;
  scene.depths = make_split_depths(kEdgeSize, kOccluder, kSurface);
  const double reach = 0.5 + std::min(kWidestRadius - radius_texels, radius_texels + 2.0);
  for (int i = 0; i < kEdgeReceivers; ++i) {
    const double texels = kEdgeSize / 2 + reach * (2.0 * (i + 0.5) / kEdgeReceivers - 1.0);
    scene.receivers.push_back({static_cast<float>(texels / kEdgeSize), scene.uv(kEdgeSize / 2), kSurface});
  }
  return scene;
}

std::vector<double> compare_whole_kernel(const SyntheticScene& scene, const filters::Kernel& kernel) {
  const filters::DepthMap map{scene.size, scene.depths};
  const filters::PercentageCloser closer(kernel, map);
  std::vector<double> visibility;
  for (const glm::vec3& place : scene.receivers) {
    filters::Receiver receiver;
    receiver.uv = {place.x, place.y};
    receiver.depth = receiver.depth_unbiased = place.z;
    visibility.push_back(closer.at(receiver));
  }
  return visibility;
}

Observation judge_edge(const LookupResult& seen, std::vector<double> expected, double bound, filters::FilterKind kind) {
  const bool rises = kind == filters::FilterKind::kComparison || kind == filters::FilterKind::kBound;
  return judge(seen, {std::move(expected), bound, rises ? seen.visibility.size() : 0});
}

}  // namespace shadowbench::stress
