#include "harness/measure/light_width.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "filters/kernel.h"

namespace shadowbench::measure {
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
