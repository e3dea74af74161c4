#include "filters/disk_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace shadowbench::filters {

glm::dvec2 map_to_disk(glm::dvec2 square) {
  const glm::dvec2 p = 2.0 * square - 1.0;
  if (p.x == 0.0 && p.y == 0.0) return p;
  const bool wide = std::abs(p.x) > std::abs(p.y);
  const double radius = wide ? p.x : p.y;
  const double quarter = std::numbers::pi / 4.0;
  const double angle = wide ? quarter * (p.y / p.x) : 2.0 * quarter - quarter * (p.x / p.y);
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

std::vector<glm::vec2> generate_disk_points(int count, unsigned seed) {
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<glm::dvec2> points;
  glm::dvec2 mean(0.0);
  for (int i = 0; i < count; ++i) {
    const double radius = std::sqrt((i + 0.5) / count), angle = golden_angle * (static_cast<double>(seed) + i);
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    mean += points.back() / static_cast<double>(count);
  }
  double reach = 1.0;
  for (const glm::dvec2& point : points) reach = std::max(reach, glm::length(point - mean));
  std::vector<glm::vec2> result;
  for (const glm::dvec2& point : points) result.emplace_back((point - mean) / reach);
  return result;
}

std::vector<glm::vec2> generate_disk_points(const FilterSpec& spec, const ParamValues& values,
                                            const std::string& name) {
  const auto disk =
      std::find_if(spec.disks.begin(), spec.disks.end(), [&](const DiskTable& d) { return d.name == name; });
  assert(disk != spec.disks.end());
  return generate_disk_points(static_cast<int>(number(values, disk->count)), disk->seed);
}

}  // namespace shadowbench::filters
