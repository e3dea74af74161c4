#include "harness/measure/map_coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "filters/kernel.h"

namespace shadowbench::measure {

namespace {

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
      : eye_(camera.position_ws),
        forward_(camera.forward_ws),
        right_(glm::normalize(glm::cross(forward_, glm::dvec3(camera.up_ws)))),
        up_(glm::cross(right_, forward_)),
        orthographic_(camera.orthographic_height_m > 0.0f),
        pixel_(orthographic_ ? static_cast<double>(camera.orthographic_height_m) / height
                             : 2.0 * std::tan(0.5 * static_cast<double>(camera.vertical_fov_rad)) / height),
        frustum_(frustum),
        map_size_(map_size) {}

  Footprint project(const truth::ReceiverPoint& point) const {
    const glm::dvec3 position(point.position_ws), normal(point.normal_ws);
    const glm::dvec3 from_eye = position - eye_;
    const glm::dvec3 ray = orthographic_ ? forward_ : glm::normalize(from_eye);
    const double side = orthographic_ ? pixel_ : pixel_ * glm::dot(from_eye, forward_);
    // A plane seen edge on would have a footprint without bound.
    constexpr double kGrazing = 1e-6;
    const double facing = std::min(glm::dot(normal, ray), -kGrazing);
    const truth::TexelGradients along = scene::find_gradients(frustum_, position);
    const auto edge = [&](const glm::dvec3& across) {
      const glm::dvec3 on_plane = side * (across - ray * (glm::dot(normal, across) / facing));
      return glm::dvec2(glm::dot(along.u, on_plane), glm::dot(along.v, on_plane));
    };
    return {glm::dvec2(frustum_.place(position, map_size_)), edge(right_), edge(up_)};
  }

  bool is_in_map(const Footprint& texels) const {
    return glm::all(glm::greaterThanEqual(texels.centre, glm::dvec2(0.0))) &&
           glm::all(glm::lessThanEqual(texels.centre, glm::dvec2(map_size_)));
  }

 private:
  glm::dvec3 eye_, forward_, right_, up_;
  bool orthographic_;
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

}  // namespace

MapCoverage measure_coverage(const ViewReceivers& receivers, const scene::Camera& camera,
                             const std::vector<TracedLayer>& layers, const images::Image& depth_map) {
  const int width = receivers.image.width, height = receivers.image.height, map_size = depth_map.height;
  std::vector<PixelProjector> projectors;
  for (const TracedLayer& each : layers) projectors.emplace_back(camera, each.frustum, height, map_size);
  std::vector<CoverageCells> cells(layers.size(), CoverageCells(map_size));
  MapCoverage coverage{images::Image(width, height, 1), images::Image(width, height, 2), {}, {}};
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
    coverage.texel.texels[2 * i] = static_cast<float>(footprint.centre.x + static_cast<double>(layer) * map_size);
    coverage.texel.texels[2 * i + 1] = static_cast<float>(footprint.centre.y);
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

namespace {

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
