#include "harness/measure/layer_truth.h"

#include <algorithm>
#include <cmath>

#include "base/bytes.h"

namespace shadowbench::measure {
namespace {

/// The receivers that a layer serves.
truth::ReceiverImage keep_served(truth::ReceiverImage receivers, const TracedLayer& layer) {
  if (!receivers.content.empty()) receivers.content += " " + layer.content;
  for (std::size_t i = 0; i < receivers.points.size(); ++i)
    if (layer.shares[i] == 0.0f) receivers.points[i].counts = false;
  return receivers;
}

/// Adds up what each layer makes of its share of a pixel.
class SharedTrace {
 public:
  explicit SharedTrace(std::size_t pixels)
      : sum_{std::vector<float>(pixels, 1.0f), std::vector<float>(pixels), std::vector<std::uint8_t>(pixels, 1),
             std::vector<std::uint32_t>(pixels)},
        deviations_(pixels),
        first_(pixels, kNone) {}

  void add(const truth::TracedVisibility& own, const std::vector<float>& shares) {
    for (std::size_t i = 0; i < shares.size(); ++i)
      if (shares[i] > 0.0f) add_pixel(i, own, shares[i]);
  }

  truth::TracedVisibility take() {
    for (float& deviation : deviations_) deviation *= deviation;
    sum_.variance = std::move(deviations_);
    return std::move(sum_);
  }

 private:
  static constexpr float kNone = -1.0f;
  truth::TracedVisibility sum_;
  std::vector<float> deviations_;  ///< roots of variances: all layers trace a pixel with the same samples
  std::vector<float> first_;       ///< what the first layer found

  void add_pixel(std::size_t i, const truth::TracedVisibility& own, float share) {
    const float found = own.visibility[i];
    const bool is_first = first_[i] == kNone;
    if (is_first) first_[i] = found;
    const bool agrees = first_[i] == found;
    sum_.visibility[i] = is_first ? found : sum_.visibility[i] + share * (found - first_[i]);
    sum_.standard_error[i] += share * own.standard_error[i];
    deviations_[i] += share * std::sqrt(own.variance[i]);
    sum_.unanimous[i] = static_cast<std::uint8_t>(sum_.unanimous[i] && own.unanimous[i] && agrees);
    sum_.rays[i] = std::max(sum_.rays[i], own.rays[i]) + (agrees ? 0 : 1);
  }
};

}  // namespace

std::vector<TracedLayer> list_traced_layers(render::ShaderLibrary& shaders, const render::GBuffer& gbuffer,
                                            const render::LightLayers& light) {
  std::vector<TracedLayer> layers;
  for (const render::LightSetup& each : light) {
    TracedLayer& layer = layers.emplace_back(TracedLayer{each.frustum, {}, {}});
    if (!each.frustum.is_layered()) continue;
    layer.shares = render::read_layer_shares(shaders, gbuffer, each);
    ContentHash hash;
    hash.add_values(std::span<const float>(layer.shares));
    layer.content = hash.name();
  }
  return layers;
}

std::size_t choose_layer(const std::vector<TracedLayer>& layers, std::size_t pixel) {
  if (layers.size() == 1) return 0;
  const auto most = std::ranges::max_element(layers, {}, [&](const TracedLayer& each) { return each.shares[pixel]; });
  return static_cast<std::size_t>(most - layers.begin());
}

truth::TracedVisibility trace_layers(const std::vector<TracedLayer>& layers, const truth::ReceiverImage& receivers,
                                     const LayerTrace& trace) {
  if (layers.front().shares.empty()) return trace(receivers, scene::make_map_grid(layers.front().frustum), 0);
  SharedTrace sum(receivers.points.size());
  for (std::size_t i = 0; i < layers.size(); ++i)
    sum.add(trace(keep_served(receivers, layers[i]), scene::make_map_grid(layers[i].frustum), i), layers[i].shares);
  return sum.take();
}

}  // namespace shadowbench::measure
