#include "reference/truth/visibility.h"

#include <tbb/global_control.h>
#include <unistd.h>

#include <new>

#include "reference/truth/occluders.h"
#include "tests/reference/truth/shapes.h"
#include "tests/test_files.h"

namespace shadowbench::truth {
namespace {

// What tracing does besides following closed forms: order, threads, offsets, holes, odd lights.

/// Ends the process by exit code 0 where occluders that memory is too small for are refused.
[[noreturn]] void build_in_little_memory() {
  OccluderMesh mesh = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, 4);
  mesh.positions.resize(20'000'000);
  long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit limit{};
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (rlim_t{100} << 20);
  setrlimit(RLIMIT_AS, &limit);
  try {
    const Occluders occluders(std::span<const OccluderMesh>(&mesh, 1));
  } catch (const std::bad_alloc&) {
    _exit(0);
  }
  _exit(1);
}

// What Embree has no room for must not become a scene that rays miss. In a process of its own, which the limit ends
// with.
TEST(OccludersDeathTest, MemoryThatIsTooSmall_IsBadAlloc) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "address sanitizer needs more memory than a limit leaves";
#endif
  EXPECT_EXIT(build_in_little_memory(), ::testing::ExitedWithCode(0), "");
}

TEST(AreaTruth, DoesNotDependOnThreads) {
  const Occluders occluders(make_half_plane(2.0));
  const AreaLight light = AreaLight::make_sun({0.0, 1.0, 0.0}, 3.0);
  const ReceiverImage image = make_line(-0.06, 0.06, 100);
  const TracedVisibility many = trace_area(occluders, image, light, {});
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(trace_area(occluders, image, light, {}).visibility, many.visibility);
}

TEST(AreaTruth, DoesNotDependOnTheOrderOfPixels) {
  // A pixel's random numbers follow its place in the image; its truth does not.
  const Occluders occluders(make_half_plane(2.0));
  const AreaLight light = AreaLight::make_sun({0.0, 1.0, 0.0}, 3.0);
  const ReceiverImage image = make_line(-0.06, 0.06, 100);
  ReceiverImage reversed = image;
  std::reverse(reversed.points.begin(), reversed.points.end());
  const TracedVisibility forth = trace_area(occluders, image, light, {}),
                         back = trace_area(occluders, reversed, light, {});
  const std::size_t last = image.points.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double error = static_cast<double>(std::hypot(forth.standard_error[i], back.standard_error[last - i]));
    ASSERT_LE(std::abs(forth.visibility[i] - back.visibility[last - i]), 8.0 * error + 3.0 / 64.0 * (error == 0.0))
        << i;
  }
}

TEST(AreaTruth, SettledPixels_GetFewRays_WhateverDoesNotCountBesideThem) {
  const Occluders occluders(make_half_plane(2.0));
  ReceiverImage image = make_line(-1.0, 1.0, 64);
  for (std::size_t i = 0; i < image.points.size(); i += 4) image.points[i].counts = false;
  const TracedVisibility truth = trace_area(occluders, image, AreaLight::make_sun({0.0, 1.0, 0.0}, 0.1), {});
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    const bool at_edge = i % 64 >= 30 && i % 64 < 34;
    ASSERT_EQ(truth.visibility[i], image.points[i].counts && i % 64 < 32 ? 0.0f : 1.0f) << i;
    ASSERT_EQ(truth.unanimous[i], 1) << i;
    ASSERT_EQ(truth.standard_error[i], 0.0f) << i;
    const std::uint32_t few = image.points[i].counts ? kRaysOfSettledPixel : 0u;
    ASSERT_TRUE(at_edge || truth.rays[i] == few) << i << ": " << truth.rays[i];
  }
}

TEST(AreaTruth, LightBelowTheReceiversPlane_IsBlocked) {
  // A sun on the horizon: the plane cuts its disk in two, and nothing else is there.
  const Occluders nothing(std::vector<OccluderMesh>{});
  const ReceiverImage image = make_line(-1.0, 1.0, 16);
  const TracedVisibility truth = trace_area(nothing, image, AreaLight::make_sun({1.0, 1e-9, 0.0}, 3.0), {});
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    ASSERT_NEAR(truth.visibility[i], 0.5, 8.0 * static_cast<double>(truth.standard_error[i])) << i;
    ASSERT_FALSE(truth.unanimous[i]);
  }
}

/// A floor seen by a sun through a sheet of this cut-out.
std::vector<float> trace_through(const CutOut& cut_out) {
  OccluderMesh sheet = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, 4);
  sheet.cut_out = cut_out;
  for (const glm::vec3& p : sheet.positions) sheet.cut_out->uvs.emplace_back(0.5f * (p.x + 1.0f), 0.5f * (p.z + 1.0f));
  const Occluders occluders(std::vector<OccluderMesh>{sheet});
  return trace_hard(occluders, make_line(-0.99, 0.99, 400, 1), AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0));
}

TEST(CutOut, RaysPassWhereTheTextureIsTransparent) {
  // Two texels side by side: bilinear alpha crosses the cutoff half-way between their centres.
  const std::vector<float> lit = trace_through({{}, 2, 1, {255, 0}, 1.0f, 0.5f});
  for (std::size_t i = 0; i < lit.size(); ++i) {
    const double u = (static_cast<double>(i) + 0.5) / 400.0 * 0.99 + 0.005;
    if (std::abs(u - 0.5) < 0.01 || u < 0.01 || u > 0.99) continue;  // the texture repeats: its other edge
    ASSERT_EQ(lit[i], u < 0.5 ? 0.0f : 1.0f) << u;
  }
}

TEST(CutOut, TheFirstRowIsAtVZero_AndTheTextureRepeatsBothWays) {
  // Four columns and two rows; all opaque but the second column of the first row.
  HoleTest test{{{}, 4, 2, {255, 0, 255, 255, 255, 255, 255, 255}, 1.0f, 0.5f}, {0, 1, 2}};
  for (const int shift : {-3, 0, 2}) {
    const glm::vec2 corner(0.375f + static_cast<float>(shift), 0.25f + static_cast<float>(shift));
    test.cut_out.uvs = {corner, corner + glm::vec2(0.25f, 0.0f), corner + glm::vec2(0.0f, 0.5f)};
    EXPECT_TRUE(test.is_hole(0, 0.0f, 0.0f)) << shift;
    EXPECT_FALSE(test.is_hole(0, 1.0f, 0.0f)) << shift << ": the next column";
    EXPECT_FALSE(test.is_hole(0, 0.0f, 1.0f)) << shift << ": the other row";
  }
}

TEST(CutOut, BaseAlphaIsAFactor_AndCutoffTheLimit) {
  EXPECT_EQ(trace_through({{}, 0, 0, {}, 0.4f, 0.5f})[100], 1.0f);
  EXPECT_EQ(trace_through({{}, 0, 0, {}, 0.6f, 0.5f})[100], 0.0f);
  EXPECT_EQ(trace_through({{}, 1, 1, {153}, 0.8f, 0.5f})[100], 1.0f) << "0.6 * 0.8 = 0.48";
  EXPECT_EQ(trace_through({{}, 1, 1, {153}, 0.8f, 0.4f})[100], 0.0f);
}

TEST(CutOut, HolesLetLightReachTheNextSurface) {
  OccluderMesh open = make_sheet(-1.0, 1.0, -1.0, 1.0, 2.0, 4);
  open.cut_out = CutOut{std::vector<glm::vec2>(open.positions.size()), 0, 0, {}, 0.0f, 0.5f};
  const Occluders occluders(std::vector<OccluderMesh>{open, make_sheet(-1.0, 0.0, -1.0, 1.0, 1.0, 4)});
  const std::vector<float> distances =
      trace_first_blockers(occluders, make_line(-0.9, 0.9, 10, 1), AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0));
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(distances[i], 1.0f, 1e-5f);
  for (std::size_t i = 5; i < 10; ++i) EXPECT_EQ(distances[i], std::numeric_limits<float>::infinity());
}

TEST(FirstBlockers, GiveTheSurfaceThatLightMeetsFirst) {
  const Occluders occluders(
      std::vector<OccluderMesh>{make_sheet(-5.0, 5.0, -5.0, 5.0, 0.5), make_sheet(-1.0, 1.0, -5.0, 5.0, 2.0)});
  const std::vector<float> distances =
      trace_first_blockers(occluders, make_line(-3.0, 3.0, 60, 1), AreaLight::make_sun({0.0, 2.0, 0.0}, 0.0));
  for (std::size_t i = 0; i < 60; ++i) EXPECT_NEAR(distances[i], i < 20 || i >= 40 ? 0.5f : 2.0f, 1e-5f) << i;
}

TEST(FirstBlockers, OfALamp_LieBetweenItAndTheReceiver) {
  const Occluders occluders(
      std::vector<OccluderMesh>{make_sheet(-0.5, 0.5, -5.0, 5.0, 2.0), make_sheet(-5.0, 5.0, -5.0, 5.0, 3.5)});
  const ReceiverImage image = make_line(-3.0, 3.0, 60, 1);
  const auto lamp = AreaLight::make_disk({0.0, 3.0, 0.0}, {0.0, -1.0, 0.0}, 0.1);
  const std::vector<float> distances = trace_first_blockers(occluders, image, lamp);
  for (std::size_t i = 0; i < 60; ++i) {
    const float x = image.points[i].position_ws.x, way = std::hypot(x, 3.0f);
    const bool is_below = std::abs(x) < 1.5f;
    if (is_below) EXPECT_NEAR(distances[i], way * 2.0f / 3.0f, 0.01f) << x;
    if (!is_below)
      EXPECT_EQ(distances[i], std::numeric_limits<float>::infinity()) << x << ": the other is above the lamp";
  }
}

TEST(Occluders, CountTrianglesAndBounds_WithoutTheDegenerate) {
  OccluderMesh mesh = make_sheet(-1.0, 2.0, -3.0, 4.0, 0.5, 3);
  mesh.indices.insert(mesh.indices.end(), {0, 0, 1, 2, 2, 2});
  const Occluders occluders(std::vector<OccluderMesh>{mesh});
  EXPECT_EQ(occluders.triangle_count(), 18);
  EXPECT_EQ(occluders.bounds().min, glm::vec3(-1.0f, 0.5f, -3.0f));
  EXPECT_EQ(occluders.bounds().max, glm::vec3(2.0f, 0.5f, 4.0f));
}

TEST(OddLights, GiveFiniteVisibility) {
  const Occluders box(std::vector<OccluderMesh>{make_sphere({0.0, 10.0, 0.0}, 2.0, 64)});
  const ReceiverImage image = make_line(-1.0, 1.0, 16, 1);
  const auto inside = AreaLight::make_disk({0.0, 10.0, 0.0}, {0.0, -1.0, 0.0}, 1.0);
  for (const float v : trace_area(box, image, inside, {}).visibility) EXPECT_EQ(v, 0.0f) << "a light inside geometry";
  const auto below = AreaLight::make_disk({0.0, -10.0, 0.0}, {0.0, -1.0, 0.0}, 1.0);
  for (const float v : trace_area(box, image, below, {}).visibility) EXPECT_EQ(v, 0.0f) << "a light below the horizon";
  const Occluders nothing(std::vector<OccluderMesh>{});
  for (const float v : trace_area(nothing, image, inside, {}).visibility) EXPECT_EQ(v, 1.0f) << "an empty scene";
}

TEST(HardTruth, OfAPointLight_IsAStep) {
  const Occluders occluders(make_half_plane(2.0));
  const AreaLight light = AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0);
  const ReceiverImage image = make_line(-1.0, 1.0, 64);
  const std::vector<float> visibility = trace_hard(occluders, image, light);
  for (int x = 0; x < 64; ++x) EXPECT_EQ(visibility[static_cast<std::size_t>(x)], x < 32 ? 0.0f : 1.0f);
  EXPECT_EQ(trace_area(occluders, image, light, {}).visibility, visibility) << "size 0 is a hard shadow";
}

TEST(Occluders, APlaneAtCoordinateZero_DoesNotShadowItself) {
  for (const double elevation : {90.0, 60.0, 5.0}) {
    const Occluders occluders(std::vector<OccluderMesh>{make_sheet(-5.0, 5.0, -5.0, 5.0, 0.0, 20)});
    const double angle = glm::radians(elevation);
    const AreaLight light = AreaLight::make_sun({std::cos(angle), std::sin(angle), 0.0}, 0.53);
    for (const float v : trace_hard(occluders, make_line(-4.0, 4.0, 200), light)) ASSERT_EQ(v, 1.0f) << elevation;
  }
}

TEST(Occluders, ReceiversNearTheOriginOfALargeScene_DoNotHitTheirOwnSurface) {
  // Interpolation mixes the corners' coordinates: a point at the origin carries the roundings of a kilometre.
  const glm::vec3 normal = glm::normalize(glm::vec3(-0.37f, 1.0f, 0.21f));
  OccluderMesh plane = make_sheet(-1000.0, 1000.0, -1000.0, 1000.0, 0.0, 8);
  for (glm::vec3& p : plane.positions) p.y = 0.37f * p.x - 0.21f * p.z;
  const Occluders occluders(std::vector<OccluderMesh>{plane});
  ReceiverImage image = make_line(-1.0, 1.0, 200);
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    ReceiverPoint& point = image.points[i];
    point.position_ws.y = 0.37f * point.position_ws.x - 0.21f * point.position_ws.z;
    point.position_ws -= static_cast<float>(i % 5) * 1000.0f * 0x1p-24f * normal;
    point.normal_ws = normal;
  }
  for (const float v : trace_hard(occluders, image, AreaLight::make_sun({0.1, 1.0, 0.3}, 0.0))) ASSERT_EQ(v, 1.0f);
}

TEST(Occluders, NeitherSelfHitsNorLeaks_AtAnyScale) {
  for (const double scale : {1e-3, 1.0, 1e3, 1e6}) {
    // A tilted floor with a roof over half of it, away from the origin.
    std::vector<OccluderMesh> meshes = {make_sheet(-1.0, 1.0, -1.0, 1.0, 0.0, 16),
                                        make_sheet(-1.0, 0.0, -1.0, 1.0, 0.01, 16)};
    const auto place = [&](const glm::dvec3& p) { return glm::vec3(scale * (p + glm::dvec3(3.0, 0.37 * p.x, -7.0))); };
    for (OccluderMesh& mesh : meshes)
      for (glm::vec3& p : mesh.positions) p = place(glm::dvec3(p));
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

// The share of the unshadowed light that arrives, against integrals of it on a grid.

constexpr double kLampHeight = 3.0, kEdgeHeight = 2.0;

/// Whether a ray from a point of the floor passes the edge of the sheet, which is dark below x = 0.
bool passes(const glm::dvec3& from, const glm::dvec3& way) { return from.x + way.x * kEdgeHeight / way.y > 0.0; }

/// What arrives and what was sent, summed over the cells of a grid.
struct Sum {
  double sent = 0.0;
  double arrived = 0.0;

  void add(const ReceiverPoint& point, const glm::dvec3& way, double weight) {
    const double cosine = glm::dot(glm::normalize(way), glm::dvec3(point.normal_ws));
    if (cosine <= 0.0) return;
    sent += cosine * weight;
    arrived += passes(point.position_ws, way) ? cosine * weight : 0.0;
  }
};

double integrate_rectangle(const ReceiverPoint& point, double half_x, double half_z) {
  constexpr int kSteps = 20000, kStepsAlong = 50;  // across the edge it takes many
  Sum sum;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kStepsAlong; ++j) {
      const glm::dvec3 at(half_x * ((2.0 * i + 1.0) / kSteps - 1.0), kLampHeight,
                          half_z * ((2.0 * j + 1.0) / kStepsAlong - 1.0));
      const glm::dvec3 way = at - glm::dvec3(point.position_ws);
      sum.add(point, way, std::abs(way.y) / glm::length(way) / glm::dot(way, way));
    }
  }
  return sum.arrived / sum.sent;
}

double integrate_sphere(const ReceiverPoint& point, double radius) {
  constexpr int kSteps = 1500;
  const glm::dvec3 to_centre = glm::dvec3(0.0, kLampHeight, 0.0) - glm::dvec3(point.position_ws);
  const glm::dvec3 axis = glm::normalize(to_centre), u = glm::normalize(glm::cross(axis, glm::dvec3(0, 0, 1))),
                   v = glm::cross(axis, u);
  const double sine = radius / glm::length(to_centre), cap = 1.0 - std::sqrt(1.0 - sine * sine);
  Sum sum;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double cosine = 1.0 - cap * (i + 0.5) / kSteps, turn = 2.0 * std::numbers::pi * (j + 0.5) / kSteps;
      const double across = std::sqrt(1.0 - cosine * cosine);
      sum.add(point, cosine * axis + across * (std::cos(turn) * u + std::sin(turn) * v), 1.0);
    }
  }
  return sum.arrived / sum.sent;
}

/// Traces one pixel that is repeated, so that errors can be held against their own standard errors.
void expect_ratio(const AreaLight& light, const ReceiverPoint& point,
                  const std::function<double(const ReceiverPoint&)>& integrate) {
  const Occluders occluders(make_half_plane(kEdgeHeight));
  ReceiverImage image{16, 4, std::vector<ReceiverPoint>(64, point)};
  const TracedVisibility traced = trace_area(occluders, image, light, {.standard_error = 0.002});
  const double expected = integrate(point);
  double mean = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    mean += static_cast<double>(traced.ratio[i]) / 64.0;
    const double error = (static_cast<double>(traced.ratio[i]) - expected) / static_cast<double>(traced.ratio_error[i]);
    squares += error * error / 64.0;
  }
  EXPECT_NEAR(mean, expected, 0.002) << "x " << point.position_ws.x;
  EXPECT_LT(std::sqrt(squares), 1.6) << "errors are as large as they are said to be";
  EXPECT_GT(std::abs(mean - static_cast<double>(traced.visibility[0])), 0.01) << "or this shows nothing";
}

ReceiverPoint make_point(float x, const glm::vec3& normal) { return {{x, 0.0f, 0.0f}, glm::normalize(normal), true}; }

TEST(UnshadowedShare, OfARectangle_WeighsBothCosinesAndTheDistance) {
  const AreaLight light = AreaLight::make_rectangle({0.0, kLampHeight, 0.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, 0.4});
  for (const float x : {-1.0f, 1.5f}) {
    expect_ratio(
        light, make_point(x, {0.0f, 1.0f, 0.0f}),
        [](const auto& point) { return integrate_rectangle(point, 2.0, 0.4); });
  }
}

TEST(UnshadowedShare, OfASphere_WeighsTheReceiversCosine) {
  const AreaLight light = AreaLight::make_sphere({0.0, kLampHeight, 0.0}, 0.8);
  expect_ratio(light, make_point(0.1f, {0.95f, 0.2f, 0.0f}),
               [](const auto& point) { return integrate_sphere(point, 0.8); });
}

TEST(UnshadowedShare, LightBelowTheReceiversPlane_BringsNothing_AndIsNotMissed) {
  const Occluders nothing(std::vector<OccluderMesh>{});
  const ReceiverImage image{8, 1, std::vector<ReceiverPoint>(8, make_point(0.0f, {1.0f, 0.0f, 0.0f}))};
  const AreaLight light = AreaLight::make_rectangle({0.0, kLampHeight, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  const TracedVisibility traced = trace_area(nothing, image, light, {});
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    EXPECT_NEAR(traced.visibility[i], 0.5, 0.05) << "half of the light is below the plane";
    EXPECT_EQ(traced.ratio[i], 1.0f);
    EXPECT_EQ(traced.ratio_error[i], 0.0f);
  }
}

// Rays that surfaces dim: each crossing leaves 1 - alpha, however often it is reported.

OccluderMesh dim(OccluderMesh mesh, float alpha) {
  CutOut& pane = mesh.cut_out.emplace();
  pane.uvs.resize(mesh.positions.size());
  pane.base_alpha = alpha;
  pane.dims = true;
  return mesh;
}

OccluderMesh make_pane(double height, float alpha = 0.3f, int cells = 16) {
  return dim(make_sheet(-1.0, 1.0, -1.0, 1.0, height, cells), alpha);
}

AreaLight make_broad_sun() { return AreaLight::make_sun({0.0, 1.0, 0.0}, 4.0); }

std::vector<float> trace_hard_up(const std::vector<OccluderMesh>& meshes, const ReceiverImage& image) {
  return trace_hard(Occluders(meshes), image, AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0));
}

TEST(Transmittance, OfASheetOfAlpha03_Is07_AndOfTwo049) {
  const ReceiverImage image = make_line(-0.7, 0.7, 60);
  std::vector<OccluderMesh> panes;
  for (const double expected : {0.7, 0.49}) {
    panes.push_back(make_pane(1.0 + static_cast<double>(panes.size())));
    const Occluders occluders(panes);
    for (const float hard : trace_hard(occluders, image, make_broad_sun())) ASSERT_NEAR(hard, expected, 1e-6);
    const MapGrid grid{.texel_size_ws = 0.02};
    for (const TracedVisibility& truth : {trace_area(occluders, image, make_broad_sun(), {}),
                                          trace_kernel(occluders, image, filters::Kernel::make_disk(4.0), grid, {})}) {
      for (std::size_t i = 0; i < image.points.size(); ++i) {
        ASSERT_NEAR(truth.visibility[i], expected, 3.0 * static_cast<double>(truth.standard_error[i]) + 1e-6) << i;
        ASSERT_EQ(truth.unanimous[i], 1) << "all rays agree";
        ASSERT_EQ(truth.standard_error[i], 0.0f) << i;
        ASSERT_GE(truth.rays[i], 4 * kRaysOfSettledPixel) << "no neighbour settles what is dimmed";
      }
    }
    const TracedVisibility area = trace_area(occluders, image, make_broad_sun(), {});
    for (const float ratio : area.ratio) ASSERT_NEAR(ratio, expected, 1e-5) << "and of the light that arrives";
  }
}

TEST(Transmittance, AtAnEdge_IsOneLessThePartThatIsHeldBack) {
  const ReceiverImage image = make_line(-1.2, 1.2, 120);
  const OccluderMesh sheet = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, 16);
  const auto trace = [&](const OccluderMesh& mesh) {
    return trace_area(Occluders(std::vector<OccluderMesh>{mesh}), image, make_broad_sun(), {.standard_error = 1.0});
  };
  const TracedVisibility opaque = trace(sheet), dimmed = trace(dim(sheet, 0.3f));
  int at_edges = 0;
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    const double expected = 1.0 - 0.3 * (1.0 - static_cast<double>(opaque.visibility[i]));
    const double error =
        std::hypot(0.3 * static_cast<double>(opaque.standard_error[i]), static_cast<double>(dimmed.standard_error[i]));
    ASSERT_NEAR(dimmed.visibility[i], expected, 5.0 * error + 1e-6) << i;
    if (opaque.unanimous[i]) continue;
    ++at_edges;
    EXPECT_GT(dimmed.standard_error[i], 0.0f);
    ASSERT_EQ(dimmed.rays[i], opaque.rays[i]);
    EXPECT_NEAR(dimmed.standard_error[i], 0.3f * opaque.standard_error[i], 1e-6f) << "of rays that differ by 0.3";
  }
  EXPECT_GT(at_edges, 20);
}

// Corners and diagonals belong to several triangles, and a tree may hold a triangle in several leaves.
TEST(Transmittance, ARayThroughAnEdge_IsDimmedOnce) {
  for (const int cells : {2, 16, 64}) {
    for (const double scale : {1.0, 1e4}) {
      OccluderMesh sheet = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, cells);
      for (glm::vec3& p : sheet.positions) p = static_cast<float>(scale) * (p + glm::vec3(0.0f, 0.5f * p.x, 0.0f));
      ReceiverImage image{cells - 1, cells - 1, {}};
      for (int y = 1; y < cells; ++y)
        for (int x = 1; x < cells; ++x)
          image.points.push_back(
              {scale * glm::dvec3(2.0 * x / cells - 1.0, -1.0, 2.0 * y / cells - 1.0), {0, 1, 0}, true});
      for (const float hard : trace_hard_up({dim(sheet, 0.3f)}, image)) ASSERT_NEAR(hard, 0.7f, 1e-6f) << cells;
    }
  }
}

TEST(Transmittance, OfAClosedBody_IsThatOfBothItsSides_HoweverThin) {
  for (const double thickness : {0.1, 1e-7}) {
    OccluderMesh body = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, 4);
    OccluderMesh roof = make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0 + thickness, 4);
    const auto first = static_cast<std::uint32_t>(body.positions.size());
    body.positions.insert(body.positions.end(), roof.positions.begin(), roof.positions.end());
    for (std::size_t i = 0; i < roof.indices.size(); i += 3)  // it faces the other way
      body.indices.insert(body.indices.end(),
                          {first + roof.indices[i], first + roof.indices[i + 2], first + roof.indices[i + 1]});
    for (const float hard : trace_hard_up({dim(body, 0.3f)}, make_line(-0.9, 0.9, 50))) ASSERT_NEAR(hard, 0.49f, 1e-6f);
  }
}

TEST(Transmittance, OfManySheets_IsTheirProduct_InAnyOrder) {
  std::vector<OccluderMesh> panes;
  double expected = 1.0;
  for (int i = 0; i < 40; ++i) {
    const float alpha = 0.01f * static_cast<float>(1 + i % 5);
    panes.push_back(make_pane(1.0 + 0.1 * (i * 7 % 40), alpha, 4));
    expected *= 1.0 - static_cast<double>(alpha);
  }
  const ReceiverImage image = make_line(-0.3, 0.3, 16, 2);
  for (const float hard : trace_hard_up(panes, image)) EXPECT_NEAR(hard, expected, 1e-5);
  const TracedVisibility truth = trace_area(Occluders(panes), image, AreaLight::make_sun({0.0, 1.0, 0.0}, 0.5), {});
  for (const std::uint8_t unanimous : truth.unanimous) EXPECT_EQ(unanimous, 1) << "but for the order of factors";
}

TEST(Transmittance, ReachesBothEnds) {
  const ReceiverImage image = make_line(-0.9, 0.9, 32);
  const auto all = [&](float value) { return std::vector<float>(image.points.size(), value); };
  EXPECT_EQ(trace_hard_up({make_pane(1.0, 0.0f)}, image), all(1.0f));
  EXPECT_EQ(trace_hard_up({make_pane(1.0, 1.0f)}, image), all(0.0f));
  EXPECT_EQ(trace_hard_up({make_pane(1.0), make_sheet(-1.0, 1.0, -1.0, 1.0, 2.0, 4)}, image), all(0.0f)) << "behind it";
  OccluderMesh textured = make_pane(1.0, 1.0f);
  for (std::size_t i = 0; i < textured.positions.size(); ++i)
    textured.cut_out->uvs[i] = {0.37f * textured.positions[i].x, 0.61f * textured.positions[i].z};
  textured.cut_out->width = textured.cut_out->height = 3;
  textured.cut_out->alpha.assign(9, 255);
  EXPECT_EQ(trace_hard_up({textured}, image), all(0.0f)) << "an opaque texture, whatever its weights are rounded to";
}

TEST(Transmittance, OfATexture_IsReadAtEachPoint) {
  OccluderMesh pane = make_pane(1.0, 1.0f);
  for (std::size_t i = 0; i < pane.positions.size(); ++i)
    pane.cut_out->uvs[i] = {0.5f * (pane.positions[i].x + 1.0f), 0.5f};
  pane.cut_out->width = 2;
  pane.cut_out->height = 1;
  pane.cut_out->alpha = {51, 204};  // 0.2 and 0.8, with their centres at x = -0.5 and 0.5
  const ReceiverImage image = make_line(-0.5, 0.5, 100);
  const std::vector<float> hard = trace_hard_up({pane}, image);
  const TracedVisibility truth = trace_area(Occluders(std::vector<OccluderMesh>{pane}), image, make_broad_sun(), {});
  for (std::size_t i = 0; i < hard.size(); ++i) {
    const double x = static_cast<double>(image.points[i].position_ws.x);
    ASSERT_NEAR(hard[i], 0.5 - 0.6 * x, 1e-5) << x;
    if (std::abs(x) > 0.45) continue;  // the gradient ends within the light
    ASSERT_NEAR(truth.visibility[i], 0.5 - 0.6 * x, 4.0 * static_cast<double>(truth.standard_error[i])) << x;
    ASSERT_FALSE(truth.unanimous[i]);
  }
}

TEST(Transmittance, FirstBlockers_MeetWhatDims) {
  const std::vector<OccluderMesh> meshes = {make_pane(2.0), make_sheet(-1.0, 1.0, -1.0, 1.0, 1.0, 4)};
  for (const float distance :
       trace_first_blockers(Occluders(meshes), make_line(-0.9, 0.9, 10, 1), AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0)))
    EXPECT_NEAR(distance, 2.0f, 1e-5f);
}

}  // namespace
}  // namespace shadowbench::truth
