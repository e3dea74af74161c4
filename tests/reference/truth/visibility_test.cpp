// Ray-traced visibility against closed forms, by z-tests: the truth that filters are scored against is itself checked.

#include "reference/truth/visibility.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace shadowbench::reference {
namespace {

/// A rectangle at height h, from (x0, z0) to (x1, z1), in n x n cells: giant triangles limit the accuracy.
OccluderMesh make_sheet(double x0, double x1, double z0, double z1, double h, int n = 64) {
  OccluderMesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      mesh.positions.emplace_back(x0 + (x1 - x0) * i / n, h, z0 + (z1 - z0) * j / n);
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (n + 1) + i), b = a + 1, c = a + static_cast<std::uint32_t>(n + 1);
      mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, c + 1});
    }
  }
  return mesh;
}

OccluderMesh make_disk_sheet(double radius, double h, int segments = 2048) {
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

/// Receivers on the ground along x, several rows deep.
ReceiverImage make_line(double x0, double x1, int width, int height = 8) {
  ReceiverImage image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.points.push_back({glm::vec3(x0 + (x1 - x0) * (x + 0.5) / width, 0.0, 0.01 * y), {0.0f, 1.0f, 0.0f}, true});
    }
  }
  return image;
}

/// Two-sided z-test of many pixels with 15 degrees of freedom: at a family-wise level of 1e-3 over some 2000 pixels,
/// Bonferroni asks for the quantile at 2.5e-7 per tail, which is 8.0 for Student's t.
constexpr double kCorrectedQuantile = 8.0;

struct ZScores {
  int unanimous = 0;
  int beyond_limit = 0;  ///< unanimous pixels whose exact value lies beyond their 95 % limit
  double worst = 0.0;
  double rms = 0.0;
  int count = 0;
};

ZScores score(const AreaTruth& truth, const ReceiverImage& image, const std::function<double(const glm::dvec3&)>& exact) {
  ZScores scores;
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    const double expected = exact(glm::dvec3(image.points[i].position_ws));
    const double got = static_cast<double>(truth.visibility[i]);
    if (truth.unanimous[i]) {
      ++scores.unanimous;
      if (std::abs(got - expected) > 3.0 / truth.rays[i]) ++scores.beyond_limit;
      continue;
    }
    const double z = (got - expected) / static_cast<double>(truth.standard_error[i]);
    scores.worst = std::max(scores.worst, std::abs(z));
    scores.rms += z * z;
    ++scores.count;
  }
  scores.rms = std::sqrt(scores.rms / scores.count);
  return scores;
}

void expect_agreement(const ZScores& scores) {
  std::printf("%d penumbra pixels, rms z %.3f, worst %.2f\n", scores.count, scores.rms, scores.worst);
  EXPECT_GT(scores.count, 500);
  EXPECT_LE(scores.beyond_limit, 0.05 * scores.unanimous);
  EXPECT_LT(scores.worst, kCorrectedQuantile);
  EXPECT_GT(scores.rms, 0.8);
  EXPECT_LT(scores.rms, 1.25);
}

constexpr double kOccluderHeight = 2.0;
constexpr double kLightHeight = 10.0;

/// Half-plane filling x < 0 over a disk light: V = (acos t - t sqrt(1 - t^2)) / pi, t = x (1 - H/h) / R.
double half_plane_over_disk(double x, double radius) {
  const double t = std::clamp(x * (1.0 - kLightHeight / kOccluderHeight) / radius, -1.0, 1.0);
  return (std::acos(t) - t * std::sqrt(1.0 - t * t)) / std::numbers::pi;
}

std::vector<OccluderMesh> half_plane() { return {make_sheet(-40.0, 0.0, -40.0, 40.0, kOccluderHeight)}; }

TEST(AreaTruth, HalfPlaneOverDisk_FollowsTheClosedForm) {
  const Occluders occluders(half_plane());
  const AreaLight light = AreaLight::make_disk({0.0, kLightHeight, 0.0}, {0.0, -1.0, 0.0}, 1.0);
  const ReceiverImage image = make_line(-0.35, 0.35, 240);
  // The light's centre is above x = 0, so the edge's shadow is centred there for every row.
  expect_agreement(score(trace_area(occluders, image, light, {0.005, 1024, 1}), image,
                         [](const glm::dvec3& p) { return half_plane_over_disk(p.x, 1.0); }));
}

TEST(AreaTruth, HalfPlaneOverRectangle_IsALinearRamp) {
  const Occluders occluders(half_plane());
  const AreaLight light = AreaLight::make_rectangle({0.0, kLightHeight, 0.0}, {0.7, 0.0, 0.0}, {0.0, 0.0, 0.5});
  const ReceiverImage image = make_line(-0.25, 0.25, 240);
  const double width = 1.4 * kOccluderHeight / (kLightHeight - kOccluderHeight);
  expect_agreement(score(trace_area(occluders, image, light, {0.005, 1024, 2}), image,
                         [&](const glm::dvec3& p) { return std::clamp(0.5 + p.x / width, 0.0, 1.0); }));
}

TEST(AreaTruth, Slit_AddsUp) {
  // Edges at -0.1 and 0.1: what one half-plane lets through and the other lets through, less one.
  std::vector<OccluderMesh> slit = {make_sheet(-40.0, -0.1, -40.0, 40.0, kOccluderHeight),
                                    make_sheet(0.1, 40.0, -40.0, 40.0, kOccluderHeight)};
  const Occluders occluders(slit);
  const AreaLight light = AreaLight::make_disk({0.0, kLightHeight, 0.0}, {0.0, -1.0, 0.0}, 1.0);
  const ReceiverImage image = make_line(-0.45, 0.45, 240);
  // An edge at e shifts the shadow's centre to e H / (H - h) on the ground below a light above x = 0.
  const double shift = 0.1 * kLightHeight / (kLightHeight - kOccluderHeight);
  expect_agreement(score(trace_area(occluders, image, light, {0.005, 1024, 3}), image, [&](const glm::dvec3& p) {
    return std::max(0.0, half_plane_over_disk(p.x + shift, 1.0) + half_plane_over_disk(shift - p.x, 1.0) - 1.0);
  }));
}

/// The area of two disks' overlap.
double lens_area(double r1, double r2, double d) {
  if (d >= r1 + r2) return 0.0;
  const double small = std::min(r1, r2);
  if (d <= std::abs(r1 - r2)) return std::numbers::pi * small * small;
  const double a = std::acos(std::clamp((d * d + r1 * r1 - r2 * r2) / (2.0 * d * r1), -1.0, 1.0));
  const double b = std::acos(std::clamp((d * d + r2 * r2 - r1 * r1) / (2.0 * d * r2), -1.0, 1.0));
  return r1 * r1 * (a - std::sin(2.0 * a) / 2.0) + r2 * r2 * (b - std::sin(2.0 * b) / 2.0);
}

TEST(AreaTruth, DiskOverDisk_IsALens) {
  const std::vector<OccluderMesh> disk = {make_disk_sheet(0.3, kOccluderHeight)};
  const Occluders occluders(disk);
  const AreaLight light = AreaLight::make_disk({0.0, kLightHeight, 0.0}, {0.0, -1.0, 0.0}, 1.0);
  const ReceiverImage image = make_line(-0.7, 0.7, 240);
  // Seen from the ground, the occluder covers a disk of radius r H/h around p + (c - p) H/h in the light's plane.
  const double scale = kLightHeight / kOccluderHeight;
  expect_agreement(score(trace_area(occluders, image, light, {0.005, 1024, 4}), image, [&](const glm::dvec3& p) {
    const double distance = std::hypot(p.x, p.z) * std::abs(1.0 - scale);
    return 1.0 - lens_area(1.0, 0.3 * scale, distance) / std::numbers::pi;
  }));
}

TEST(AreaTruth, SunOverHalfPlane_FollowsTheClosedForm) {
  const Occluders occluders(half_plane());
  const AreaLight light = AreaLight::make_sun({0.0, 1.0, 0.0}, 3.0);
  const double radius = kOccluderHeight * std::tan(glm::radians(1.5));
  const ReceiverImage image = make_line(-0.06, 0.06, 240);
  expect_agreement(score(trace_area(occluders, image, light, {0.005, 1024, 5}), image, [&](const glm::dvec3& p) {
    const double t = std::clamp(-p.x / radius, -1.0, 1.0);
    return (std::acos(t) - t * std::sqrt(1.0 - t * t)) / std::numbers::pi;
  }));
}

TEST(AreaTruth, DoesNotDependOnThreads) {
  const Occluders occluders(half_plane());
  const AreaLight light = AreaLight::make_sun({0.0, 1.0, 0.0}, 3.0);
  const ReceiverImage image = make_line(-0.06, 0.06, 100);
  const AreaTruth many = trace_area(occluders, image, light, {});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(trace_area(occluders, image, light, {}).visibility, many.visibility);
}

TEST(HardTruth, OfAPointLight_IsAStep) {
  const Occluders occluders(half_plane());
  const AreaLight light = AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0);
  const ReceiverImage image = make_line(-1.0, 1.0, 64);
  const std::vector<float> visibility = trace_hard(occluders, image, light);
  for (int x = 0; x < 64; ++x) EXPECT_EQ(visibility[static_cast<std::size_t>(x)], x < 32 ? 0.0f : 1.0f);
  EXPECT_EQ(trace_area(occluders, image, light, {}).visibility, visibility) << "size 0 is a hard shadow";
}

TEST(Occluders, APlaneAtCoordinateZero_DoesNotShadowItself) {
  for (const double elevation : {90.0, 60.0, 5.0}) {
    const std::vector<OccluderMesh> floor = {make_sheet(-5.0, 5.0, -5.0, 5.0, 0.0, 20)};
    const Occluders occluders(floor);
    const double angle = glm::radians(elevation);
    const AreaLight light = AreaLight::make_sun({std::cos(angle), std::sin(angle), 0.0}, 0.53);
    for (const float v : trace_hard(occluders, make_line(-4.0, 4.0, 200), light)) ASSERT_EQ(v, 1.0f) << elevation;
  }
}

TEST(Occluders, NeitherSelfHitsNorLeaks_AtAnyScale) {
  for (const double scale : {1e-3, 1.0, 1e3, 1e6}) {
    // A tilted floor with a roof over half of it, away from the origin.
    std::vector<OccluderMesh> meshes = {make_sheet(-1.0, 1.0, -1.0, 1.0, 0.0, 16), make_sheet(-1.0, 0.0, -1.0, 1.0, 0.01, 16)};
    const auto place = [&](const glm::dvec3& p) { return glm::vec3(scale * (p + glm::dvec3(3.0, 0.37 * p.x, -7.0))); };
    for (OccluderMesh& mesh : meshes) {
      for (glm::vec3& p : mesh.positions) p = place(glm::dvec3(p));
    }
    const Occluders occluders(meshes);
    ReceiverImage image{200, 200, {}};
    const glm::vec3 normal = glm::normalize(glm::vec3(-0.37f, 1.0f, 0.0f));
    // A GPU interpolates in single precision: up to four roundings of the largest coordinate, to either side.
    const float rounding = static_cast<float>(scale) * 8.0f * 0x1p-24f;
    for (int i = 0; i < 200 * 200; ++i) {
      const double x = -0.9 + 1.8 * (i % 200 + 0.5) / 200.0, z = -0.9 + 1.8 * (i / 200 + 0.5) / 200.0;
      const float error = rounding * static_cast<float>(i % 9 - 4);
      image.points.push_back({place({x, 0.0, z}) + error * normal, normal, std::abs(x) > 0.02});
    }
    const std::vector<float> lit = trace_hard(occluders, image, AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0));
    int self_hits = 0, leaks = 0;
    for (int i = 0; i < 200 * 200; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!image.points[k].counts) continue;
      const bool covered = i % 200 < 100;
      self_hits += !covered && lit[k] == 0.0f ? 1 : 0;
      leaks += covered && lit[k] == 1.0f ? 1 : 0;
    }
    EXPECT_EQ(self_hits, 0) << "scale " << scale;
    EXPECT_EQ(leaks, 0) << "scale " << scale;
  }
}

}  // namespace
}  // namespace shadowbench::reference
