#pragma once

// Occluders and receivers whose shadows have closed forms.

#include <cmath>
#include <numbers>

#include "reference/truth/visibility.h"

namespace shadowbench::truth {

/// A rectangle at height h, from (x0, z0) to (x1, z1), in n x n cells: giant triangles limit the accuracy.
inline OccluderMesh make_sheet(double x0, double x1, double z0, double z1, double h, int n = 64) {
  OccluderMesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.positions.emplace_back(x0 + (x1 - x0) * i / n, h, z0 + (z1 - z0) * j / n);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), b = a + 1, c = a + static_cast<std::uint32_t>(n + 1);
      mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, c + 1});
    }
  }
  return mesh;
}

/// A sheet at height h that fills x < 0.
inline std::vector<OccluderMesh> make_half_plane(double h) { return {make_sheet(-40.0, 0.0, -40.0, 40.0, h)}; }

inline OccluderMesh make_disk_sheet(double radius, double h, int segments = 2048) {
  OccluderMesh mesh;
  mesh.positions.emplace_back(0.0f, static_cast<float>(h), 0.0f);
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / segments;
    mesh.positions.emplace_back(radius * std::cos(angle), h, radius * std::sin(angle));
    const auto next = static_cast<std::uint32_t>(1 + (i + 1) % segments);
    mesh.indices.insert(mesh.indices.end(), {0u, next, static_cast<std::uint32_t>(1 + i)});
  }
  return mesh;
}

/// A sphere of triangles between meridians and parallels; its silhouette is inscribed.
inline OccluderMesh make_sphere(const glm::dvec3& centre, double radius, int meridians = 512) {
  OccluderMesh mesh;
  const int parallels = meridians / 2;
  for (int j = 0; j <= parallels; ++j) {
    for (int i = 0; i <= meridians; ++i) {
      const double theta = std::numbers::pi * j / parallels, phi = 2.0 * std::numbers::pi * i / meridians;
      mesh.positions.emplace_back(centre + radius * glm::dvec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                               std::sin(theta) * std::sin(phi)));
    }
  }
  for (int j = 0; j < parallels; ++j) {
    for (int i = 0; i < meridians; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (meridians + 1) + i), b = a + 1;
      const auto c = a + static_cast<std::uint32_t>(meridians + 1);
      mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, c + 1});
    }
  }
  return mesh;
}

/// Receivers on the ground along x, several rows deep.
inline ReceiverImage make_line(double x0, double x1, int width, int height = 8) {
  ReceiverImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.points.push_back({glm::vec3(x0 + (x1 - x0) * (x + 0.5) / width, 0.0, 0.01 * y), {0.0f, 1.0f, 0.0f}, true});
  return image;
}

}  // namespace shadowbench::truth
