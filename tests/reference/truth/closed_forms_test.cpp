#include <atomic>

#include "filters/kernel.h"
#include "reference/metrics/error_stats.h"
#include "tests/reference/truth/shapes.h"
#include "tests/test_files.h"

namespace shadowbench::truth {
namespace {

/// Two-sided z-test of many pixels with 15 degrees of freedom: at a family-wise level of 1e-3 over some 13 000 pixels,
/// Bonferroni asks for the quantile at 3.8e-8 per tail, which is 9.7 for Student's t.
constexpr double kCorrectedQuantile = 9.7;

/// The limit of a pixel that is unanimous though its neighbours are not: 256 rays.
constexpr double kSmallestLimit = 3.0 / 256.0;

struct ZScores {
  int beyond_limit = 0;  ///< unanimous pixels whose exact value lies beyond their 95 % limit
  int at_risk = 0;       ///< pixels that would be beyond it, were they unanimous
  double worst = 0.0;
  double squares = 0.0;
  double squared_errors = 0.0;
  double squared_standard_errors = 0.0;
  int count = 0;

  double rms() const { return std::sqrt(squares / count); }
  /// The root mean square of the errors in units of that of the stated standard errors: 1 where these are right.
  double understatement() const { return std::sqrt(squared_errors / squared_standard_errors); }
};

/// Pools several seeds: the pixels of one seed share sample sets, and their errors are related.
ZScores score_seeds(const std::function<TracedVisibility(std::uint32_t)>& trace, const ReceiverImage& image,
                    const std::function<double(const glm::dvec3&)>& exact) {
  ZScores scores;
  constexpr std::uint32_t kSeeds = 8;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const TracedVisibility truth = trace(seed);
    for (std::size_t i = 0; i < image.points.size(); ++i) {
      const double expected = exact(glm::dvec3(image.points[i].position_ws));
      const double error = static_cast<double>(truth.visibility[i]) - expected;
      if (std::min(expected, 1.0 - expected) > kSmallestLimit) ++scores.at_risk;
      if (truth.unanimous[i]) {
        if (std::abs(error) > 3.0 / truth.rays[i]) ++scores.beyond_limit;
        continue;
      }
      const double stated = static_cast<double>(truth.standard_error[i]), z = error / stated;
      scores.squared_errors += error * error;
      scores.squared_standard_errors += stated * stated;
      scores.worst = std::max(scores.worst, std::abs(z));
      scores.squares += z * z;
      ++scores.count;
    }
  }
  return scores;
}

void expect_agreement(const ZScores& scores) {
  EXPECT_GT(scores.count, 500);
  // Of pixels with that much to see, so many may miss it; how many others are rightly unanimous says nothing.
  EXPECT_LE(scores.beyond_limit, 0.05 * scores.at_risk);
  EXPECT_LT(scores.worst, kCorrectedQuantile);
  EXPECT_GT(scores.rms(), 0.8);
  EXPECT_LT(scores.rms(), 1.25);
}

using filters::Kernel;
using filters::Reconstruction;

// Ray-traced visibility against closed forms, by z-tests: the truth that filters are scored against is itself checked.

constexpr double kOccluderHeight = 2.0;
constexpr double kLightHeight = 10.0;

/// What a light of an area shows of receivers behind meshes, against what it should.
ZScores score_area(const std::vector<OccluderMesh>& meshes, const AreaLight& light, const ReceiverImage& image,
                   const std::function<double(const glm::dvec3&)>& exact) {
  const Occluders occluders(meshes);
  return score_seeds([&](std::uint32_t seed) { return trace_area(occluders, image, light, {.seed = seed}); }, image,
                     exact);
}

/// The share of a disk of radius 1 that lies beyond a chord at this distance from its centre.
double beyond_chord(double distance) {
  const double t = std::clamp(distance, -1.0, 1.0);
  return (std::acos(t) - t * std::sqrt(1.0 - t * t)) / std::numbers::pi;
}

/// A disk light of radius 1, whose centre is above x = 0.
const AreaLight kDisk = AreaLight::make_disk({0.0, kLightHeight, 0.0}, {0.0, -1.0, 0.0}, 1.0);

/// What a half-plane that fills x < 0 leaves of it.
double half_plane_over_disk(double x) { return beyond_chord(x * (1.0 - kLightHeight / kOccluderHeight)); }

TEST(AreaTruth, HalfPlaneOverDisk_FollowsTheClosedForm) {
  // The edge's shadow is centred at x = 0 for every row.
  expect_agreement(score_area(make_half_plane(kOccluderHeight), kDisk, make_line(-0.35, 0.35, 240),
                              [](const glm::dvec3& p) { return half_plane_over_disk(p.x); }));
}

TEST(AreaTruth, HalfPlaneOverRectangle_IsALinearRamp) {
  const AreaLight light = AreaLight::make_rectangle({0.0, kLightHeight, 0.0}, {0.7, 0.0, 0.0}, {0.0, 0.0, 0.5});
  const double width = 1.4 * kOccluderHeight / (kLightHeight - kOccluderHeight);
  expect_agreement(score_area(make_half_plane(kOccluderHeight), light, make_line(-0.25, 0.25, 240),
                              [&](const glm::dvec3& p) { return std::clamp(0.5 + p.x / width, 0.0, 1.0); }));
}

TEST(AreaTruth, Slit_AddsUp) {
  // Edges at -0.1 and 0.1: what one half-plane lets through and the other lets through, less one.
  const std::vector<OccluderMesh> slit = {make_sheet(-40.0, -0.1, -40.0, 40.0, kOccluderHeight),
                                          make_sheet(0.1, 40.0, -40.0, 40.0, kOccluderHeight)};
  // An edge at e shifts the shadow's centre to e H / (H - h) on the ground below a light above x = 0.
  const double shift = 0.1 * kLightHeight / (kLightHeight - kOccluderHeight);
  expect_agreement(score_area(slit, kDisk, make_line(-0.45, 0.45, 240), [&](const glm::dvec3& p) {
    return std::max(0.0, half_plane_over_disk(p.x + shift) + half_plane_over_disk(shift - p.x) - 1.0);
  }));
}

/// Bars that cut the light into strips: many edges, so that a pixel traces much before it stops. A standard error with
/// 15 degrees of freedom lets z deviate by sqrt(15/13) = 1.074. Were it also what decides when a pixel stops, it would
/// be kept where it is small by chance: z then deviates by 1.09 here, and the errors are 7 % larger than stated.
TEST(AreaTruth, Comb_StatesItsStandardErrorsRight) {
  constexpr double kPeriod = 0.14, kBar = 0.06;
  constexpr int kBars = 40;
  std::vector<OccluderMesh> comb;
  for (int i = -kBars; i <= kBars; ++i)
    comb.push_back(make_sheet(i * kPeriod, i * kPeriod + kBar, -40.0, 40.0, kOccluderHeight));
  const double scale = kLightHeight / (kLightHeight - kOccluderHeight);
  const ZScores scores = score_area(comb, kDisk, make_line(-0.35, 0.35, 240), [&](const glm::dvec3& p) {
    double lit = 1.0;
    for (int i = -kBars; i <= kBars; ++i) {
      const double left = i * kPeriod * scale, right = (i * kPeriod + kBar) * scale;
      lit -= half_plane_over_disk(p.x - left) - half_plane_over_disk(p.x - right);
    }
    return lit;
  });
  expect_agreement(scores);
  EXPECT_NEAR(scores.rms(), std::sqrt(15.0 / 13.0), 0.05);
  EXPECT_NEAR(scores.understatement(), 1.0, 0.04);
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
  // Seen from the ground, the occluder covers a disk of radius r H/h around p + (c - p) H/h in the light's plane.
  const double scale = kLightHeight / kOccluderHeight;
  expect_agreement(
      score_area({make_disk_sheet(0.3, kOccluderHeight)}, kDisk, make_line(-0.7, 0.7, 240), [&](const glm::dvec3& p) {
        const double distance = std::hypot(p.x, p.z) * std::abs(1.0 - scale);
        return 1.0 - lens_area(1.0, 0.3 * scale, distance) / std::numbers::pi;
      }));
}

TEST(AreaTruth, SunOverHalfPlane_FollowsTheClosedForm) {
  const double radius = kOccluderHeight * std::tan(glm::radians(1.5));
  expect_agreement(score_area(make_half_plane(kOccluderHeight), AreaLight::make_sun({0.0, 1.0, 0.0}, 3.0),
                              make_line(-0.06, 0.06, 240),
                              [&](const glm::dvec3& p) { return beyond_chord(-p.x / radius); }));
}

TEST(AreaTruth, SphereOnItsAxis_CoversADisk) {
  // Receivers on the axis from the sphere to the light's centre, from far below, where the light is wider than the
  // sphere, to where it is wholly covered. Off the axis the sphere's projection is an ellipse.
  constexpr double kRadius = 0.5, kCentre = 6.0;
  ReceiverImage image{120, 8, {}};
  for (int i = 0; i < 120 * 8; ++i)
    image.points.push_back({{0.0f, 4.0f - 0.03f * static_cast<float>(i), 0.0f}, {0.0f, 1.0f, 0.0f}, true});
  expect_agreement(score_area({make_sphere({0.0, kCentre, 0.0}, kRadius)}, kDisk, image, [](const glm::dvec3& p) {
    const double tangent = std::tan(std::asin(kRadius / (kCentre - p.y)));
    return 1.0 - std::min(1.0, std::pow((kLightHeight - p.y) * tangent, 2.0));
  }));
}

// Ray-traced visibility of a sphere that shines: shares of the solid angle that it fills, and where its rays end.

/// The share of a cone of directions that lies above a plane through its apex; angles in radians, that of the axis to
/// the plane positive above it. The boundary is an arc of psi in azimuth, whose geodesic curvature adds up to
/// psi cos(half), and an arc of a great circle; they meet at two corners of interior angle gamma. By Gauss and Bonnet
/// the area is 2 gamma - psi cos(half), of all the cone's 2 pi (1 - cos(half)).
double cone_above_plane(double half, double axis_to_plane) {
  if (std::abs(axis_to_plane) >= half) return axis_to_plane > 0.0 ? 1.0 : 0.0;
  const double gamma = std::acos(-std::sin(axis_to_plane) / std::sin(half));
  const double psi = 2.0 * std::acos(-std::tan(axis_to_plane) / std::tan(half));
  return (2.0 * gamma - psi * std::cos(half)) / (2.0 * std::numbers::pi * (1.0 - std::cos(half)));
}

/// The share of a sphere above a plane through `p` with this normal.
double sphere_above_plane(const glm::dvec3& centre, double radius, const glm::dvec3& p, const glm::dvec3& normal) {
  const glm::dvec3 way = centre - p;
  const double distance = glm::length(way);
  return cone_above_plane(std::asin(radius / distance), std::asin(glm::dot(way, glm::normalize(normal)) / distance));
}

TEST(ClosedForm, ConeAbovePlane_HasItsLimits) {
  for (const double half : {0.01, 0.3, 1.0, 1.5}) {
    EXPECT_NEAR(cone_above_plane(half, 0.0), 0.5, 1e-9);
    EXPECT_NEAR(cone_above_plane(half, half * (1.0 - 1e-9)), 1.0, 1e-6);
    EXPECT_NEAR(cone_above_plane(half, 0.4 * half) + cone_above_plane(half, -0.4 * half), 1.0, 1e-9);
  }
  // Of a hemisphere a plane cuts off a lune, of a narrow cone what a chord cuts off its disk.
  EXPECT_NEAR(cone_above_plane(0.5 * std::numbers::pi, 0.3), 0.5 + 0.3 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(cone_above_plane(1e-3, 0.4e-3), beyond_chord(-0.4), 1e-6);
}

/// A half-plane that fills x < 0, under a sphere over its edge. A wide sphere tells solid angles from the areas of a
/// disk, a narrow one is seen as a disk.
TEST(SphereTruth, OverHalfPlane_FollowsTheClosedForm) {
  struct Case {
    double radius, light_height, edge_height, reach;
  };
  for (const Case& c : {Case{1.0, 10.0, 2.0, 0.35}, Case{2.5, 4.0, 1.0, 1.2}, Case{3.6, 4.0, 0.2, 0.6}}) {
    const glm::dvec3 centre(0.0, c.light_height, 0.0);
    // The plane through a receiver and the edge: the edge runs along z.
    expect_agreement(score_area(make_half_plane(c.edge_height), AreaLight::make_sphere(centre, c.radius),
                                make_line(-c.reach, c.reach, 240), [&](const glm::dvec3& p) {
                                  return sphere_above_plane(centre, c.radius, p, {c.edge_height, p.x, 0.0});
                                }));
  }
}

TEST(SphereTruth, ItsPartBelowTheReceiversPlane_IsBlocked) {
  const glm::dvec3 centre(0.0, 0.3, 0.0);
  expect_agreement(
      score_area({}, AreaLight::make_sphere(centre, 1.0), make_line(1.0, 3.0, 240), [&](const glm::dvec3& p) {
        return sphere_above_plane(centre, 1.0, p, {0.0, 1.0, 0.0});
      }));
}

TEST(SphereTruth, OfASmallSphere_IsThatOfAFacingDisk) {
  constexpr double kRadius = 0.2, kCentre = 10.0, kEdge = 2.0, kPenumbra = kRadius * kEdge / (kCentre - kEdge);
  expect_agreement(score_area(make_half_plane(kEdge), AreaLight::make_sphere({0.0, kCentre, 0.0}, kRadius),
                              make_line(-1.2 * kPenumbra, 1.2 * kPenumbra, 240),
                              [&](const glm::dvec3& p) { return beyond_chord(-p.x / kPenumbra); }));
}

TEST(SphereTruth, IsAllOrNothing_AwayFromTheEdge_AndHalfOnIt) {
  const Occluders occluders(make_half_plane(1.0));
  const AreaLight light = AreaLight::make_sphere({0.0, 4.0, 0.0}, 2.5);
  ReceiverImage image{3, 64, {}};
  for (int i = 0; i < 3 * 64; ++i)
    image.points.push_back(
        {{2.0f * static_cast<float>(i % 3 - 1), 0.0f, 0.05f * static_cast<float>(i / 3)}, {0.0f, 1.0f, 0.0f}, true});
  const TracedVisibility truth = trace_area(occluders, image, light, {});
  double sum = 0.0;
  for (std::size_t i = 0; i < image.points.size(); i += 3) {
    EXPECT_EQ(truth.visibility[i], 0.0f);
    EXPECT_NEAR(truth.visibility[i + 1], 0.5, 8.0 * static_cast<double>(truth.standard_error[i + 1]));
    EXPECT_EQ(truth.visibility[i + 2], 1.0f);
    sum += static_cast<double>(truth.visibility[i + 1]);
  }
  EXPECT_NEAR(sum / 64.0, 0.5, 0.003);
}

/// Spheres of triangles around the light's own centre, just within its surface and just outside.
TEST(SphereTruth, RaysEndAtItsSurface) {
  const glm::dvec3 centre(0.5, 4.0, 0.0);
  const ReceiverImage image = make_line(-6.0, 6.0, 64);
  const AreaLight light = AreaLight::make_sphere(centre, 2.0);
  const Occluders within(std::vector<OccluderMesh>{make_sphere(centre, 1.999)}),
      around(std::vector<OccluderMesh>{make_sphere(centre, 2.001)});
  for (const float v : trace_area(within, image, light, {}).visibility) ASSERT_EQ(v, 1.0f);
  for (const float v : trace_area(around, image, light, {}).visibility) ASSERT_EQ(v, 0.0f);
}

TEST(SphereTruth, OfRadiusZero_IsTheHardShadow) {
  const Occluders occluders(make_half_plane(1.0));
  const AreaLight light = AreaLight::make_sphere({0.3, 4.0, 0.1}, 0.0);
  const ReceiverImage image = make_line(-1.0, 1.0, 64);
  EXPECT_EQ(trace_area(occluders, image, light, {}).visibility, trace_hard(occluders, image, light));
  const AreaLight large = AreaLight::make_sphere({0.3, 4.0, 0.1}, 2.0);
  EXPECT_EQ(trace_hard(occluders, image, large), trace_hard(occluders, image, light)) << "to the centre";
}

/// A floor through the sphere, its centre included, with a ceiling close above it.
TEST(SphereTruth, AReceiverInside_SeesAllOfIt) {
  const Occluders occluders(std::vector<OccluderMesh>{make_sheet(-40.0, 40.0, -40.0, 40.0, 0.01)});
  for (const double centre_height : {0.0, 0.5, -0.5}) {
    const AreaLight light = AreaLight::make_sphere({0.0, centre_height, 0.0}, 1.0);
    ReceiverImage image = make_line(-2.0, 2.0, 257, 1);
    image.points.push_back({{0.0f, static_cast<float>(centre_height), 0.0f}, {0.0f, 1.0f, 0.0f}, true});
    image.width = 258;
    const TracedVisibility truth = trace_area(occluders, image, light, {});
    for (std::size_t i = 0; i < image.points.size(); ++i) {
      const double distance = glm::distance(glm::dvec3(image.points[i].position_ws), {0.0, centre_height, 0.0});
      if (distance < 0.999) ASSERT_EQ(truth.visibility[i], 1.0f) << distance;
      ASSERT_TRUE(truth.visibility[i] >= 0.0f && truth.visibility[i] <= 1.0f) << distance;
      ASSERT_TRUE(std::isfinite(truth.standard_error[i])) << distance;
    }
  }
}

/// A hair outside the surface the sphere fills half of all directions.
TEST(SphereTruth, AReceiverNearItsSurface_IsLit) {
  const Occluders occluders(std::vector<OccluderMesh>{make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0)});
  const AreaLight light = AreaLight::make_sphere({0.0, 1.0, 0.0}, 1.0);
  ReceiverImage image{64, 1, {}};
  for (int i = 0; i < 64; ++i)
    image.points.push_back({{0.0f, -std::exp2(-static_cast<float>(i)), 0.0f}, {0.0f, 1.0f, 0.0f}, true});
  for (const float v : trace_area(occluders, image, light, {}).visibility) ASSERT_EQ(v, 1.0f);
}

// Ray-traced kernels against closed forms: an edge in front of a slanted light shows the kernel's own distribution.

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

const Kernel kTent = Kernel::make_point(Reconstruction::kBilinear);

/// Expects what a kernel in a map shows of receivers on a floor, under a sheet that ends at an edge.
void expect_kernel(const Kernel& kernel, const MapGrid& grid, const ReceiverImage& image,
                   const std::function<double(const glm::dvec3&)>& exact, double sheet_edge = 0.0) {
  const Occluders occluders(std::vector<OccluderMesh>{make_sheet(-40.0, sheet_edge, -40.0, 40.0, kHeight),
                                                      make_sheet(-40.0, 40.0, -40.0, 40.0, 0.0)});
  expect_agreement(score_seeds(
      [&](std::uint32_t seed) { return trace_kernel(occluders, image, kernel, grid, {.seed = seed}); }, image, exact));
}

/// The same in the tilted map, from the distance to the edge in texels.
void expect_kernel(const Kernel& kernel, const std::function<double(double)>& exact) {
  expect_kernel(
      kernel, tilted_grid(), make_receivers(0.9 * kernel.half_width()),
      [&](const glm::dvec3& p) { return exact(texels_from_edge(p)); });
}

TEST(KernelTruth, OfATent) { expect_kernel(kTent, tent_below); }

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
  const double edge = kSheetEdge * kLampHeight / (kLampHeight - kHeight), texel = kTexel * kLampHeight / kReference;
  const MapGrid grid{
      {0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, kTexel, MapGrid::Lamp{{0.0, kLampHeight, 0.0}, kReference}};
  expect_kernel(
      kTent, grid, make_line(edge - 0.9 * texel, edge + 0.9 * texel, 160, 8),
      [&](const glm::dvec3& p) { return tent_below((p.x - edge) / texel); }, kSheetEdge);
}

/// Texels that are sheared, and grow along z: a step along v goes half a texel back along u.
TEST(KernelTruth, OfATent_InAWarpedMap) {
  MapGrid grid = tilted_grid();
  const auto texel_at = [](const glm::dvec3& p) { return kTexel * (1.0 + 0.2 * p.z); };
  grid.curved = MapGrid::Curved{[&texel_at, right = grid.right, up = grid.up](const glm::dvec3& p) {
                                  return TexelGradients{(right + 0.5 * up) / texel_at(p), up / texel_at(p)};
                                },
                                "sheared"};
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
  expect_kernel(kTent, grid, make_receivers(1.0), exact);
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
  const Occluders occluders(make_half_plane(kHeight));
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
  const Occluders occluders(make_half_plane(kHeight));
  const ReceiverImage image = make_receivers(1.5);
  const std::vector<float> radii(image.points.size(), 0.0f);
  EXPECT_EQ(trace_disks(occluders, image, radii, tilted_grid(), {}).visibility,
            trace_kernel(occluders, image, Kernel::make_disk(0.0), tilted_grid(), {}).visibility);
}

TEST(KernelTruth, OfAPoint_IsTheHardShadow) {
  const Occluders occluders(make_half_plane(kHeight));
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
    const Occluders occluders(std::vector<OccluderMesh>{make_sheet(-5.0, 5.0, -5.0, 5.0, 0.1, 40)});
    ReceiverImage image = make_line(-4.0, 4.0, 200);
    for (ReceiverPoint& point : image.points) point.position_ws.y = 0.1f;
    for (const float v : trace_kernel(occluders, image, Kernel::make_disk(16.0), grid, {}).visibility)
      ASSERT_EQ(v, 1.0f) << tilt;
  }
}

TEST(KernelTruth, IsAsWideAsTheTexelsAre) {
  MapGrid grid = tilted_grid();
  grid.texel_size_ws = 3.0 * kTexel;
  expect_kernel(kTent, grid, make_receivers(2.7),
                [](const glm::dvec3& p) { return tent_below(texels_from_edge(p) / 3.0); });
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
  const Occluders occluders(make_half_plane(kHeight));
  const ReceiverImage image = make_receivers(2.5);
  expect_agreement(score_seeds(
      [&](std::uint32_t seed) { return trace_square(occluders, image, 2.5, tilted_grid(), {.seed = seed}); }, image,
      [](const glm::dvec3& p) { return std::clamp(0.5 + texels_from_edge(p) / 5.0, 0.0, 1.0); }));
}

TEST(SquareTruth, OfFirstPointsAlone_SettlesThePixelsThatMoreOfThemSettle) {
  const Occluders occluders(make_half_plane(kHeight));
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
  const Occluders occluders(make_half_plane(kHeight));
  const ReceiverImage image = make_receivers(0.9 * kTent.half_width());
  const std::vector<std::uint8_t> mask(image.points.size(), 1);
  std::vector<float> shifted;
  for (const ReceiverPoint& point : image.points)
    shifted.push_back(static_cast<float>(tent_below(texels_from_edge(glm::dvec3(point.position_ws)) + 0.01)));
  MeanSquares squares;
  constexpr int kSeeds = 64;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const TracedVisibility traced =
        trace_kernel(occluders, image, kTent, tilted_grid(), {.standard_error = standard_error, .seed = seed});
    const double plain = metrics::measure_error(shifted, traced.visibility, mask)->rmse;
    const double unbiased = metrics::measure_error(shifted, traced.visibility, mask, traced.variance)->rmse;
    squares.plain += plain * plain / kSeeds;
    squares.unbiased += unbiased * unbiased / kSeeds;
  }
  return squares;
}

TEST(KernelTruth, MeanSquaresWithoutItsVariance_AreThoseOfAFinerTruth) {
  const MeanSquares rough = measure_squares(0.01), fine = measure_squares(0.0025);
  const double bias = rough.plain - fine.unbiased;
  EXPECT_GT(bias, 0.2 * fine.unbiased) << "what sampling adds is seen";
  EXPECT_NEAR(rough.unbiased, fine.unbiased, 0.1 * bias);
}

}  // namespace
}  // namespace shadowbench::truth
