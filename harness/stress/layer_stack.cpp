#include "harness/stress/layer_stack.h"

#include <algorithm>
#include <cmath>

#include "filters/kernel.h"

namespace shadowbench::stress {
namespace {

constexpr int kStackReceivers = 16;  // in a row: each has other shares

/// Which occluder a texel holds. Neighbours along a row differ by one, along a column by about the root of their count:
/// small kernels hold as many as they can.
std::size_t choose_layer(int x, int y, std::size_t count) {
  const int step = count == 2 ? 1 : static_cast<int>(std::lround(std::sqrt(static_cast<double>(count))));
  return static_cast<std::size_t>(x + step * y) % count;
}

/// The weights of texels `first` .. on one axis.
struct Span {
  int first = 0;
  std::vector<double> weights;
};

Span make_span(int radius, int texel) {
  if (radius == 0) return {texel, {0.5, 0.5}};
  Span span{texel - radius, {}};
  double sum = 0.0;
  for (const float weight : filters::gaussian_weights(radius)) sum += static_cast<double>(weight);
  for (const float weight : filters::gaussian_weights(radius))
    span.weights.push_back(static_cast<double>(weight) / sum);
  return span;
}

std::vector<double> find_shares(const Span& x, const Span& y, std::size_t count) {
  std::vector<double> shares(count, 0.0);
  for (std::size_t j = 0; j < y.weights.size(); ++j) {
    for (std::size_t i = 0; i < x.weights.size(); ++i) {
      shares[choose_layer(x.first + static_cast<int>(i), y.first + static_cast<int>(j), count)] +=
          x.weights[i] * y.weights[j];
    }
  }
  return shares;
}

}  // namespace

LayerStack make_layer_stack(int count, double first_gap, double gap_ratio, double receiver) {
  LayerStack stack{{}, receiver};
  const double last = receiver - gap_ratio * first_gap;
  for (int i = 0; i < count; ++i) stack.depths.push_back(last - first_gap * (count - 1 - i) / (count - 1));
  return stack;
}

LayerScene make_layer_scene(int radius_texels, const LayerStack& stack) {
  LayerScene layers;
  SyntheticScene& scene = layers.scene;
  scene.size = std::max(64, 2 * radius_texels + kStackReceivers + 2);
  for (int y = 0; y < scene.size; ++y)
    for (int x = 0; x < scene.size; ++x)
      scene.depths.push_back(static_cast<float>(stack.depths[choose_layer(x, y, stack.depths.size())]));
  const float between = radius_texels == 0 ? 0.5f / static_cast<float>(scene.size) : 0.0f;
  const int row = scene.size / 2, first = (scene.size - kStackReceivers) / 2;
  for (int x = first; x < first + kStackReceivers; ++x) {
    scene.receivers.push_back({scene.uv(x) + between, scene.uv(row) + between, static_cast<float>(stack.receiver)});
    layers.shares.push_back(
        find_shares(make_span(radius_texels, x), make_span(radius_texels, row), stack.depths.size()));
  }
  return layers;
}

double find_chebyshev(const LayerStack& stack, const std::vector<double>& shares) {
  double mean = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) mean += shares[i] * stack.depths[i];
  for (std::size_t i = 0; i < shares.size(); ++i)
    variance += shares[i] * (stack.depths[i] - mean) * (stack.depths[i] - mean);
  const double distance = stack.receiver - mean;
  return variance / (variance + distance * distance);
}

double find_exponential(const LayerStack& stack, const std::vector<double>& shares, double c) {
  double sum = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i) sum += shares[i] * std::exp(-c * (stack.receiver - stack.depths[i]));
  return sum;
}

}  // namespace shadowbench::stress
