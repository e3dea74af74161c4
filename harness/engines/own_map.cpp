#include "harness/engines/own_map.h"

#include <algorithm>
#include <cmath>

namespace shadowbench::engines {
namespace {

/// A point's place in the map, and how it changes along a direction.
struct Place {
  glm::dvec3 uv_depth{0.0};
  double w = 1.0;
};

Place place(const glm::dmat4& map_from_world, const glm::dvec3& point) {
  const glm::dvec4 at = map_from_world * glm::dvec4(point, 1.0);
  return {glm::dvec3(at) / at.w, at.w};
}

glm::dvec3 change_along(const glm::dmat4& map_from_world, const Place& at, const glm::dvec3& direction) {
  const glm::dvec4 change = map_from_world * glm::dvec4(direction, 0.0);
  return (glm::dvec3(change) - at.uv_depth * change.w) / at.w;
}

/// The depth that a plane gains over half a texel along u and along v; 0 where the light sees it from its edge.
double plane_bias(const OwnMap& map, const Place& at, const glm::dvec3& normal) {
  const glm::dvec3 across = std::abs(normal.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
  const glm::dvec3 first = glm::normalize(glm::cross(normal, across)), second = glm::cross(normal, first);
  const glm::dvec3 a = change_along(map.map_from_world, at, first), b = change_along(map.map_from_world, at, second);
  const double area = a.x * b.y - a.y * b.x;
  if (area == 0.0) return 0.0;
  const double along_u = (a.z * b.y - b.z * a.y) / area, along_v = (b.z * a.x - a.z * b.x) / area;
  return 0.5 * (std::abs(along_u) / map.depth.width + std::abs(along_v) / map.depth.height);
}

}  // namespace

std::vector<double> look_up(const OwnMap& map, const truth::ReceiverImage& receivers,
                            const std::vector<glm::vec3>& to_light_ws) {
  std::vector<double> lit(receivers.points.size(), 1.0);
  for (std::size_t i = 0; i < lit.size(); ++i) {
    const truth::ReceiverPoint& receiver = receivers.points[i];
    if (!receiver.counts) continue;
    const Place at = place(map.map_from_world, glm::dvec3(receiver.position_ws));
    const glm::dvec3& p = at.uv_depth;
    if (!(at.w > 0.0 && p.x >= 0.0 && p.x < 1.0 && p.y > 0.0 && p.y <= 1.0)) continue;
    const int column = static_cast<int>(p.x * map.depth.width), row = static_cast<int>((1.0 - p.y) * map.depth.height);
    const double stored =
        static_cast<double>(*map.depth.at(std::min(column, map.depth.width - 1), std::min(row, map.depth.height - 1)));
    // Away from the light depth grows, or with a reversed map falls.
    const double sign = change_along(map.map_from_world, at, -glm::dvec3(to_light_ws[i])).z >= 0.0 ? 1.0 : -1.0;
    constexpr double kRounding = 1e-6;  // of 24 bits, and of single precision on the way
    const double bias = plane_bias(map, at, glm::dvec3(receiver.normal_ws)) + kRounding;
    lit[i] = sign * (p.z - stored) > bias ? 0.0 : 1.0;  // what holds nothing blocks nothing
  }
  return lit;
}

}  // namespace shadowbench::engines
