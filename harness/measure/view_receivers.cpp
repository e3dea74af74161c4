#include "harness/measure/view_receivers.h"

#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <memory>

#include "base/bytes.h"
#include "filters/percentage_closer.h"
#include "filters/receiver.h"
#include "harness/render/geometry.h"

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

bool ViewReceivers::any_counts() const { return std::ranges::any_of(image.points, &truth::ReceiverPoint::counts); }

images::Image ViewReceivers::to_image(const std::vector<float>& visibility) const {
  images::Image result(image.width, image.height, 1);
  for (std::size_t i = 0; i < visibility.size(); ++i)
    result.texels[i] = image.points[i].counts ? visibility[i] : is_surface[i] ? 0.0f : 1.0f;
  return result;
}

std::vector<std::uint8_t> ViewReceivers::mask() const {
  std::vector<std::uint8_t> result;
  for (const truth::ReceiverPoint& point : image.points) result.push_back(point.counts ? 1 : 0);
  return result;
}

bool lie_on_one_surface(const truth::ReceiverPoint& a, const truth::ReceiverPoint& b) {
  constexpr float kOffPlane = 0.05f, kCosine = 0.99f;
  const glm::vec3 way = b.position_ws - a.position_ws;
  return a.counts && b.counts && glm::dot(a.normal_ws, b.normal_ws) > kCosine &&
         std::abs(glm::dot(way, a.normal_ws)) <= kOffPlane * glm::length(way);
}

namespace {

bool faces(const scene::Light& light, const glm::vec3& position, const glm::vec3& normal) {
  return glm::dot(normal, scene::to_light(light, position)) > filters::kFacesLight && scene::shines_on(light, position);
}

}  // namespace

ViewSurfaces read_view_surfaces(const render::GBuffer& gbuffer) {
  return {render::read_image(gbuffer.position(), 4), render::read_image(gbuffer.normal(), 4)};
}

ViewReceivers make_view_receivers(const ViewSurfaces& surfaces, const scene::Light& light) {
  const auto& [positions, normals] = surfaces;
  const std::size_t pixels = positions.texels.size() / 4;
  ViewReceivers receivers{{positions.width, positions.height, std::vector<truth::ReceiverPoint>(pixels)},
                          std::vector<std::uint8_t>(pixels)};
  visit_in_parallel(pixels, [&](std::size_t i) {
    const float* p = &positions.texels[4 * i];
    const float* n = &normals.texels[4 * i];
    const glm::vec3 position(p[0], p[1], p[2]), normal(n[0], n[1], n[2]);
    const bool is_surface = p[3] != 0.0f;
    receivers.is_surface[i] = is_surface ? 1 : 0;
    receivers.image.points[i] = {position, normal, is_surface && faces(light, position, normal)};
  });
  ContentHash hash;
  hash.add_values(std::span<const float>(positions.texels));
  hash.add_values(std::span<const float>(normals.texels));
  hash.add_values(std::span<const std::uint8_t>(receivers.mask()));
  receivers.image.content = hash.name();
  return receivers;
}

ViewReceivers read_view_receivers(const render::GBuffer& gbuffer, const scene::Light& light) {
  return make_view_receivers(read_view_surfaces(gbuffer), light);
}

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

namespace {

constexpr float kRadiiPerTexel = 16.0f;  // of disks that differ from pixel to pixel

/// Compares every receiver with a disk of its own radius, one radius after the other: each has a table of weights.
void compare_disks(ModelImages& images, const ModelLayer& layer, const ModelView& view) {
  std::map<float, std::vector<std::size_t>> same_radius;
  for (std::size_t i = 0; i < layer.receivers.size(); ++i)
    same_radius[images.disk_radii_texels.back()[find_pixel(layer.receivers[i], view.width, view.height)]].push_back(i);
  tbb::parallel_for_each(same_radius, [&](const auto& entry) {
    const auto kernel = filters::Kernel::make_disk(static_cast<double>(entry.first));
    const filters::PercentageCloser closer(kernel, layer.map, view.plane_max_tangent,
                                           filters::PercentageCloser::Owner::kFewReceivers);
    visit_in_parallel(entry.second.size(), [&](std::size_t k) {
      const filters::Receiver& receiver = layer.receivers[entry.second[k]];
      put_share(images.closer[find_pixel(receiver, view.width, view.height)], receiver, closer.at(receiver));
    });
  });
}

}  // namespace

ModelImages evaluate_model(const filters::FilterRequest& request, const std::vector<ModelLayer>& layers,
                           const ModelView& view) {
  const std::unique_ptr<filters::ScalarModel> model = filters::make_model(request.spec);
  ModelImages images;
  if (!model) return images;
  const bool has_disks = !filters::find_kernel(request.spec, request.values);
  const std::size_t pixels = view.pixels();
  images.model.assign(pixels, 1.0);
  if (has_disks) images.closer.assign(pixels, 1.0);
  std::atomic<std::int64_t> excused = 0;
  for (const ModelLayer& layer : layers) {
    const filters::ModelInput input{.spec = request.spec,
                                    .values = request.values,
                                    .map = layer.map,
                                    .seed = view.seed,
                                    .plane_max_tangent = view.plane_max_tangent};
    const auto lookup = model->prepare(input, filters::Precision::kDouble);
    if (has_disks) images.disk_radii_texels.emplace_back(pixels, 0.0f);
    visit_in_parallel(layer.receivers.size(), [&](std::size_t i) {
      const filters::Receiver& receiver = layer.receivers[i];
      const std::size_t pixel = find_pixel(receiver, view.width, view.height);
      const filters::ModelResult result = lookup->at(receiver);
      put_share(images.model[pixel], receiver, result.visibility);
      if (has_disks)
        images.disk_radii_texels.back()[pixel] =
            std::round(kRadiiPerTexel * static_cast<float>(result.disk_radius_texels)) / kRadiiPerTexel;
      if (result.excused) ++excused;
    });
    if (has_disks) compare_disks(images, layer, view);
  }
  images.excused = excused;
  return images;
}

std::vector<double> compare_kernel(const filters::Kernel& kernel, const std::vector<ModelLayer>& layers,
                                   const ModelView& view) {
  std::vector<double> image(view.pixels(), 1.0);
  for (const ModelLayer& layer : layers) {
    const filters::PercentageCloser closer(kernel, layer.map, view.plane_max_tangent);
    visit_in_parallel(layer.receivers.size(), [&](std::size_t i) {
      const filters::Receiver& receiver = layer.receivers[i];
      put_share(image[find_pixel(receiver, view.width, view.height)], receiver, closer.at(receiver));
    });
  }
  return image;
}

}  // namespace shadowbench::measure
