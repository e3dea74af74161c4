#include "reference/metrics/attribution.h"

#include <cassert>
#include <cmath>

namespace shadowbench::metrics {
namespace {

using Parts = std::array<double, kErrorParts>;

Parts split(const AttributionStations& s, std::size_t i) {
  const double image = static_cast<double>(s.image[i]), kernel = static_cast<double>(s.kernel[i]);
  const double model = s.model.empty() ? image : s.model[i];
  return {image - model, model - s.closer[i], s.closer[i] - kernel, kernel - static_cast<double>(s.area[i])};
}

}  // namespace

Attribution attribute_error(const AttributionStations& stations) {
  const std::size_t pixels = stations.mask.size();
  assert(stations.image.size() == pixels && stations.closer.size() == pixels);
  assert(stations.model.empty() || stations.model.size() == pixels);
  assert(stations.kernel.size() == pixels && stations.area.size() == pixels);
  Attribution result;
  for (auto& part : result.parts) part.assign(pixels, 0.0f);
  Parts squares{}, products{};
  double error_squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!stations.mask[i]) continue;
    const Parts parts = split(stations, i);
    const double error = parts[0] + parts[1] + parts[2] + parts[3];
    if (!std::isfinite(error)) {
      ++result.not_finite;
      continue;
    }
    for (std::size_t p = 0; p < kErrorParts; ++p) {
      result.parts[p][i] = static_cast<float>(parts[p]);
      squares[p] += parts[p] * parts[p];
      products[p] += parts[p] * error;
    }
    error_squares += error * error;
    count += 1.0;
  }
  for (std::size_t p = 0; p < kErrorParts && error_squares > 0.0; ++p)
    result.stats[p] = PartStats{.rms = std::sqrt(squares[p] / count), .share = products[p] / error_squares};
  if (stations.model.empty()) {
    result.parts.front().clear();
    result.stats.front().reset();
  }
  return result;
}

}  // namespace shadowbench::metrics
