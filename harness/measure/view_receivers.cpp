#include "harness/measure/view_receivers.h"

#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "base/bytes.h"
#include "filters/percentage_closer.h"
#include "filters/screen.h"
#include "harness/measure/scene_assets.h"
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

bool faces(const scene::Light& light, const glm::vec3& position, const glm::vec3& normal) {
  return glm::dot(normal, scene::to_light(light, position)) > filters::kFacesLight && scene::shines_on(light, position);
}

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

/// A pixel's footprint in the map, in texels.
struct Footprint {
  glm::dvec2 centre{0.0};
  glm::dvec2 along_x{0.0};  ///< from one side of the pixel to the other
  glm::dvec2 along_y{0.0};
  double area() const { return std::abs(along_x.x * along_y.y - along_x.y * along_y.x); }
};

/// Projects pixels through their receivers' planes into the map.
class PixelProjector {
 public:
  PixelProjector(const scene::Camera& camera, const scene::LightFrustum& frustum, int height, int map_size)
      : axes_(camera),
        is_flat_(axes_.half_height > 0.0),
        pixel_(2.0 * (is_flat_ ? axes_.half_height : axes_.tangent) / height),
        frustum_(frustum),
        map_size_(map_size) {}

  Footprint project(const truth::ReceiverPoint& point) const {
    const glm::dvec3 position(point.position_ws), normal(point.normal_ws);
    const glm::dvec3 from_eye = position - axes_.eye;
    const glm::dvec3 ray = is_flat_ ? axes_.forward : glm::normalize(from_eye);
    const double side = is_flat_ ? pixel_ : pixel_ * glm::dot(from_eye, axes_.forward);
    // A plane seen edge on would have a footprint without bound.
    constexpr double kGrazing = 1e-6;
    const double facing = std::min(glm::dot(normal, ray), -kGrazing);
    const truth::TexelGradients along = scene::find_gradients(frustum_, position);
    const auto edge = [&](const glm::dvec3& across) {
      const glm::dvec3 on_plane = side * (across - ray * (glm::dot(normal, across) / facing));
      return glm::dvec2(glm::dot(along.u, on_plane), glm::dot(along.v, on_plane));
    };
    return {glm::dvec2(frustum_.place(position, map_size_)), edge(axes_.right), edge(axes_.up)};
  }

  bool is_in_map(const Footprint& texels) const {
    return glm::all(glm::greaterThanEqual(texels.centre, glm::dvec2(0.0))) &&
           glm::all(glm::lessThanEqual(texels.centre, glm::dvec2(map_size_)));
  }

 private:
  scene::ViewAxes axes_;
  bool is_flat_;
  double pixel_;  ///< side of a pixel: per metre ahead, or in metres where the camera is orthographic
  const scene::LightFrustum& frustum_;
  int map_size_;
};

/// The map's area in cells, marked where footprints fall.
class CoverageCells {
 public:
  explicit CoverageCells(int map_size)
      : side_(std::min(map_size, kMostCells)),
        per_texel_(static_cast<double>(side_) / map_size),
        marked_(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_)) {}

  void mark(const Footprint& texels) {
    const Footprint f{texels.centre * per_texel_, texels.along_x * per_texel_, texels.along_y * per_texel_};
    mark(static_cast<int>(std::floor(f.centre.x)), static_cast<int>(std::floor(f.centre.y)));
    const glm::dvec2 reach = 0.5 * (glm::abs(f.along_x) + glm::abs(f.along_y));
    if (std::max(reach.x, reach.y) > 0.5 * kWidest || f.area() < 1e-9) return;
    const glm::ivec2 first(glm::floor(f.centre - reach)), last(glm::floor(f.centre + reach));
    for (int y = first.y; y <= last.y; ++y) {
      for (int x = first.x; x <= last.x; ++x)
        if (holds(f, glm::dvec2(x + 0.5, y + 0.5) - f.centre)) mark(x, y);
    }
  }

  double share() const {
    return static_cast<double>(std::ranges::count(marked_, 1)) / static_cast<double>(marked_.size());
  }

 private:
  static constexpr int kMostCells = 512;
  static constexpr double kWidest = 64.0;
  int side_;
  double per_texel_;
  std::vector<std::uint8_t> marked_;

  void mark(int x, int y) {
    if (x < 0 || y < 0 || x >= side_ || y >= side_) return;
    marked_[static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(x)] = 1;
  }

  static bool holds(const Footprint& f, const glm::dvec2& d) {
    const double signed_area = f.along_x.x * f.along_y.y - f.along_x.y * f.along_y.x;
    const double s = (d.x * f.along_y.y - d.y * f.along_y.x) / signed_area;
    const double t = (f.along_x.x * d.y - f.along_x.y * d.x) / signed_area;
    return std::abs(s) <= 0.5 && std::abs(t) <= 0.5;
  }
};

/// Leaves the densities in another order.
std::optional<double> find_median(std::vector<float>& densities) {
  if (densities.empty()) return std::nullopt;
  const auto middle = densities.begin() + static_cast<std::ptrdiff_t>(densities.size() / 2);
  std::nth_element(densities.begin(), middle, densities.end());
  return static_cast<double>(*middle);
}

records::CoverageRecord summarise_coverage(std::vector<float> densities, const std::vector<CoverageCells>& layers) {
  records::CoverageRecord record;
  if (densities.empty()) return record;
  record.fewest_texels_per_pixel = static_cast<double>(std::ranges::min(densities));
  record.texels_per_pixel = find_median(densities);
  double used = 0.0;
  for (const CoverageCells& cells : layers) used += cells.share() / static_cast<double>(layers.size());
  record.map_used = used;
  return record;
}

/// The size of a texel at a point, in the finest of the layers that hold it; metres. Infinity where none does.
double find_texel_size(const std::vector<scene::LightFrustum>& layers, const glm::dvec3& point_ws, int map_size) {
  double finest = std::numeric_limits<double>::infinity();
  for (const scene::LightFrustum& layer : layers) {
    const glm::dvec3 place = layer.place(point_ws, map_size);
    const bool is_inside = place.x >= 0.0 && place.x <= map_size && place.y >= 0.0 && place.y <= map_size &&
                           place.z >= 0.0 && place.z <= 1.0;
    if (is_inside) finest = std::min(finest, layer.texel_size_at(point_ws));
  }
  return finest;
}

/// The value below which those lie that make up half of the sum of all. Requires one that is above 0.
double find_weighted_median(std::vector<double> values) {
  std::ranges::sort(values);
  double sum = 0.0, below = 0.0;
  for (const double value : values) sum += value;
  for (const double value : values)
    if ((below += value) >= 0.5 * sum) return value;
  return values.back();
}

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

ModelImages evaluate_model(const filters::FilterRequest& request, const std::vector<ModelLayer>& layers,
                           const ModelView& view) {
  const filters::ScalarModel* model = filters::find_model(request.spec);
  ModelImages images;
  if (!model) return images;
  const bool has_disks = !filters::find_kernel(request.spec, request.values);
  const std::size_t pixels = view.pixels();
  images.model.assign(pixels, 1.0);
  if (has_disks) images.closer.assign(pixels, 1.0);
  std::atomic<std::int64_t> excused = 0;
  auto picture = filters::ScreenPicture::make(*model, request.spec, request.values, view.width, view.height);
  for (const ModelLayer& layer : layers) {
    const auto lookup = model->prepare(view.input(request, layer.map), filters::Precision::kDouble);
    if (has_disks) images.disk_radii_texels.emplace_back(pixels, 0.0f);
    visit_in_parallel(layer.receivers.size(), [&](std::size_t i) {
      const filters::Receiver& receiver = layer.receivers[i];
      const std::size_t pixel = find_pixel(receiver, view.width, view.height);
      const filters::ModelResult result = lookup->at(receiver);
      put_share(images.model[pixel], receiver, result.visibility);
      if (has_disks)
        images.disk_radii_texels.back()[pixel] =
            std::round(kRadiiPerTexel * static_cast<float>(result.disk_radius_texels)) / kRadiiPerTexel;
      if (picture) picture->add(receiver, result);
      if (result.excused) ++excused;
    });
    if (has_disks) compare_disks(images, layer, view);
  }
  if (picture) {
    picture->filter(*model, request.spec, request.values, filters::Precision::kDouble);
    excused = 0;
    picture->visit_from_top([&](std::size_t i, const filters::ModelResult& result) {
      images.model[i] = result.visibility;
      if (result.excused) ++excused;
    });
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

MapCoverage measure_coverage(const ViewReceivers& receivers, const scene::Camera& camera,
                             const std::vector<TracedLayer>& layers, const images::Image& depth_map) {
  const int width = receivers.image.width, height = receivers.image.height, map_size = depth_map.height;
  std::vector<PixelProjector> projectors;
  for (const TracedLayer& each : layers) projectors.emplace_back(camera, each.frustum, height, map_size);
  std::vector<CoverageCells> cells(layers.size(), CoverageCells(map_size));
  MapCoverage coverage{images::Image(width, height, 1), {}, {}};
  std::vector<std::vector<float>> of_layers(layers.size());
  for (std::size_t i = 0; i < receivers.image.points.size(); ++i) {
    const truth::ReceiverPoint& point = receivers.image.points[i];
    if (!point.counts) {
      coverage.density.texels[i] = receivers.is_surface[i] ? 0.0f : -1.0f;
      continue;
    }
    const std::size_t layer = choose_layer(layers, i);
    const Footprint footprint = projectors[layer].project(point);
    if (!projectors[layer].is_in_map(footprint)) continue;
    cells[layer].mark(footprint);
    coverage.density.texels[i] = static_cast<float>(footprint.area());
    of_layers[layer].push_back(coverage.density.texels[i]);
  }
  std::vector<float> densities;
  for (std::vector<float>& own : of_layers) {
    densities.insert(densities.end(), own.begin(), own.end());
    coverage.texels_per_pixel.push_back(find_median(own));
  }
  coverage.record = summarise_coverage(std::move(densities), cells);
  const auto filled = std::ranges::count_if(depth_map.texels, [](float depth) { return depth < 1.0f; });
  coverage.record.map_filled = static_cast<double>(filled) / static_cast<double>(depth_map.texels.size());
  return coverage;
}

std::optional<double> find_light_sigma(const scene::EdgeMeter& meter, const options::RunOptions& options,
                                       const MapFit& fit) {
  options::RunOptions coarse = options;
  coarse.fit.cascades.seen = false;  // the depths that pixels show are not known before they are drawn
  const auto layers = fit_map_layers(coarse, fit, {});
  std::vector<double> widths;
  const double aspect = static_cast<double>(options.width) / options.height;
  for (const scene::EdgePenumbra& each : meter.list_penumbrae(fit.camera, fit.light, aspect)) {
    const double texel = find_texel_size(layers, glm::dvec3(each.position_ws), fit.map_size);
    if (std::isfinite(texel) && each.width_ws > 0.0) widths.push_back(each.width_ws / texel);
  }
  if (widths.empty()) return std::nullopt;
  return std::round(100.0 * filters::sigma_of_penumbra(find_weighted_median(std::move(widths)))) / 100.0;
}

}  // namespace shadowbench::measure
