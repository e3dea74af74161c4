// The pieces that models are made of.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "filters/kernel.h"
#include "filters/random.h"
#include "filters/scalar.h"
#include "filters/store_format.h"

namespace shadowbench::filters {
namespace {

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

}  // namespace
}  // namespace shadowbench::filters
