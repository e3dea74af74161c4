#include "filters/disk_points.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace shadowbench::filters {
namespace {

constexpr int kCandidatesPerPoint = 256;

/// Uniform in the unit disk by rejection; distributions of the standard library differ between implementations.
glm::dvec2 draw(std::mt19937& generator) {
  for (;;) {
    const double x = static_cast<double>(generator()) * 0x1p-31 - 1.0;
    const double y = static_cast<double>(generator()) * 0x1p-31 - 1.0;
    if (x * x + y * y <= 1.0) return {x, y};
  }
}

double squared_distance(const std::vector<glm::dvec2>& points, glm::dvec2 candidate) {
  double nearest = std::numeric_limits<double>::max();
  for (const glm::dvec2& point : points) {
    const glm::dvec2 d = point - candidate;
    nearest = std::min(nearest, glm::dot(d, d));
  }
  return nearest;
}

}  // namespace

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
  std::mt19937 generator(seed);
  std::vector<glm::dvec2> points;
  while (static_cast<int>(points.size()) < count) {
    glm::dvec2 best = draw(generator);
    for (int i = 1; i < kCandidatesPerPoint && !points.empty(); ++i) {
      const glm::dvec2 candidate = draw(generator);
      if (squared_distance(points, candidate) > squared_distance(points, best)) best = candidate;
    }
    points.push_back(best);
  }
  glm::dvec2 mean(0.0);
  for (const glm::dvec2& point : points) mean += point / static_cast<double>(count);
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
