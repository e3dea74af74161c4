#include "filters/depth_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace shadowbench::filters {

double depth_quantum(double depth, const DepthFormat& format) {
  if (!format.is_float) return 1.0 / (std::exp2(format.bits) - 1.0);
  // Depth below the smallest normal number is 0 on most GLs.
  const double size = std::max(std::abs(depth), double{std::numeric_limits<float>::min()});
  return std::exp2(std::floor(std::log2(size)) - 23.0);
}

double depth_step(double depth, const DepthCurve& curve, const DepthFormat& format) {
  const double ratio = curve.far_over_near, distance = 1.0 + (ratio - 1.0) * depth;  // in units of the near plane's
  return distance * distance / ratio * depth_quantum(curve.store(depth), format);
}

const std::vector<std::string>& border_names() {
  static const std::vector<std::string> names = {"border", "edge", "repeat"};
  return names;
}

const std::string& to_string(Border border) { return border_names().at(static_cast<std::size_t>(border)); }

Border parse_border(const std::string& name) {
  const auto found = std::find(border_names().begin(), border_names().end(), name);
  if (found != border_names().end()) return static_cast<Border>(found - border_names().begin());
  throw Error(ErrorKind::kUsage, fmt::format("unknown border '{}'; known: {}", name, fmt::join(border_names(), ", ")));
}

}  // namespace shadowbench::filters
