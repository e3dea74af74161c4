// Ray-traced kernels against closed forms: an edge in front of a slanted light shows the kernel's own distribution.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "filters/kernel.h"
#include "reference/metrics/error_stats.h"
#include "tests/reference/truth/shapes.h"
#include "tests/reference/truth/z_scores.h"

namespace shadowbench::truth {
namespace {

using filters::Kernel;
using filters::Reconstruction;

constexpr double kHeight = 2.0;
constexpr double kTexel = 0.02;
constexpr double kTilt = 50.0;  ///< degrees between the light and the floor's normal

/// The light comes from +x: texels along u are foreshortened on the floor.
MapGrid tilted_grid() {
  const double angle = glm::radians(kTilt);
  return {{std::sin(angle), std::cos(angle), 0.0}, {std::cos(angle), -std::sin(angle), 0.0}, {0.0, 0.0, 1.0}, kTexel};
}

/// How far the shadow's edge lies behind a receiver, in texels of u: positive is lit.
double texels_from_edge(const glm::dvec3& p) {
  const double angle = glm::radians(kTilt);
  return (p.x + kHeight * std::tan(angle)) * std::cos(angle) / kTexel;
}

double tent_below(double x) {
  const double t = std::clamp(x, -1.0, 1.0);
  return t < 0.0 ? 0.5 * (1.0 + t) * (1.0 + t) : 1.0 - 0.5 * (1.0 - t) * (1.0 - t);
}

/// Receivers across the shadow's edge, `reach` texels to either side.
ReceiverImage make_receivers(double reach) {
  const double angle = glm::radians(kTilt), edge = -kHeight * std::tan(angle), half = reach * kTexel / std::cos(angle);
  return make_line(edge - half, edge + half, 160, 8);
}

template <class Exact>
void expect_kernel(const Kernel& kernel, Exact exact) {
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, 0.0, -40.0, 40.0, kHeight),
                                            make_sheet(-40.0, 40.0, -40.0, 40.0, 0.0)};
  const Occluders occluders(meshes);
  const ReceiverImage image = make_receivers(0.9 * kernel.half_width());
  expect_agreement(score_seeds(
      [&](std::uint32_t seed) { return trace_kernel(occluders, image, kernel, tilted_grid(), {.seed = seed}); }, image,
      [&](const glm::dvec3& p) { return exact(texels_from_edge(p)); }));
}

TEST(KernelTruth, OfATent) { expect_kernel(Kernel::make_point(Reconstruction::kBilinear), tent_below); }

TEST(KernelTruth, OfATrapezoid) {
  expect_kernel(
      Kernel::make_grid({{-0.5, 0.5}, {0.5, 0.5}}, Reconstruction::kBilinear),
      [](double t) { return 0.5 * (tent_below(t - 0.5) + tent_below(t + 0.5)); });
}

TEST(KernelTruth, OfAGaussian) {
  const std::vector<float> weights = filters::gaussian_weights(4);
  expect_kernel(Kernel::make_gaussian(4, Reconstruction::kBilinear), [&](double t) {
    double sum = 0.0;
    for (int i = -4; i <= 4; ++i)
      sum += static_cast<double>(weights[static_cast<std::size_t>(i + 4)]) * tent_below(t - i);
    return sum;
  });
}

/// A lamp that looks straight down: on the floor, parallel to its map, all texels are of one size.
TEST(KernelTruth, OfATent_UnderALamp) {
  constexpr double kLampHeight = 4.0, kSheetEdge = 0.5, kReference = 2.0;
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, kSheetEdge, -40.0, 40.0, kHeight),
                                            make_sheet(-40.0, 40.0, -40.0, 40.0, 0.0)};
  const Occluders occluders(meshes);
  const double edge = kSheetEdge * kLampHeight / (kLampHeight - kHeight), texel = kTexel * kLampHeight / kReference;
  const MapGrid grid{
      {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, kTexel, MapGrid::Lamp{{0.0, kLampHeight, 0.0}, kReference}};
  const Kernel kernel = Kernel::make_point(Reconstruction::kBilinear);
  const ReceiverImage image = make_line(edge - 0.9 * texel, edge + 0.9 * texel, 160, 8);
  expect_agreement(
      score_seeds([&](std::uint32_t seed) { return trace_kernel(occluders, image, kernel, grid, {.seed = seed}); },
                  image, [&](const glm::dvec3& p) { return tent_below((p.x - edge) / texel); }));
}

/// Texels that are sheared, and grow along z: a step along v goes half a texel back along u.
TEST(KernelTruth, OfATent_InAWarpedMap) {
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, 0.0, -40.0, 40.0, kHeight),
                                            make_sheet(-40.0, 40.0, -40.0, 40.0, 0.0)};
  const Occluders occluders(meshes);
  MapGrid grid = tilted_grid();
  const auto texel_at = [](const glm::dvec3& p) { return kTexel * (1.0 + 0.2 * p.z); };
  grid.curved = MapGrid::Curved{[&texel_at, right = grid.right, up = grid.up](const glm::dvec3& p) {
                                  return TexelGradients{(right + 0.5 * up) / texel_at(p), up / texel_at(p)};
                                },
                                "sheared"};
  const ReceiverImage image = make_receivers(1.0);
  const Kernel kernel = Kernel::make_point(Reconstruction::kBilinear);
  const auto exact = [&](const glm::dvec3& p) {
    const double t = texels_from_edge(p) * kTexel / texel_at(p);
    constexpr int kSteps = 400;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double along_v = 2.0 * (i + 0.5) / kSteps - 1.0;
      sum += (1.0 - std::abs(along_v)) * (2.0 / kSteps) * tent_below(t + 0.5 * along_v);
    }
    return sum;
  };
  expect_agreement(score_seeds(
      [&](std::uint32_t seed) { return trace_kernel(occluders, image, kernel, grid, {.seed = seed}); }, image, exact));
}

/// A disk's share below an edge: its chords, each blurred by the tent.
double disk_below(double radius, double t) {
  double sum = 0.0;
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    const double x = radius * (2.0 * (i + 0.5) / kSteps - 1.0);
    sum += 2.0 * std::sqrt(radius * radius - x * x) * (2.0 * radius / kSteps) * tent_below(t - x);
  }
  return sum / (radius * radius * std::numbers::pi);
}

TEST(KernelTruth, OfADisk) {
  expect_kernel(
      Kernel::make_disk(3.0), [](double t) { return disk_below(3.0, t); });
}

TEST(KernelTruth, OfDisks_IsThatOfEachReceiversOwn) {
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, 0.0, -40.0, 40.0, kHeight)};
  const Occluders occluders(meshes);
  const ReceiverImage image = make_receivers(2.7);
  const auto radius_at = [](const glm::dvec3& p) { return p.z > 0.0 ? 1.0f : 4.0f; };
  std::vector<float> radii;
  for (const ReceiverPoint& point : image.points) radii.push_back(radius_at(glm::dvec3(point.position_ws)));
  ASSERT_NE(radii.front(), radii.back());
  expect_agreement(score_seeds(
      [&](std::uint32_t seed) { return trace_disks(occluders, image, radii, tilted_grid(), {.seed = seed}); }, image,
      [&](const glm::dvec3& p) { return disk_below(static_cast<double>(radius_at(p)), texels_from_edge(p)); }));
}

TEST(KernelTruth, OfDisksWithoutSize_IsThatOfAFetch) {
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, 0.0, -40.0, 40.0, kHeight)};
  const Occluders occluders(meshes);
  const ReceiverImage image = make_receivers(1.5);
  const std::vector<float> radii(image.points.size(), 0.0f);
  EXPECT_EQ(trace_disks(occluders, image, radii, tilted_grid(), {}).visibility,
            trace_kernel(occluders, image, Kernel::make_disk(0.0), tilted_grid(), {}).visibility);
}

TEST(KernelTruth, OfAPoint_IsTheHardShadow) {
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, 0.0, -40.0, 40.0, kHeight)};
  const Occluders occluders(meshes);
  const ReceiverImage image = make_receivers(3.0);
  const MapGrid grid = tilted_grid();
  EXPECT_EQ(trace_kernel(occluders, image, Kernel::make_point(Reconstruction::kNearest), grid, {}).visibility,
            trace_hard(occluders, image, AreaLight::make_sun(grid.to_light, 0.53)));
}

TEST(KernelTruth, AnEmptySlantedPlane_IsLit_AtEveryAngle) {
  for (const double tilt : {0.0, 45.0, 80.0, 89.0, 89.9}) {
    const double angle = glm::radians(tilt);
    const MapGrid grid = {
        {std::sin(angle), std::cos(angle), 0.0}, {std::cos(angle), -std::sin(angle), 0.0}, {0.0, 0.0, 1.0}, kTexel};
    const std::vector<OccluderMesh> meshes = {make_sheet(-5.0, 5.0, -5.0, 5.0, 0.1, 40)};
    const Occluders occluders(meshes);
    ReceiverImage image = make_line(-4.0, 4.0, 200);
    for (ReceiverPoint& point : image.points) point.position_ws.y = 0.1f;
    for (const float v : trace_kernel(occluders, image, Kernel::make_disk(16.0), grid, {}).visibility)
      ASSERT_EQ(v, 1.0f) << tilt;
  }
}

TEST(KernelTruth, IsAsWideAsTheTexelsAre) {
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, 0.0, -40.0, 40.0, kHeight)};
  const Occluders occluders(meshes);
  MapGrid grid = tilted_grid();
  grid.texel_size_ws = 3.0 * kTexel;
  const ReceiverImage image = make_receivers(2.7);
  expect_agreement(score_seeds(
      [&](std::uint32_t seed) {
        return trace_kernel(occluders, image, Kernel::make_point(Reconstruction::kBilinear), grid, {.seed = seed});
      },
      image, [](const glm::dvec3& p) { return tent_below(texels_from_edge(p) / 3.0); }));
}

TEST(KernelTruth, AnEmptyPlane_IsLit_UnderALargeKernelOfGrazingLight) {
  // A step along u and one along v are metres long each and nearly cancel: their roundings do not.
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.37, 1.0, 0.21));
  const glm::dvec3 along = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.1, 1.0)));
  const glm::dvec3 to_light = glm::normalize(along + 3e-3 * normal),
                   across = glm::normalize(glm::cross(to_light, along));
  const glm::dvec3 back = glm::cross(across, to_light);
  const MapGrid grid = {to_light, glm::normalize(across + back), glm::normalize(across - back), kTexel};
  OccluderMesh plane = make_sheet(-1.0, 1.0, -1.0, 1.0, 0.0, 16);
  const auto place = [&](float x, float z) {
    return glm::vec3(x, (0.37 * static_cast<double>(x) - 0.21 * static_cast<double>(z)), z);
  };
  for (glm::vec3& p : plane.positions) p = place(p.x, p.z);
  const Occluders occluders(std::vector<OccluderMesh>{plane});
  ReceiverImage image = make_line(-0.9, 0.9, 100);
  for (ReceiverPoint& point : image.points) point = {place(point.position_ws.x, point.position_ws.z), normal, true};
  for (const float v : trace_kernel(occluders, image, Kernel::make_disk(64.0), grid, {}).visibility) ASSERT_EQ(v, 1.0f);
}

TEST(SquareTruth, IsALinearRamp) {
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, 0.0, -40.0, 40.0, kHeight)};
  const Occluders occluders(meshes);
  const ReceiverImage image = make_receivers(2.5);
  expect_agreement(score_seeds(
      [&](std::uint32_t seed) { return trace_square(occluders, image, 2.5, tilted_grid(), {.seed = seed}); }, image,
      [](const glm::dvec3& p) { return std::clamp(0.5 + texels_from_edge(p) / 5.0, 0.0, 1.0); }));
}

TEST(SquareTruth, OfFirstPointsAlone_SettlesThePixelsThatMoreOfThemSettle) {
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, 0.0, -40.0, 40.0, kHeight)};
  const Occluders occluders(meshes);
  const ReceiverImage image = make_receivers(5.0);
  std::atomic<int> packets = 0;
  const TraceSettings first{
      .standard_error = 1.0, .max_points = kFirstPoints, .on_packet = [&](const RayPacket&) { ++packets; }};
  const TracedVisibility whole = trace_square(occluders, image, 2.5, tilted_grid(), {}),
                         few = trace_square(occluders, image, 2.5, tilted_grid(), first);
  int unsettled = 0, torn = 0;
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    const bool is_settled = whole.rays[i] == kRaysOfSettledPixel;
    ASSERT_EQ(few.rays[i] == kRaysOfSettledPixel, is_settled) << i;
    if (is_settled) ASSERT_EQ(few.visibility[i], whole.visibility[i]) << i;
    unsettled += is_settled ? 0 : 1;
    torn += few.rays[i] < kRaysOfSettledPixel ? 1 : 0;
  }
  EXPECT_GT(unsettled, torn);
  EXPECT_GT(torn, 0) << "the first points that disagree end a pixel";
  EXPECT_LT(packets, kFirstPoints * static_cast<int>(image.points.size()));
}

/// Mean squares over an edge of how far an image is from kernels traced with many seeds: as they are, and without the
/// variance of the traced.
struct MeanSquares {
  double plain = 0.0, unbiased = 0.0;
};

MeanSquares measure_squares(double standard_error) {
  const std::vector<OccluderMesh> meshes = {make_sheet(-40.0, 0.0, -40.0, 40.0, kHeight)};
  const Occluders occluders(meshes);
  const Kernel kernel = Kernel::make_point(Reconstruction::kBilinear);
  const ReceiverImage image = make_receivers(0.9 * kernel.half_width());
  const std::vector<std::uint8_t> mask(image.points.size(), 1);
  std::vector<float> shifted;
  for (const ReceiverPoint& point : image.points)
    shifted.push_back(static_cast<float>(tent_below(texels_from_edge(glm::dvec3(point.position_ws)) + 0.01)));
  MeanSquares squares;
  constexpr int kSeeds = 64;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const TracedVisibility traced =
        trace_kernel(occluders, image, kernel, tilted_grid(), {.standard_error = standard_error, .seed = seed});
    const double plain = metrics::measure_error(shifted, traced.visibility, mask)->rmse;
    const double unbiased = metrics::measure_error(shifted, traced.visibility, mask, traced.variance)->rmse;
    squares.plain += plain * plain / kSeeds;
    squares.unbiased += unbiased * unbiased / kSeeds;
  }
  return squares;
}

TEST(KernelTruth, MeanSquaresWithoutItsVariance_AreThoseOfAFinerTruth) {
  const MeanSquares rough = measure_squares(0.01), fine = measure_squares(0.0025);
  std::printf("mean squares: %.3g, unbiased %.3g; finer %.3g, unbiased %.3g\n", rough.plain, rough.unbiased, fine.plain,
              fine.unbiased);
  const double bias = rough.plain - fine.unbiased;
  EXPECT_GT(bias, 0.2 * fine.unbiased) << "what sampling adds is seen";
  EXPECT_NEAR(rough.unbiased, fine.unbiased, 0.1 * bias);
}

}  // namespace
}  // namespace shadowbench::truth
