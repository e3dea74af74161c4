#include "filters/moments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "filters/catalogue.h"
#include "filters/model.h"
#include "filters/percentage_closer.h"

namespace shadowbench::filters {
namespace {

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

FilterRequest request_blocks(const std::string& text) {
  static const Catalogue catalogue(SHADOWBENCH_SOURCE_DIR "/filters");
  return catalogue.parse_requests(text).front();
}

std::unique_ptr<Lookup> prepare_blocks(const FilterRequest& request, const DepthMap& map,
                                       Precision precision = Precision::kDouble) {
  return make_model(request.spec)->prepare({request.spec, request.values, map, {}, 0}, precision);
}

class UpperBound : public ::testing::TestWithParam<std::string> {};

TEST_P(UpperBound, IsNeverDarkerThanPcfOfItsKernel_OnAnyMap) {
  const FilterRequest request = request_blocks(GetParam());
  std::mt19937 random(11);
  int dark = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const DepthMap map = make_blocks(seed);
    const auto lookup = prepare_blocks(request, map);
    const PercentageCloser closer(*find_kernel(request.spec, request.values), map);
    for (int i = 0; i < 1000; ++i) {
      const Receiver r = make_blocks_receiver(random);
      const double light = lookup->at(r).visibility;
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
  const auto any = prepare_blocks(request_blocks("msm_hamburger"), map),
             in_range = prepare_blocks(request_blocks("msm_hausdorff"), map);
  std::mt19937 random(12);
  int less = 0;
  for (int i = 0; i < 4000; ++i) {
    const Receiver r = make_blocks_receiver(random);
    ASSERT_LE(in_range->at(r).visibility, any->at(r).visibility + 1e-9) << "depth " << r.depth;
    less += in_range->at(r).visibility < any->at(r).visibility - 1e-3 ? 1 : 0;
  }
  EXPECT_GT(less, 100);
}

/// Moments of two depths are those of no other distribution.
TEST(Moments, OfTwoDepths_GiveTheLitShare) {
  constexpr float kNear = 0.3f, kFar = 0.8f;
  DepthMap map{kMomentMapSide, {}};
  for (int i = 0; i < kMomentMapSide * kMomentMapSide; ++i)
    map.stored.push_back(i % kMomentMapSide < kMomentMapSide / 2 ? kNear : kFar);
  for (const char* text : {"msm_hamburger", "msm_hausdorff", "evsm2:bleed_reduction=0", "evsm4",
                           "msm_packed64:lookup=bilinear", "msm_packed32:lookup=bilinear"}) {
    const FilterRequest request = request_blocks(text);
    const auto lookup = prepare_blocks(request, map);
    const PercentageCloser closer(*find_kernel(request.spec, request.values), map);
    for (double x = 11.0; x < 21.0; x += 0.37) {
      Receiver r;
      r.uv = {static_cast<float>(x / kMomentMapSide), 0.5f};
      r.depth = kFar - 1e-5f;
      ASSERT_NEAR(lookup->at(r).visibility, closer.at(r), 5e-3) << text << " at " << x;
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
    const FilterRequest one = request_blocks(asked), other = request_blocks(given);
    const auto a = prepare_blocks(one, map, Precision::kFloat), b = prepare_blocks(other, map, Precision::kFloat);
    std::mt19937 random(13);
    for (int i = 0; i < 200; ++i) {
      const Receiver r = make_blocks_receiver(random);
      ASSERT_EQ(a->at(r).visibility, b->at(r).visibility) << asked;
      ASSERT_TRUE(std::isfinite(a->at(r).visibility));
    }
  }
}

// Exponential shadow maps where their assumption fails: texels under the kernel lie behind the receiver.

/// Looks up a receiver at depth 0.5 in the middle of a map, of which the left half lies at one depth and the right half
/// at another.
double look_up_between(const std::string& text, float left, float right) {
  constexpr int kHalvesSide = 32;
  DepthMap map{kHalvesSide, {}};
  for (int i = 0; i < kHalvesSide * kHalvesSide; ++i)
    map.stored.push_back(i % kHalvesSide < kHalvesSide / 2 ? left : right);
  const FilterRequest request = Catalogue(SHADOWBENCH_SOURCE_DIR "/filters").parse_requests(text).front();
  const ModelInput input{request.spec, request.values, map, {}, 0};
  Receiver r;
  r.depth = r.depth_unbiased = 0.5f;
  return make_model("esm")->prepare(input, Precision::kDouble)->at(r).visibility;
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
