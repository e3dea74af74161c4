#include "harness/stress/edge_scene.h"

#include <algorithm>
#include <cmath>

#include "filters/kernel.h"
#include "filters/percentage_closer.h"

namespace shadowbench::stress {
namespace {

constexpr int kEdgeSize = 2 * kWidestRadius + 4;  // a texel to spare: no rounding of a place reaches the border
constexpr int kEdgeReceivers = 37;                // no divisor of the steps: none falls on a texel's border
constexpr float kOccluder = 0.3f, kSurface = 0.6f;
constexpr int kBetweenTexels = 7;     // receivers between the two texel centres at an edge, where there is no prefilter
constexpr double kNearlyNone = 1e-6;  // of a kernel: so much is lost where its weights are added
constexpr int kAcrossKernel = 31;     // receivers across an edge and a kernel: none falls on a texel's border

/// A receiver's place across an edge.
struct EdgeOffset {
  double texels;  ///< from the edge
  double lit_share;
};

std::vector<EdgeOffset> place_across(int radius) {
  std::vector<EdgeOffset> places;
  for (int i = 1; radius == 0 && i <= kBetweenTexels; ++i) {
    const double share = static_cast<double>(i) / (kBetweenTexels + 1);
    places.push_back({share - 0.5, share});
  }
  if (radius == 0) return places;
  const std::vector<float> weights = filters::gaussian_weights(radius);
  double sum = 0.0, lit = 0.0;
  for (const float weight : weights) sum += static_cast<double>(weight);
  // The kernel's right end moves over the edge, texel by texel.
  for (int i = 0; i < 2 * radius; ++i) {
    lit += static_cast<double>(weights[static_cast<std::size_t>(2 * radius - i)]);
    places.push_back({i - radius + 0.5, lit / sum});
  }
  return places;
}

/// The share of the kernel's texels that lie right of the edge, every texel compared.
std::vector<EdgeOffset> place_across(const filters::Kernel& kernel) {
  const double reach = kernel.half_width();
  const int middle = 2 * static_cast<int>(std::ceil(reach)) + 1;  // the farthest kernel stays inside
  SyntheticScene scene{2 * middle, make_split_depths(2 * middle, 0.0f, 1.0f), {}};
  std::vector<double> offsets;
  for (int i = 0; i < kAcrossKernel; ++i) {
    offsets.push_back(reach * (2.0 * (i + 0.5) / kAcrossKernel - 1.0));
    scene.receivers.push_back({static_cast<float>((middle + offsets.back()) / scene.size), scene.uv(middle), 0.5f});
  }
  const std::vector<double> shares = compare_whole_kernel(scene, kernel);
  std::vector<EdgeOffset> places;
  for (std::size_t i = 0; i < shares.size(); ++i)
    if (shares[i] > kNearlyNone && shares[i] < 1.0 - kNearlyNone) places.push_back({offsets[i], shares[i]});
  return places;
}

EdgeScene make_bands_of_edges(const std::vector<EdgeOffset>& places, int reach_texels,
                              const std::vector<EdgeDepths>& bands, int least_size) {
  const int count = static_cast<int>(bands.size());
  const int height = 2 * reach_texels + 2;  // of a band, so that no kernel leaves it
  EdgeScene edge;
  edge.scene.size = std::max({least_size, count * height, 4 * reach_texels + 4});
  edge.run = places.size();
  for (int b = 0; b < count; ++b) {
    const int middle = edge.scene.size * (2 * b + 1) / (2 * count);
    for (const EdgeOffset& place : places) {
      const double x = (edge.scene.size / 2 + place.texels) / edge.scene.size;
      edge.scene.receivers.push_back({static_cast<float>(x), edge.scene.uv(middle), 0.0f});
      edge.lit_share.push_back(place.lit_share);
      edge.band.push_back(static_cast<std::size_t>(b));
    }
  }
  set_depths(edge, bands);
  return edge;
}

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

Observation judge_edge(const LookupResult& seen, std::vector<double> expected, filters::FilterKind kind) {
  const bool rises = kind == filters::FilterKind::kComparison || kind == filters::FilterKind::kBound;
  return judge(seen, {std::move(expected), kVisibleError, rises ? seen.visibility.size() : 0});
}

EdgeScene make_edge_scene(int radius_texels, const std::vector<EdgeDepths>& bands, int least_size) {
  return make_bands_of_edges(place_across(radius_texels), radius_texels, bands, least_size);
}

EdgeScene make_edge_scene(const filters::Kernel& kernel, const std::vector<EdgeDepths>& bands) {
  return make_bands_of_edges(place_across(kernel), static_cast<int>(std::ceil(kernel.half_width())), bands, 0);
}

void set_depths(EdgeScene& edge, const std::vector<EdgeDepths>& bands) {
  const auto size = static_cast<std::size_t>(edge.scene.size);
  edge.scene.depths.resize(size * size);
  for (std::size_t y = 0; y < size; ++y) {
    const EdgeDepths& band = bands[y * bands.size() / size];
    for (std::size_t x = 0; x < size; ++x)
      edge.scene.depths[y * size + x] = x < size / 2 ? band.occluder : band.receiver;
  }
  for (std::size_t i = 0; i < edge.band.size(); ++i) edge.scene.receivers[i].z = bands[edge.band[i]].receiver;
}

}  // namespace shadowbench::stress
