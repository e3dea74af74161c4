#include <complex>
#include <numeric>

#include "filters/kernel.h"
#include "filters/moments.h"
#include "filters/percentage_closer.h"
#include "filters/random.h"
#include "filters/scalar.h"
#include "filters/store_format.h"
#include "tests/filters/filtered.h"
#include "tests/filters/perspective_depth.h"
#include "tests/test_files.h"

namespace shadowbench::filters {
namespace {

// The pieces that models are made of.

TEST(Tracked, BoundHoldsForSinglePrecision_OnRandomExpressions) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> draw(-2.0f, 2.0f);
  double tightest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const float a = draw(generator), b = draw(generator), c = draw(generator);
    const float single = std::exp(a * b - c) / (1.5f + a * a) + std::max(b, c) * (a - b);
    const Tracked ta(static_cast<double>(a)), tb(static_cast<double>(b)), tc(static_cast<double>(c));
    const Tracked tracked = exponential(ta * tb - tc, {}) / (Tracked(1.5) + ta * ta) + max(tb, tc) * (ta - tb);
    const double error = std::abs(static_cast<double>(single) - tracked.value);
    ASSERT_LE(error, tracked.bound);
    tightest = std::max(tightest, error / tracked.bound);
  }
  EXPECT_GT(tightest, 0.02) << "a bound that nothing comes near says nothing";
}

TEST(Tracked, DivisionByWhatMayBeZero_HasNoBound) {
  EXPECT_TRUE(std::isinf((Tracked(1.0) / Tracked(1e-9, 1e-8)).bound));
}

TEST(Tracked, Cancellation_ShowsInTheBound) {
  const Tracked a = Tracked(1.0) / Tracked(3.0), difference = a - Tracked(1.0 / 3.0);
  EXPECT_GT(difference.bound, 100.0 * std::abs(difference.value) + 1e-9);
}

TEST(Gaussian, SumsToOne_IsSymmetric_AndFallsToItsEdge) {
  for (const int radius : {0, 1, 4, 16, 64}) {
    const std::vector<float> w = gaussian_weights(radius);
    ASSERT_EQ(w.size(), static_cast<std::size_t>(2 * radius + 1));
    EXPECT_NEAR(std::accumulate(w.begin(), w.end(), 0.0), 1.0, 1e-6);
    for (std::size_t i = 0; i < w.size(); ++i) EXPECT_EQ(w[i], w[w.size() - 1 - i]);
    if (radius > 0) EXPECT_NEAR(w.front() / w[static_cast<std::size_t>(radius)], std::exp(-2.0f), 1e-6f);
  }
}

TEST(Random, TurnsAreUniform) {
  double sum = 0.0, squares = 0.0;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      const double turn = static_cast<double>(random_turn({x, y}, 1));
      ASSERT_GE(turn, 0.0);
      ASSERT_LT(turn, 1.0);
      sum += turn;
      squares += turn * turn;
    }
  }
  EXPECT_NEAR(sum / 1e4, 0.5, 0.012);  // 4 standard errors of a uniform mean
  EXPECT_NEAR(squares / 1e4, 1.0 / 3.0, 0.012);
}

TEST(Random, InterleavedGradient_FollowsItsFloatingPointForm) {
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const auto fract = [](double v) { return v - std::floor(v); };
      const double expected = fract(52.9829189 * fract(0.06711056 * x + 0.00583715 * y));
      const double turn = static_cast<double>(interleaved_gradient_turn({x, y}));
      const double distance = std::abs(turn - expected);
      EXPECT_LT(std::min(distance, 1.0 - distance), 2e-6) << x << "," << y;
    }
  }
}

/// The golden ratio's multiples leave no gap of twice the mean; the three-gap theorem (Swierczkowski 1958) allows 1.9.
TEST(Random, FramesSpreadATurnEvenly_AndWhiteNoiseDrawsAnew) {
  constexpr int kTurns = 21;
  std::vector<float> blue, gradient, white;
  for (std::uint32_t frame = 0; frame < kTurns; ++frame) {
    blue.push_back(turn_of("blue-noise", {3, 5}, 1, frame));
    gradient.push_back(turn_of("interleaved-gradient", {3, 5}, 1, frame));
    white.push_back(turn_of("per-pixel", {3, 5}, 1, frame));
    EXPECT_EQ(turn_of("none", {3, 5}, 1, frame), 0.0f);
  }
  EXPECT_EQ(blue.front(), blue_noise_turn({3, 5}, 1));
  const auto widest = [](std::vector<float> turns) {
    std::ranges::sort(turns);
    float gap = 1.0f + turns.front() - turns.back();
    for (std::size_t i = 1; i < turns.size(); ++i) gap = std::max(gap, turns[i] - turns[i - 1]);
    return gap * static_cast<float>(turns.size());
  };
  EXPECT_LT(widest(blue), 2.0f);
  EXPECT_LT(widest(gradient), 2.0f);
  EXPECT_GT(widest(white), 2.0f);
}

TEST(StoreFormat, NamesGiveChannelsBytesAndPrecision) {
  EXPECT_EQ(store_channels("r32f"), 1);
  EXPECT_EQ(store_channels("rg16f"), 2);
  EXPECT_EQ(store_channels("rgba16"), 4);
  EXPECT_EQ(store_bytes("rg32f"), 8);
  EXPECT_EQ(store_bytes("rgba16f"), 8);
  EXPECT_EQ(store_precision("rg16f"), StorePrecision::kHalf);
  EXPECT_EQ(store_precision("rg16"), StorePrecision::kUnorm16);
}

/// The next number up is infinite, or does not fit.
TEST(StoreFormat, LargestNumber_IsTheLargest) {
  const auto largest = static_cast<float>(largest_number(StorePrecision::kHalf));
  EXPECT_EQ(round_to_store(largest, StorePrecision::kHalf), largest);
  EXPECT_TRUE(std::isinf(round_to_store(largest * 1.001f, StorePrecision::kHalf)));
  EXPECT_TRUE(std::isinf(static_cast<float>(largest_number(StorePrecision::kSingle)) * 1.001f));
  EXPECT_EQ(round_to_store(2.0f, StorePrecision::kUnorm16),
            static_cast<float>(largest_number(StorePrecision::kUnorm16)));
}

TEST(StoreFormat, HalfOverflowsAbove65504) {
  EXPECT_TRUE(std::isinf(round_to_store(std::exp(11.10f), StorePrecision::kHalf)));
  EXPECT_FALSE(std::isinf(round_to_store(std::exp(11.08f), StorePrecision::kHalf)));
}

// The texture of blue noise: that it is noise, and that it is blue.

constexpr int kSide = static_cast<int>(kBlueNoiseSide);

using Turn = std::function<float(glm::ivec2)>;

/// The mean power of the frequencies whose distance from 0, in turns per texture, lies between two limits; white noise
/// of turns has 1 at all of them.
double measure_power(const Turn& turn, double from, double to) {
  const int reach = static_cast<int>(to);
  double power = 0.0;
  int frequencies = 0;
  for (int v = -reach; v <= reach; ++v) {
    for (int u = -reach; u <= reach; ++u) {
      if (const double distance = std::hypot(u, v); distance < from || distance >= to) continue;
      std::complex<double> sum;
      for (int i = 0; i < kSide * kSide; ++i) {
        const glm::ivec2 pixel(i % kSide, i / kSide);
        const double angle = 2.0 * std::numbers::pi * (u * pixel.x + v * pixel.y) / kSide;
        sum += (static_cast<double>(turn(pixel)) - 0.5) * std::polar(1.0, angle);
      }
      power += std::norm(sum) * 12.0 / (kSide * kSide);
      ++frequencies;
    }
  }
  return power / frequencies;
}

TEST(BlueNoise, HasEveryRankOnce) {
  const std::set<std::uint16_t> ranks(blue_noise().begin(), blue_noise().end());
  EXPECT_EQ(ranks.size(), blue_noise().size());
  EXPECT_EQ(*ranks.rbegin(), blue_noise().size() - 1);
}

TEST(BlueNoise, HasLittlePowerAtLowFrequencies) {
  const Turn blue = [](glm::ivec2 p) { return blue_noise_turn(p, 1); };
  const Turn white = [](glm::ivec2 p) { return random_turn(p, 1); };
  EXPECT_NEAR(measure_power(white, 1.0, 12.0), 1.0, 0.2);
  EXPECT_LT(measure_power(blue, 1.0, 4.0), 0.001);
  EXPECT_LT(measure_power(blue, 1.0, 12.0), 0.01);
  EXPECT_GT(measure_power(blue, 28.0, 32.0), 1.2);
}

TEST(BlueNoise, IsTheSameOnEveryMachine) {
  std::uint32_t hash = 0;
  for (const std::uint16_t rank : blue_noise()) hash = hash_bits(hash + rank);
  EXPECT_EQ(hash, 1520271867u);
}

TEST(BlueNoise, Repeats_AndIsShiftedByTheSeed) {
  EXPECT_EQ(blue_noise_turn({3, 5}, 1), blue_noise_turn({3 + kSide, 5 + 2 * kSide}, 1));
  int moved = 0;
  for (int x = 0; x < kSide; ++x) moved += blue_noise_turn({x, 0}, 1) != blue_noise_turn({x, 0}, 2);
  EXPECT_GT(moved, kSide / 2);
}

constexpr DepthPlanes kPlanes{0.01, 1e4};

/// Every curve is exact at its ends, so that what was cleared is the far plane and nothing else is.
TEST(DepthCurve, InSinglePrecision_IsExactAtItsEnds_Rises_AndGoesBack) {
  for (const double ratio : {1.0, 1.3, 7.7, 1234.567, 1e5, 1e7}) {
    for (const bool reversed : {false, true}) {
      const DepthCurve curve{reversed, ratio};
      EXPECT_EQ(curve.linear(curve.far_plane()), 1.0f) << ratio << reversed;
      EXPECT_EQ(curve.linear(1.0f - curve.far_plane()), 0.0f) << ratio << reversed;
      EXPECT_NEAR(curve.store(1.0f), curve.far_plane(), 2e-7f) << ratio << reversed;
      EXPECT_EQ(curve.store(0.0f), 1.0f - curve.far_plane()) << ratio << reversed;
      for (const float z : {0.001f, 0.2f, 0.5f, 0.93f}) {
        EXPECT_TRUE(curve.is_lit(curve.store(z), curve.store(1.5f * z)));
        const double step = depth_step(static_cast<double>(z), curve, {});
        EXPECT_NEAR(static_cast<double>(curve.linear(curve.store(z))), static_cast<double>(z), 4.0 * step + 2e-7)
            << ratio << reversed << z;
      }
    }
  }
}

TEST(DepthCurve, BeforeTheNearPlane_IsLitByAllThatThereIs) {
  for (const bool reversed : {false, true}) {
    const DepthCurve curve{reversed, 1000.0};
    for (const float z : {-1e-4f, -0.001f, -5.0f}) EXPECT_TRUE(curve.is_lit(curve.store(z), curve.store(0.0f))) << z;
  }
}

TEST(DepthCurve, ReversedIsOneLess_AndTheInverseGoesBack) {
  for (const double d : {0.02, 1.0, 37.0, 9000.0}) {
    EXPECT_NEAR(depth_of_distance(d, kPlanes, false) + depth_of_distance(d, kPlanes, true), 1.0, 1e-15);
    for (const bool reversed : {false, true}) {
      EXPECT_NEAR(distance_of_depth(depth_of_distance(d, kPlanes, reversed), kPlanes, reversed), d, 1e-9 * d)
          << reversed;
    }
  }
}

/// The step is the curve's inverse slope times the quantum.
TEST(DepthCurve, Step_IsWhatOneQuantumMovesTheDistance) {
  for (const double d : {0.5, 10.0, 100.0}) {
    for (const bool reversed : {false, true}) {
      const double depth = depth_of_distance(d, kPlanes, reversed);
      const double quantum = depth_quantum(depth, {24, false});
      const double moved = std::abs(distance_of_depth(depth + quantum, kPlanes, reversed) -
                                    distance_of_depth(depth - quantum, kPlanes, reversed));
      EXPECT_NEAR(distance_step(d, kPlanes, {24, false}, reversed), 0.5 * moved, 0.01 * moved) << d;
    }
  }
}

TEST(DepthCurve, Quantum_IsTheFormats) {
  EXPECT_EQ(depth_quantum(0.3, {16, false}), 1.0 / 65535.0);
  for (const float depth : {0.3f, 0.75f, 1e-4f})
    EXPECT_EQ(depth_quantum(static_cast<double>(depth), {}), static_cast<double>(std::nextafter(depth, 2.0f) - depth));
}

TEST(DepthCurve, ReversedFloat_IsRelativelyExactEverywhere_StandardIsNot) {
  for (const double d : {0.02, 1.0, 100.0, 5000.0})
    EXPECT_LE(distance_step(d, kPlanes, {}, true) / d, std::exp2(-22)) << d;
  EXPECT_GT(distance_step(5000.0, kPlanes, {}, false) / 5000.0, 0.01);
}

// Exponential variance and moment shadow maps: what they promise of any map, and closed forms.

constexpr int kMomentMapSide = 32;

/// A map of a few depths in blocks and of noise.
DepthMap make_blocks(unsigned seed) {
  std::mt19937 random(seed);
  DepthMap map{kMomentMapSide, {}};
  for (int i = 0; i < kMomentMapSide * kMomentMapSide; ++i) {
    const int block = i % kMomentMapSide / 5 + i / kMomentMapSide / 5;
    map.stored.push_back(block % 3 == 0 ? static_cast<float>(random()) * 0x1p-32f
                                        : 0.2f * static_cast<float>(block % 5));
  }
  return map;
}

Receiver make_blocks_receiver(std::mt19937& random) {
  const auto uniform = [&] { return static_cast<float>(random()) * 0x1p-32f; };
  Receiver r;
  r.uv = {uniform(), uniform()};
  r.depth = 0.02f + 0.96f * uniform();
  return r;
}

class UpperBound : public ::testing::TestWithParam<std::string> {};

TEST_P(UpperBound, IsNeverDarkerThanPcfOfItsKernel_OnAnyMap) {
  const FilterRequest request = request_of(GetParam());
  std::mt19937 random(11);
  int dark = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const DepthMap map = make_blocks(seed);
    const Filtered lookup(request, map);
    const PercentageCloser closer(*find_kernel(request.spec, request.values), map);
    for (int i = 0; i < 1000; ++i) {
      const Receiver r = make_blocks_receiver(random);
      const double light = lookup.at(r);
      ASSERT_GE(light, closer.at(r) - 1e-6) << "depth " << r.depth;  // the weights, as floats, sum to 1 within that
      dark += light < 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(dark, 200) << "a bound that is always 1 promises nothing";
}

INSTANTIATE_TEST_SUITE_P(Filters, UpperBound,
                         ::testing::Values("evsm2:bleed_reduction=0", "evsm4", "evsm4:radius=1,c=20", "msm_hamburger",
                                           "msm_hausdorff", "msm_hausdorff:radius=1,moment_bias=0.01"));

TEST(Msm, DepthsWithinTheMap_SayMoreThanAnyDepths) {
  const DepthMap map = make_blocks(5);
  const Filtered any("msm_hamburger", map), in_range("msm_hausdorff", map);
  std::mt19937 random(12);
  int less = 0;
  for (int i = 0; i < 4000; ++i) {
    const Receiver r = make_blocks_receiver(random);
    ASSERT_LE(in_range.at(r), any.at(r) + 1e-9) << "depth " << r.depth;
    less += in_range.at(r) < any.at(r) - 1e-3 ? 1 : 0;
  }
  EXPECT_GT(less, 100);
}

/// Moments of two depths are those of no other distribution.
TEST(Moments, OfTwoDepths_GiveTheLitShare) {
  constexpr float kNear = 0.3f, kFar = 0.8f;
  const DepthMap map = make_edge(kMomentMapSide, kMomentMapSide / 2, kNear, kFar);
  for (const char* text : {"msm_hamburger", "msm_hausdorff", "evsm2:bleed_reduction=0", "evsm4",
                           "msm_packed64:lookup=bilinear", "msm_packed32:lookup=bilinear"}) {
    const FilterRequest request = request_of(text);
    const Filtered lookup(request, map);
    const PercentageCloser closer(*find_kernel(request.spec, request.values), map);
    for (double x = 11.0; x < 21.0; x += 0.37) {
      Receiver r;
      r.uv = {static_cast<float>(x / kMomentMapSide), 0.5f};
      r.depth = kFar - 1e-5f;
      ASSERT_NEAR(lookup.at(r), closer.at(r), 5e-3) << text << " at " << x;
    }
  }
}

TEST(Moments, OfADepth_FillTheStore_AndComeBack) {
  std::array<double, 4> least{1.0, 1.0, 1.0, 1.0}, most{};
  for (double depth = 0.0; depth <= 1.0; depth += 1.0 / 1024.0) {
    const auto stored = four_moments::encode(depth);
    const auto moments = four_moments::decode(stored, 0.0);
    for (std::size_t i = 0; i < 4; ++i) {
      least[i] = std::min(least[i], stored[i]);
      most[i] = std::max(most[i], stored[i]);
      ASSERT_NEAR(moments[i], std::pow(2.0 * depth - 1.0, static_cast<double>(i + 1)), 1e-14);
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(least[i], 0.0, 1e-5) << i;
    EXPECT_NEAR(most[i], 1.0, 1e-5) << i;
    EXPECT_GE(least[i], -1e-15);
    EXPECT_LE(most[i], 1.0 + 1e-15);
  }
}

/// Two depths and a share become their own description; rounded, they keep within a step, and do not meet.
TEST(PackedMoments, OfTwoDepths_AreTheseDepths) {
  constexpr packed_moments::Levels kLevels{2048, 2048, 64, 16};
  for (const auto& [near, far, share] : {std::tuple(-0.4, 0.5, 0.25), {-0.999, 0.999, 0.5}, {0.1, 0.1002, 0.9}}) {
    four_moments::Moments<double> moments;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto power = static_cast<double>(i + 1);
      moments[i] = (1.0 - share) * std::pow(near, power) + share * std::pow(far, power);
    }
    const auto exact = packed_moments::describe(moments), packed = packed_moments::pack(moments, kLevels);
    EXPECT_NEAR(exact.nearer, near, 1e-6);
    EXPECT_NEAR(exact.farther, far, 1e-6);
    EXPECT_NEAR(exact.share, share, 1e-6);
    EXPECT_NEAR(packed.nearer, near, 1.0 / 2047.0);
    EXPECT_NEAR(packed.farther, far, 2.0 / 2047.0);
    EXPECT_GT(packed.farther, packed.nearer);
    EXPECT_LE(packed.share, 1.0);
  }
}

/// The light of what is described is that of the moments, by the polynomial of their Hankel matrix.
TEST(PackedMoments, Described_GiveTheShareOfTheMoments) {
  std::mt19937 random(3);
  const auto uniform = [&] { return 2.0 * static_cast<double>(random()) * 0x1p-32 - 1.0; };
  for (int i = 0; i < 500; ++i) {
    four_moments::Moments<double> moments{};
    for (int depth = 0; depth < 5; ++depth) {
      const double x = uniform();
      for (std::size_t k = 0; k < 4; ++k) moments[k] += 0.2 * std::pow(x, static_cast<double>(k + 1));
    }
    const double x = uniform();
    const double share = four_moments::share_of_points(moments, x, four_moments::solve(moments, x));
    EXPECT_NEAR(packed_moments::find_share(packed_moments::describe(moments), x, 0.0), share, 1e-3) << i;
  }
}

/// What a 16-bit store cannot hold is not asked of it.
TEST(Moments, ParametersAreFitToTheStore) {
  const DepthMap map = make_blocks(6);
  for (const auto& [asked, given] :
       {std::pair("evsm4:store=rgba16f,c=42,c_down=42", "evsm4:store=rgba16f,c=5.54,c_down=5.54"),
        {"evsm2:store=rg16f,c=30", "evsm2:store=rg16f,c=5.54"},
        {"msm_hamburger:store=rgba16,moment_bias=1e-5", "msm_hamburger:store=rgba16,moment_bias=1.2e-4"}}) {
    const Filtered a(asked, map, Precision::kFloat), b(given, map, Precision::kFloat);
    std::mt19937 random(13);
    for (int i = 0; i < 200; ++i) {
      const Receiver r = make_blocks_receiver(random);
      ASSERT_EQ(a.at(r), b.at(r)) << asked;
      ASSERT_TRUE(std::isfinite(a.at(r)));
    }
  }
}

// Exponential shadow maps where their assumption fails: texels under the kernel lie behind the receiver.

/// Looks up a receiver at depth 0.5 in the middle of a map, of which the left half lies at one depth and the right half
/// at another.
double look_up_between(const std::string& text, float left, float right) {
  const DepthMap map = make_edge(32, 16, left, right);
  Receiver r;
  r.depth = r.depth_unbiased = 0.5f;
  return Filtered(text, map).at(r);
}

TEST(EsmFallback, BetweenABlockerAndWhatLiesBehind_IsPercentageCloser) {
  for (const std::string combine : {"linear", "log"}) {
    const std::string esm = "esm:c=40,combine=" + combine;
    EXPECT_EQ(look_up_between(esm, 0.2f, 0.9f), 1.0) << combine;
    EXPECT_NEAR(look_up_between(esm + ",fallback=percentage-closer", 0.2f, 0.9f), 0.5, 1e-6) << combine;
  }
}

TEST(EsmFallback, WhereTheTestHolds_ChangesNothing) {
  for (const float left : {0.2f, 0.45f, 0.5f})
    EXPECT_EQ(look_up_between("esm:fallback=percentage-closer", left, 0.501f), look_up_between("esm", left, 0.501f));
}

}  // namespace
}  // namespace shadowbench::filters
