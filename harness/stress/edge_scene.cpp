#include "harness/stress/edge_scene.h"

#include <algorithm>
#include <cmath>

#include "filters/gaussian.h"

namespace shadowbench::stress {
namespace {

constexpr int kBetweenTexels = 7;  // receivers between the two texel centres at an edge, where there is no prefilter

/// A receiver's place across an edge.
struct Place {
  double texels;  ///< from the map's left side
  double lit_share;
};

std::vector<Place> place_across(int radius, int edge) {
  std::vector<Place> places;
  for (int i = 1; radius == 0 && i <= kBetweenTexels; ++i) {
    const double share = static_cast<double>(i) / (kBetweenTexels + 1);
    places.push_back({edge - 0.5 + share, share});
  }
  if (radius == 0) return places;
  const std::vector<float> weights = filters::gaussian_weights(radius);
  double sum = 0.0, lit = 0.0;
  for (const float weight : weights) sum += static_cast<double>(weight);
  // The kernel's right end moves over the edge, texel by texel.
  for (int i = 0; i < 2 * radius; ++i) {
    lit += static_cast<double>(weights[static_cast<std::size_t>(2 * radius - i)]);
    places.push_back({edge - radius + i + 0.5, lit / sum});
  }
  return places;
}

}  // namespace

EdgeScene make_edge_scene(int radius_texels, const std::vector<EdgeDepths>& bands, int least_size) {
  const int count = static_cast<int>(bands.size());
  const int height = 2 * radius_texels + 2;  // of a band, so that no kernel leaves it
  EdgeScene edge;
  edge.scene.size = std::max({least_size, count * height, 4 * radius_texels + 4});
  const auto places = place_across(radius_texels, edge.scene.size / 2);
  edge.run = places.size();
  for (int b = 0; b < count; ++b) {
    const int middle = edge.scene.size * (2 * b + 1) / (2 * count);
    for (const Place& place : places) {
      edge.scene.receivers.push_back({static_cast<float>(place.texels / edge.scene.size), edge.scene.uv(middle), 0.0f});
      edge.lit_share.push_back(place.lit_share);
      edge.band.push_back(static_cast<std::size_t>(b));
    }
  }
  set_depths(edge, bands);
  return edge;
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
