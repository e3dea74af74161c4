#include "filters/model.h"

#include "filters/percentage_closer.h"
#include "filters/random.h"
#include "tests/filters/filtered.h"
#include "tests/test_files.h"

namespace shadowbench::filters {
namespace {

// Models against results that can be worked out by hand.

double look_up(const std::string& request, const DepthMap& map, double x, double y, float depth,
               Precision precision = Precision::kDouble) {
  return Filtered(request, map, precision).at(make_receiver_at(map, x, y, depth));
}

TEST(NoneModel, ComparesTheTexelThatHoldsThePoint) {
  const DepthMap map = make_edge(16, 8, 0.25f, 1.0f);
  EXPECT_EQ(look_up("none", map, 7.9, 4.5, 0.5f), 0.0);
  EXPECT_EQ(look_up("none", map, 8.1, 4.5, 0.5f), 1.0);
  EXPECT_EQ(look_up("none", map, 4.5, 4.5, 0.25f), 1.0) << "ties are lit";
}

/// One ULP of depth is a long way on a perspective curve's flat end, and on a reversed map's fine one.
TEST(NoneModel, DepthsOneUlpApart_AreExcused_WhateverTheCurve_OthersAreNot) {
  const auto is_excused = [&](const DepthCurve& curve, float in_map, float depth) {
    const float stored = curve.store(in_map);
    DepthMap map = make_edge(16, 16, stored, stored);
    map.curve = curve;
    return Filtered("none", map).find(make_receiver_at(map, 4.5, 4.5, depth)).excused;
  };
  for (const double ratio : {1.0, 1e3}) {
    for (const bool reversed : {false, true}) {
      const DepthCurve curve{reversed, ratio};
      EXPECT_TRUE(is_excused(curve, 0.9f, std::nextafter(0.9f, 1.0f))) << reversed << ratio;
      EXPECT_TRUE(is_excused(curve, 0.9f, std::nextafter(0.9f, 0.0f))) << reversed << ratio;
      EXPECT_FALSE(is_excused(curve, 0.9f, 0.901f)) << reversed << ratio;
      EXPECT_FALSE(is_excused(curve, 0.9f, 0.899f)) << reversed << ratio;
    }
  }
  EXPECT_TRUE(is_excused({false, 1e6}, 0.9f, 0.91f)) << "single precision cannot tell them apart there";
  EXPECT_FALSE(is_excused({true, 1e6}, 0.9f, 0.91f));
}

TEST(NoneModel, CurveOfTheMap_ChangesNoComparison) {
  for (const DepthCurve& curve : {DepthCurve{}, DepthCurve{true}, DepthCurve{false, 100.0}, DepthCurve{true, 100.0}}) {
    DepthMap map = make_edge(16, 8, curve.store(0.25f), curve.far_plane());
    map.curve = curve;
    EXPECT_EQ(look_up("none", map, 4.5, 4.5, 0.249f), 1.0);
    EXPECT_EQ(look_up("none", map, 4.5, 4.5, 0.251f), 0.0);
    EXPECT_EQ(look_up("none", map, 12.5, 4.5, 0.999f), 1.0);
    EXPECT_EQ(look_up("none", map, -3.0, 4.5, 0.999f), 1.0) << "outside";
    EXPECT_NEAR(look_up("vsm:radius=0", map, 3.5, 4.5, 0.75f),
                look_up("vsm:radius=0", make_edge(16, 8, 0.25f, 1.0f), 3.5, 4.5, 0.75f), 1e-5)
        << "moments are of linear depth";
  }
}

TEST(NoneModel, Border_SaysWhatLiesOutside) {
  DepthMap map = make_edge(16, 8, 0.25f, 1.0f);  // dark left, lit right
  map.border = Border::kEdge;
  EXPECT_EQ(look_up("none", map, -20.5, 4.5, 0.5f), 0.0);
  EXPECT_EQ(look_up("none", map, 36.5, -4.5, 0.5f), 1.0);
  map.border = Border::kRepeat;
  EXPECT_EQ(look_up("none", map, 16.5 + 3, 4.5, 0.5f), 0.0);
  EXPECT_EQ(look_up("none", map, 16.5 + 9, 4.5, 0.5f), 1.0);
  EXPECT_EQ(look_up("none", map, -0.5, -20.5, 0.5f), 1.0) << "the last column, one map to the left";
  EXPECT_EQ(look_up("none", map, -31.5, 4.5, 0.5f), 0.0) << "the first column, two maps to the left";
}

TEST(VsmModel, Border_ReachesThroughTheBlur) {
  // All dark: only what lies outside can light the map's edge.
  DepthMap map = make_edge(32, 32, 0.25f, 1.0f);
  EXPECT_GT(look_up("vsm:radius=4", map, 0.5, 16.5, 0.5f), 0.3);
  for (const Border border : {Border::kEdge, Border::kRepeat}) {
    map.border = border;
    EXPECT_LT(look_up("vsm:radius=4", map, 0.5, 16.5, 0.5f), 0.001);
  }
}

TEST(Pcf2x2Model, IsATentAcrossAnEdge) {
  const DepthMap map = make_edge(16, 8, 0.25f, 1.0f);
  for (const double s : {0.0, 0.25, 0.5, 0.75}) EXPECT_NEAR(look_up("pcf2x2", map, 7.5 + s, 4.5, 0.5f), s, 1e-6);
}

TEST(Box4x4Model, InSinglePrecision_KeepsItsBound) {
  std::mt19937 random(3);
  const auto number = [&] { return static_cast<float>(random()) * 0x1p-32f; };
  for (const int size : {1, 3, 100, 1000, 1024}) {
    DepthMap map{size, {}};
    for (int i = 0; i < size * size; ++i) map.stored.push_back(number());
    const Filtered single("box4x4", map, Precision::kFloat), tracked("box4x4", map, Precision::kTracked);
    for (int i = 0; i < 20000; ++i) {
      Receiver r;
      r.uv = {number(), number()};
      r.depth = number();
      const ModelResult exact = tracked.find(r);
      if (exact.excused) continue;
      ASSERT_LE(std::abs(single.at(r) - exact.visibility), exact.bound) << size;
      ASSERT_LT(exact.bound, 5e-6 * (size + 1)) << "a bound this wide says nothing";
    }
  }
}

TEST(PoissonModel, RadiusZero_IsItsBaseComparison) {
  const DepthMap map = make_edge(16, 8, 0.25f, 1.0f);
  for (const double x : {7.2, 7.8, 8.3})
    EXPECT_NEAR(look_up("poisson:radius=0", map, x, 4.2, 0.5f), look_up("pcf2x2", map, x, 4.2, 0.5f), 1e-12);
}

TEST(VsmModel, DepthsThatAreNearlyEqual_NeedMoreThanDouble) {
  // As above, exact for any gap; but E[z^2] - E[z]^2 is 2^-44 of its terms here, and double leaves it 1 part in a
  // hundred.
  const float near = 0.75f - 0x1p-23f, far = 0.75f;
  const DepthMap map = make_edge(64, 32, near, far);
  const double exact =
      look_up("vsm:radius=0,min_variance=0,bleed_reduction=0", make_edge(64, 32, 0.25f, 0.75f), 31.8, 20.5, 0.75f);
  const auto error = [&](Precision precision) {
    return std::abs(look_up("vsm:radius=0,min_variance=0,bleed_reduction=0", map, 31.8, 20.5, far, precision) - exact);
  };
  EXPECT_LT(error(Precision::kExtended), 1e-4);
  EXPECT_GT(error(Precision::kDouble), 1e-4);
}

TEST(VsmModel, TwoOccluders_BleedAsTheClosedFormSays) {
  // shared algebra: V = s2 / (s2 + (t - mu)^2) with a = .1, b = .6, half each, t = .7 gives .3378; the truth is 0.
  const DepthMap map = make_edge(64, 32, 0.1f, 0.6f);
  EXPECT_NEAR(look_up("vsm:radius=0,min_variance=0,bleed_reduction=0", map, 32.0, 20.5, 0.7f), 0.3378, 1e-4);
}

TEST(VsmModel, SlopeWithinTexels_IsVariance) {
  // A plane that falls by 1/64 a texel, and a receiver 1/32 below it: the variance is k (1/64)^2 and nothing else.
  DepthMap map{16, {}};
  for (int i = 0; i < 16 * 16; ++i) map.stored.push_back(0.25f + static_cast<float>(i % 16) / 64.0f);
  const float depth = map.stored[8] + 1.0f / 32.0f;
  for (const double k : {0.0, 0.25, 1.0}) {
    const std::string request = "vsm:radius=0,min_variance=0,bleed_reduction=0,slope_variance=" + std::to_string(k);
    EXPECT_NEAR(look_up(request, map, 8.5, 8.5, depth), k / (k + 4.0), 1e-6);
  }
}

TEST(VsmModel, Silhouettes_AreNoSlope) {
  const DepthMap map = make_edge(64, 32, 0.25f, 0.75f);
  EXPECT_EQ(look_up("vsm:radius=0,min_variance=0", map, 31.5, 20.5, 0.5f), 0.0);
  EXPECT_EQ(look_up("vsm:radius=0,min_variance=0", map, 0.5, 0.5, 0.5f), 0.0) << "the map's edge is none either";
}

TEST(VsmModel, BleedReduction_CutsTheDarkEnd) {
  const DepthMap map = make_edge(64, 32, 0.25f, 0.75f);
  EXPECT_NEAR(look_up("vsm:radius=0,min_variance=0,bleed_reduction=0.2", map, 32.0, 20.5, 0.75f), 0.375, 1e-6);
}

TEST(EsmModel, TwoLayers_FollowTheClosedForm) {
  // V = w + (1 - w) exp(-c (t - a)) with a = .3, t = .7, w = .5.
  const DepthMap map = make_edge(64, 32, 0.3f, 0.7f);
  EXPECT_NEAR(look_up("esm:radius=0,c=5", map, 32.0, 20.5, 0.7f), 0.56767, 1e-5);
  EXPECT_NEAR(look_up("esm:radius=0,c=10", map, 32.0, 20.5, 0.7f), 0.50916, 1e-5);
  EXPECT_NEAR(look_up("esm:radius=0,c=40", map, 32.0, 20.5, 0.7f), 0.5, 1e-5);
}

TEST(EsmModel, LogSpaceBlur_EqualsLinearBlur_WhereBothAreRead) {
  const DepthMap map = make_edge(64, 32, 0.3f, 0.7f);
  for (const double x : {28.5, 31.5, 33.5})  // texel centres: nearest and bilinear reads agree
    EXPECT_NEAR(look_up("esm:combine=log,c=30", map, x, 20.5, 0.7f), look_up("esm:c=30", map, x, 20.5, 0.7f), 1e-9);
}

TEST(EsmModel, LogSpace_DoesNotOverflow) {
  const DepthMap map = make_edge(64, 32, 0.3f, 0.7f);
  const double v = look_up("esm:combine=log,c=2000", map, 31.5, 20.5, 0.7f);
  EXPECT_TRUE(std::isfinite(v));
  EXPECT_GT(v, 0.3);
  EXPECT_LT(v, 0.5);
}

/// ESM in log space, whose exponent has no limit but the parameter's; `c` may exceed that here.
double look_up_esm(const DepthMap& map, int radius, double c, float depth) {
  FilterRequest request = request_of("esm:combine=log");
  request.values["c"] = c;
  request.values["radius"] = static_cast<double>(radius);
  const double middle = 0.5 * map.size + 0.5;
  return Filtered(request, map).at(make_receiver_at(map, middle, middle, depth));
}

TEST(EsmModel, OfASingleTexel_TendsToTheHardComparison) {
  const DepthMap map = make_edge(16, 16, 0.5f, 0.5f);
  double previous = 1.0;
  for (const double c : {10.0, 100.0, 1000.0, 10000.0}) {
    const double blocked = look_up_esm(map, 0, c, 0.502f);
    EXPECT_NEAR(blocked, std::exp(-c * (static_cast<double>(0.502f) - 0.5)), 1e-12) << c;
    EXPECT_LT(blocked, previous);
    EXPECT_EQ(look_up_esm(map, 0, c, 0.4999f), 1.0) << c;
    previous = blocked;
  }
  EXPECT_LT(previous, 1e-8);
}

TEST(EsmModel, OfAWideKernel_GoesToOne_AsSoonAsATexelIsDeeper) {
  // All block the receiver but one texel, which lies 0.0005 behind it: the percentage-closer filter is that texel's
  // weight.
  DepthMap map = make_edge(16, 16, 0.3f, 0.3f);
  map.stored[8 * 16 + 9] = 0.7005f;
  const double weight = Kernel::make_gaussian(2, Reconstruction::kNearest).atoms()[2].weight *
                        Kernel::make_gaussian(2, Reconstruction::kNearest).atoms()[3].weight;
  for (const double c : {100.0, 1000.0, 3000.0}) {
    const double gap = static_cast<double>(0.7005f) - static_cast<double>(0.7f);
    EXPECT_NEAR(look_up_esm(map, 2, c, 0.7f), std::min(1.0, weight * std::exp(c * gap)), 1e-9) << c;
  }
  EXPECT_LT(weight, 0.2);
  EXPECT_EQ(look_up_esm(map, 2, 10000.0, 0.7f), 1.0) << "lit, although a fifth of the kernel at most is";
}

TEST(Excuse, TiesAndBorders_AreNamed) {
  const DepthMap map = make_edge(16, 8, 0.25f, 1.0f);
  const Filtered none("none", map);
  Receiver r = make_receiver_at(map, 4.5, 4.5, 0.5f);
  EXPECT_FALSE(none.find(r).excused);
  EXPECT_TRUE(none.find(make_receiver_at(map, 4.5, 4.5, std::nextafter(0.25f, 1.0f))).excused) << "one ULP from a tie";
  r.uv.x = std::nextafter(8.0f / 16.0f, 1.0f);
  EXPECT_TRUE(none.find(r).excused) << "at a texel's border";
}

struct Spread {
  double mean_square_radius = 0.0;
  double off_centre = 0.0;                              ///< distance of the mean from the centre
  double farthest = 0.0;                                ///< from the centre
  double closest = std::numeric_limits<double>::max();  ///< two points, in units of 1 / sqrt(count)
};

Spread measure(const std::vector<glm::vec2>& points) {
  Spread spread;
  glm::dvec2 mean(0.0);
  const double count = static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec2 point(points[i]);
    mean += point / count;
    spread.mean_square_radius += glm::dot(point, point) / count;
    spread.farthest = std::max(spread.farthest, glm::length(point));
    for (std::size_t j = 0; j < i; ++j)
      spread.closest = std::min(spread.closest, std::sqrt(count) * glm::distance(point, glm::dvec2(points[j])));
  }
  spread.off_centre = glm::length(mean);
  return spread;
}

/// Uniform density has a mean square radius of 1/2, points of a hexagonal grid a distance of 1.9 / sqrt(count).
TEST(DiskPoints, AreUniformInDensity_CentredAndApart) {
  for (const int count : {4, 8, 16, 32, 100}) {
    for (const unsigned seed : {1u, 7u, 4294967295u}) {
      const Spread spread = measure(generate_disk_points(count, seed));
      EXPECT_NEAR(spread.mean_square_radius, 0.5, count < 8 ? 0.03 : 0.02) << count;
      EXPECT_LT(spread.off_centre, 1e-6) << count;
      EXPECT_LE(spread.farthest, 1.0 + 1e-6) << count;
      EXPECT_GT(spread.closest, 1.4) << count;
    }
  }
}

TEST(DiskPoints, AreTheSameOnEveryMachine) {
  struct Case {
    const char* pattern;
    glm::vec2 first, last;
  };
  for (const auto& [pattern, first, last] : {Case{"vogel", {-0.1583503f, 0.1083270f}, {0.7246058f, 0.6232137f}},
                                             {"stratified", {-0.4621132f, -0.4561556f}, {0.4007884f, 0.4879614f}},
                                             {"blue-noise", {0.5017402f, 0.3007793f}, {0.8834952f, -0.1211787f}}}) {
    const std::vector<glm::vec2> points = generate_disk_points(16, 1, pattern);
    EXPECT_LT(glm::distance(points.front(), first), 1e-6f) << pattern;
    EXPECT_LT(glm::distance(points.back(), last), 1e-6f) << pattern;
  }
}

/// Of the points' spread, the mean over seeds; those of a pattern with chance differ from seed to seed.
Spread measure_mean(const std::string& pattern, int count) {
  constexpr unsigned kSeeds = 64;
  Spread mean{0.0, 0.0, 0.0, 0.0};
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Spread spread = measure(generate_disk_points(count, seed, pattern));
    mean.mean_square_radius += spread.mean_square_radius / kSeeds;
    mean.off_centre = std::max(mean.off_centre, spread.off_centre);
    mean.farthest = std::max(mean.farthest, spread.farthest);
    mean.closest += spread.closest / kSeeds;
  }
  return mean;
}

TEST(DiskPoints, OfPatternsWithChance_AreUniformInTheMean) {
  for (const std::string pattern : {"stratified", "blue-noise"}) {
    for (const int count : {1, 4, 7, 8, 16, 32, 100}) {
      const Spread spread = measure_mean(pattern, count);
      EXPECT_LT(spread.off_centre, 1e-6) << pattern << " " << count;
      EXPECT_LE(spread.farthest, 1.0 + 1e-6) << pattern << " " << count;
      if (count >= 16) EXPECT_NEAR(spread.mean_square_radius, 0.5, 0.04) << pattern << " " << count;
    }
  }
}

TEST(DiskPoints, OfBlueNoise_AreApart) {
  for (const int count : {8, 16, 32, 100}) {
    const double closest = measure_mean("blue-noise", count).closest;
    EXPECT_GT(closest, 0.8) << count;
    EXPECT_GT(closest, 1.5 * measure_mean("stratified", count).closest) << count;
  }
}

TEST(DiskPoints, OfTheSpiral_AreThoseOfAnEngine_AboutTheirMean) {
  const std::vector<glm::vec2> engine = {{-0.7071f, 0.7071f},  {0.0f, -0.875f},     {0.5303f, 0.5303f},
                                         {-0.625f, 0.0f},      {0.3536f, -0.3536f}, {0.0f, 0.375f},
                                         {-0.1768f, -0.1768f}, {0.125f, 0.0f}};  // Bevy's utils.wgsl
  glm::vec2 mean(0.0f);
  for (const glm::vec2& point : engine) mean += point / 8.0f;
  const std::vector<glm::vec2> ours = generate_disk_points(8, 1, "spiral");
  for (std::size_t i = 0; i < engine.size(); ++i) EXPECT_LT(glm::distance(ours[i], engine[i] - mean), 1e-4f) << i;
}

TEST(DiskPoints, ASeedTurnsThem) {
  const std::vector<glm::vec2> one = generate_disk_points(16, 1), other = generate_disk_points(16, 2);
  EXPECT_NE(one, other);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_NEAR(glm::length(one[i]), glm::length(other[i]), 1e-6);
}

TEST(DiskPoints, OnePoint_IsTheCentre) { EXPECT_EQ(generate_disk_points(1, 1).front(), glm::vec2(0.0f)); }

// Filters whose kernel is as wide as the penumbra, against closed forms.

constexpr int kMapSide = 64;
constexpr float kFloor = 0.7f;

DepthMap make_map(const std::function<float(int x, int y)>& depth) {
  DepthMap map{kMapSide, {}};
  for (int i = 0; i < kMapSide * kMapSide; ++i) map.stored.push_back(depth(i % kMapSide, i / kMapSide));
  return map;
}

/// A receiver of the floor, with texels of 1 m and a depth of 100 m.
Receiver make_floor_receiver(double x, double y, float light_size) {
  Receiver r = make_receiver_at({kMapSide, {}}, x, y, kFloor);
  r.depth_unbiased = kFloor;
  r.depth_range_ws = 100.0f;
  r.light_size = light_size;
  return r;
}

class ContactHardening : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Filters, ContactHardening, ::testing::Values("pcss", "dpcf"),
                         [](const auto& each) { return std::string(each.param); });

/// Filters with disks of up to 20 texels and the most taps.
class Penumbra : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Filters, Penumbra,
                         ::testing::Values("pcss:taps=32,max_radius=20,search_taps=32", "dpcf:taps=32,max_radius=20",
                                           "evssm:taps=8,max_radius=40,rotation=per-pixel",
                                           "smrt:rays=32,steps=32,max_radius=20,thickness=1"),
                         [](const auto& each) {
                           const std::string text = each.param;
                           return text.substr(0, text.find(':'));
                         });

TEST_P(ContactHardening, LightOfNoSize_EqualsHardShadow) {
  const DepthMap map = make_random_map(kMapSide, 3);
  const Filtered soft(GetParam(), map), hard("pcf2x2", map);
  for (int i = 0; i < 500; ++i) {
    const Receiver r = make_floor_receiver(2.0 + 0.12 * i, 61.0 - 0.11 * i, 0.0f);
    ASSERT_EQ(soft.at(r), hard.at(r)) << i;
  }
}

/// A ray to the centre of the light, and rays to a light without a size, compare with the receiver's own texel alone,
/// however many steps they take.
TEST(Smrt, OneRay_AndALightOfNoSize_EqualNoFilter) {
  const DepthMap map = make_random_map(kMapSide, 4);
  const Filtered hard("none", map);
  for (const char* text :
       {"smrt:rays=1", "smrt:rays=1,thickness=1,steps=32", "smrt:rays=1,steps=4", "smrt:thickness=1"}) {
    const Filtered traced(text, map);
    for (int i = 0; i < 2000; ++i) {
      Receiver r = make_floor_receiver(2.0 + 0.03 * i, 61.0 - 0.0275 * i, i % 2 == 0 ? 0.0f : 0.3f);
      if (std::string(text) == "smrt:thickness=1") r.light_size = 0.0f;
      ASSERT_EQ(traced.at(r), hard.at(r)) << text << ", " << i;
    }
  }
}

/// Where visibility, falling from light to dark, crosses a level; in texels.
double find_crossing(const std::function<double(double)>& visibility, double level) {
  double lit = 20.0, dark = -20.0;
  while (lit - dark > 0.01) {
    const double middle = 0.5 * (lit + dark);
    (visibility(middle) > level ? lit : dark) = middle;
  }
  return lit;
}

double find_width(const std::function<double(double)>& visibility) {
  return find_crossing(visibility, 0.9) - find_crossing(visibility, 0.1);
}

/// The disk light's penumbra below a straight edge: the share of a disk on one side of a line.
double share_of_disk(double t) {
  t = std::clamp(t, -1.0, 1.0);
  return 1.0 - (std::acos(t) - t * std::sqrt(1.0 - t * t)) / std::numbers::pi;
}

/// A half-plane over a floor that lies parallel to it.
TEST_P(Penumbra, OfAnEdge_IsAsWideAsTheLightMakesIt) {
  constexpr float kEdge = 0.3f;
  const DepthMap map = make_map([](int x, int) { return x < kMapSide / 2 ? kEdge : kFloor; });
  const Filtered soft(GetParam(), map);
  struct Case {
    float light_size, nearness;
  };
  // The last two are of lamps 100 m and 80 m away, 40 m of which lie between the edge and the floor.
  for (const auto& [light_size, nearness] :
       {Case{0.1f, 0.0f}, {0.2f, 0.0f}, {0.4f, 0.0f}, {0.2f, 0.01f}, {0.1f, 0.0125f}}) {
    const double above = static_cast<double>(kFloor - kEdge);
    const double radius =
        50.0 * static_cast<double>(light_size) * above / (1.0 - 100.0 * above * static_cast<double>(nearness));
    const auto seen = [&](double x) {
      double sum = 0.0;
      constexpr int kPixels = 200;
      for (int i = 0; i < kPixels; ++i) {
        Receiver r = make_floor_receiver(kMapSide / 2 + x, 32.3, light_size);
        r.light_nearness = nearness;
        r.pixel = {i, 7 * i};
        sum += soft.at(r);
      }
      return sum / kPixels;
    };
    const double expected = find_width([&](double x) { return share_of_disk(x / radius); });
    // Narrow ones are blurred by how single texels are read.
    EXPECT_NEAR(find_width(seen), expected, std::max(0.1 * expected, 0.35)) << "radius " << radius;
  }
}

TEST(Pcss, SaysWhichDiskItAveraged) {
  const DepthMap map = make_map([](int x, int) { return x < kMapSide / 2 ? 0.3f : 1.0f; });
  const Filtered pcss("pcss", map);
  EXPECT_NEAR(pcss.radius_at(make_floor_receiver(32.0, 32.3, 0.2f)), 50.0 * 0.2 * 0.4, 1e-4);
  EXPECT_NEAR(pcss.radius_at(make_floor_receiver(32.0, 32.3, 3.0f)), 12.0, 1e-6) << "its limit";
  EXPECT_EQ(pcss.radius_at(make_floor_receiver(32.0, 32.3, 0.0f)), 0.0) << "one fetch";
  EXPECT_EQ(pcss.radius_at(make_floor_receiver(60.0, 32.3, 0.2f)), 0.0) << "no blocker";
}

TEST_P(ContactHardening, EveryTap_IsBiasedByItsOwnDistance) {
  constexpr float kSlope = 0.015f;
  const DepthMap map = make_map([](int x, int) { return kFloor + kSlope * (static_cast<float>(x) - 31.5f); });
  const Filtered soft(GetParam(), map);
  Receiver r = make_floor_receiver(32.0, 32.0, 2.0f);
  r.depth -= kSlope;  // the reach of one fetch, which bias_texels declares
  const PercentageCloser closer(Kernel::make_disk(4.0), map, 0.0, PercentageCloser::Owner::kFewReceivers);
  EXPECT_LT(soft.at(r), 1.0);
  EXPECT_LT(closer.at(r), 1.0);
  r.bias_per_texel = {kSlope, 0.0f};
  EXPECT_EQ(soft.at(r), 1.0);
  EXPECT_EQ(closer.at(r), 1.0) << "what it is compared with";
}

}  // namespace
}  // namespace shadowbench::filters
