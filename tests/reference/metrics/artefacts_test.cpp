#include "reference/metrics/artefacts.h"

#include "reference/metrics/map_stability.h"
#include "tests/test_files.h"

namespace shadowbench::metrics {
namespace {

// Rates of the faults that a person sees, over masks made by hand.

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(ArtefactMasks, FollowTheRays) {
  //                                     lit  lit, edge near  turned away  blocked  by a touching one  penumbra  edge of
  //                                     umbra
  const std::vector<std::uint8_t> counts = {1, 1, 0, 1, 1, 1, 1};
  const std::vector<float> area = {1, 1, 1, 0, 0, 0.5f, 0};
  const std::vector<std::uint8_t> area_settled = {1, 1, 1, 1, 0, 0, 0};
  const std::vector<float> around = {1, 0.9f, 1, 0, 0.5f, 0.5f, 0.2f};
  const std::vector<std::uint8_t> around_settled = {1, 0, 1, 1, 0, 0, 0};
  const std::vector<float> blocker = {kInfinity, kInfinity, kInfinity, 30.0f, 1.0f, 1.0f, 30.0f};
  const ArtefactMasks masks = make_artefact_masks({counts, area, area, area_settled, around, around_settled, blocker});
  EXPECT_EQ(masks.acne, (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(masks.leak, (std::vector<std::uint8_t>{0, 0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(masks.contact_gap, (std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0}));
  EXPECT_EQ(masks.wide_gap, (std::vector<std::uint8_t>{0, 0, 0, 1, 0, 0, 1}));
}

/// Two receivers see 0.7 of the light: the horizon hides the rest from the first, a caster a part of it from the other.
TEST(ArtefactMasks, WhatTheReceiversOwnPlaneHides_IsLit) {
  const std::vector<std::uint8_t> ones(2, 1);
  const std::vector<float> area(2, 0.7f), ratio = {1.0f, 0.9f}, around(2, 1.0f), blocker(2, kInfinity);
  EXPECT_EQ(make_artefact_masks({ones, area, ratio, ones, around, ones, blocker}).acne,
            (std::vector<std::uint8_t>{1, 0}));
}

TEST(ArtefactMasks, LeaveOutWhatIsNotSettled) {
  // Lit and blocked receivers, far from any blocker; in turn: all agree, a neighbour differs, the surroundings'
  // neighbours differ, the surroundings themselves do.
  const std::vector<std::uint8_t> counts(8, 1);
  const std::vector<float> area = {1, 1, 1, 1, 0, 0, 0, 0};
  const std::vector<std::uint8_t> area_settled = {1, 0, 1, 1, 1, 0, 1, 1};
  const std::vector<float> around = {1, 1, 1, 0, 0, 0, 0, 1};
  const std::vector<std::uint8_t> around_settled = {1, 1, 0, 1, 1, 1, 0, 1};
  const std::vector<float> blocker(8, 30.0f);
  const ArtefactMasks masks = make_artefact_masks({counts, area, area, area_settled, around, around_settled, blocker});
  EXPECT_EQ(masks.acne, (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(masks.leak, (std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0}));
}

TEST(ArtefactRates, CountFaultsOverTheMask) {
  std::vector<float> image(400, 1.0f);
  std::vector<std::uint8_t> mask(400, 0);
  for (std::size_t i = 0; i < 200; ++i) mask[i] = 1;
  for (std::size_t i = 0; i < 10; ++i) image[i] = 0.2f;
  for (std::size_t i = 300; i < 350; ++i) image[i] = 0.0f;  // outside the mask
  const std::vector<float> lit(400, 1.0f);
  EXPECT_EQ(rate_acne(image, lit, mask), 10.0 / 200.0);
  EXPECT_EQ(rate_leak(image, {}, mask), 1.0);
  image[20] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(rate_acne(image, lit, mask), 11.0 / 200.0) << "what is not finite is at fault";
}

TEST(ArtefactRates, AcneIsDarkerThanTheTruth_NotWhatIsRight) {
  const std::vector<float> area(400, 0.7f);
  const std::vector<std::uint8_t> all(400, 1);
  for (const float right : {0.7f, 1.0f}) EXPECT_EQ(rate_acne(std::vector<float>(400, right), area, all), 0.0) << right;
  EXPECT_EQ(rate_acne(std::vector<float>(400, 0.6f), area, all), 1.0);
}

/// Of 400 receivers: 100 lit by bias alone, 100 a little brighter by it than the limit, 100 lit without it, 100 dark.
TEST(ArtefactRates, WhatOnlyBiasLights_IsNoLeak) {
  std::vector<float> unbiased(400, 0.0f), image(400, 0.0f);
  for (std::size_t i = 0; i < 300; ++i) {
    unbiased[i] = i < 100 ? 0.0f : i < 200 ? 0.08f : 0.2f;
    image[i] = i < 100 ? 0.8f : i < 200 ? 0.12f : 0.8f;
  }
  const std::vector<std::uint8_t> all(400, 1);
  EXPECT_EQ(rate_leak(image, unbiased, all), 200.0 / 400.0);
  EXPECT_EQ(rate_leak(image, {}, all), 300.0 / 400.0) << "without bias it is not known";
  image[399] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(rate_leak(image, unbiased, all), 201.0 / 400.0);
}

TEST(ArtefactRates, OverTooFewReceivers_AreAbsent) {
  std::vector<std::uint8_t> mask(400, 0);
  EXPECT_FALSE(rate_leak(std::vector<float>(400), {}, mask));
  for (std::size_t i = 0; i + 1 < kFewestReceivers; ++i) mask[i] = 1;
  EXPECT_FALSE(rate_leak(std::vector<float>(400), {}, mask));
  mask[399] = 1;
  EXPECT_TRUE(rate_leak(std::vector<float>(400), {}, mask));
}

/// Receivers that something touches, the first `touched` of all; the others have a farther blocker.
ArtefactMasks make_gap_masks(std::size_t touched, std::size_t all) {
  ArtefactMasks masks;
  for (std::size_t i = 0; i < all; ++i) {
    masks.contact_gap.push_back(i < touched ? 1 : 0);
    masks.wide_gap.push_back(i < touched ? 0 : 1);
  }
  return masks;
}

/// Of 400 receivers at a contact: 100 lit without bias, 100 lit by it, 100 dark either way, 100 a little brighter.
TEST(ContactGap, IsWhatBiasLights_NotWhatIsLitWithoutIt) {
  std::vector<float> unbiased(400, 0.0f), image(400, 0.0f);
  for (std::size_t i = 0; i < 400; ++i) {
    if (i < 100) unbiased[i] = image[i] = 0.8f;
    if (i >= 100 && i < 200) image[i] = 1.0f;
    if (i >= 300) image[i] = 0.3f;
  }
  const ArtefactMasks all = make_gap_masks(400, 400);
  EXPECT_EQ(rate_contact_gap(image, unbiased, all), 100.0 / 300.0);
  EXPECT_EQ(rate_contact_gap(unbiased, unbiased, all), 0.0) << "a blur is no gap";
  image[399] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(rate_contact_gap(image, unbiased, all), 101.0 / 300.0);
  EXPECT_FALSE(rate_contact_gap(image, std::vector<float>(400, 0.6f), all)) << "nothing is dark without bias";
  EXPECT_FALSE(rate_contact_gap(image, {}, all)) << "what bias lights is not known";
}

TEST(ContactGap, WiderThanAContact_IsCountedWhereBiasLights) {
  const std::vector<float> unbiased(400, 0.0f);
  std::vector<float> image(400, 0.0f);
  std::fill(image.begin() + 150, image.begin() + 250, 1.0f);
  EXPECT_EQ(rate_contact_gap(image, unbiased, make_gap_masks(200, 400)), 50.0 / 200.0) << "50 are too few for a gap";
  EXPECT_EQ(rate_contact_gap(image, unbiased, make_gap_masks(150, 400)), 100.0 / 250.0);
  EXPECT_EQ(rate_contact_gap(image, unbiased, make_gap_masks(0, 400)), 1.0) << "nothing touches, all gaps are wide";
  image[150] = 0.0f;
  EXPECT_FALSE(rate_contact_gap(image, unbiased, make_gap_masks(99, 400))) << "99 of either kind";
  EXPECT_FALSE(rate_contact_gap(unbiased, unbiased, make_gap_masks(0, 400))) << "nor is the absence of wide gaps known";
}

/// A penumbra of 40 x 40 pixels whose percentage-closer filter is a ramp, and an image that differs by `noise(x, y)`.
template <class Noise>
std::optional<double> measure_noise(Noise noise) {
  constexpr int kSide = 40;
  std::vector<float> image, kernel(kSide * kSide, 0.5f);
  std::vector<double> closer;
  for (int i = 0; i < kSide * kSide; ++i) {
    closer.push_back(static_cast<double>(i % kSide) / kSide);
    image.push_back(static_cast<float>(closer.back() + noise(i % kSide, i / kSide)));
  }
  return rate_noise(image, closer, kernel, std::vector<std::uint8_t>(image.size(), 1), kSide);
}

TEST(NoiseRate, IsZero_WhereTheImageIsItsPercentageCloserFilter) {
  EXPECT_EQ(measure_noise([](int, int) { return 0.0; }), 0.0);
  EXPECT_EQ(measure_noise([](int x, int) { return 0.01 * x; }), 0.0) << "a smooth difference is not noise";
  EXPECT_EQ(measure_noise([](int, int) { return 0.6; }), 0.0) << "nor is the same one everywhere";
}

TEST(NoiseRate, CountsWhatDiffersFromItsNeighbours) {
  // One pixel in a 4 x 4 block is off by 0.09: by 0.08 from its window's mean, its neighbours by 0.01.
  const auto rate = measure_noise([](int x, int y) { return x % 4 == 1 && y % 4 == 1 ? 0.09 : 0.0; });
  ASSERT_TRUE(rate);
  EXPECT_NEAR(*rate, 100.0 / (38.0 * 38.0), 1e-12);
}

TEST(NoiseRate, LeavesOutPixelsBesideOnesThatDoNotCount) {
  constexpr std::size_t kSide = 40;
  std::vector<float> image(kSide * kSide, 0.5f);
  std::vector<std::uint8_t> counts(image.size(), 1);
  for (std::size_t i = 0; i < image.size(); i += kSide) {
    image[i + 20] = 1.0f;  // the filter is not asked there
    counts[i + 20] = 0;
  }
  const std::vector<double> closer(image.size(), 0.5);
  EXPECT_EQ(rate_noise(image, closer, std::vector<float>(image.size(), 0.5f), counts, kSide), 0.0);
}

TEST(NoiseRate, WithoutPenumbra_IsAbsent) {
  const std::vector<float> lit(1600, 1.0f);
  EXPECT_FALSE(rate_noise(lit, std::vector<double>(1600, 1.0), lit, std::vector<std::uint8_t>(1600, 1), 40));
}

/// Two layers that show 0.75 and `second`, of which the second takes over from column 16 on, over so many columns, in a
/// picture of 64 columns drawn `scale` times as wide.
std::optional<double> measure_two_layers(float second, int columns, int scale = 1) {
  const int width = 64 * scale, height = 128;
  std::vector<float> shares[2];
  for (int i = 0; i < width * height; ++i) {
    const double x = (i % width + 0.5) / scale;
    shares[1].push_back(static_cast<float>(std::clamp((x - 16.0) / columns, 0.0, 1.0)));
    shares[0].push_back(1.0f - shares[1].back());
  }
  const std::vector<float> images[] = {std::vector<float>(shares[0].size(), 0.75f),
                                       std::vector<float>(shares[0].size(), second)};
  const LayerImage layers[] = {{images[0], shares[0]}, {images[1], shares[1]}};
  return measure_seam(layers, width, [](std::size_t, std::size_t) { return true; });
}

TEST(Seam, IsTheStepBetweenLayers_SmallerTheWiderTheyAreBlended) {
  EXPECT_NEAR(measure_two_layers(0.25f, 20).value(), 0.5 / 20.0, 2e-3);
  EXPECT_LT(measure_two_layers(0.25f, 20).value(), 0.6 * measure_two_layers(0.25f, 10).value());
  EXPECT_NEAR(measure_two_layers(0.75f, 1).value(), 0.0, 1e-6) << "layers that agree have no seam";
}

TEST(Seam, IsTheSameInALargerPicture) {
  for (const int columns : {1, 4, 20})
    EXPECT_NEAR(measure_two_layers(0.25f, columns, 10).value() / measure_two_layers(0.25f, columns, 30).value(), 1.0,
                0.02)
        << columns;
}

TEST(Seam, IsAbsent_WhereNoLayerTakesOver) {
  const std::vector<float> image(4096, 0.5f), whole(4096, 1.0f), none(4096, 0.0f);
  const LayerImage layers[] = {{image, whole}, {image, none}};
  EXPECT_FALSE(measure_seam(layers, 64, [](std::size_t, std::size_t) { return true; }));
}

// How the width of penumbrae grows, on ramps of known widths.

constexpr int kColumns = 256, kEdge = 32;  // pixels; an edge in the middle of so many

/// Edges that are wider from row to row of tiles: of a light that rays trace, and of a filter.
struct Ramps {
  std::vector<float> truth, image, width;
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(kColumns * kColumns, 1);

  /// `width_of` makes the filter's widths of the truth's, from `narrowest` to 15 pixels; `noise` is added to it.
  Ramps(double narrowest, const std::function<double(double)>& width_of, double noise = 0.0) {
    for (int y = 0; y < kColumns; ++y) {
      const int row = y / kGrowthLimits.tile_pixels;
      const double wide = narrowest * std::pow(15.0 / narrowest, row / 15.0);
      for (int x = 0; x < kColumns; ++x) {
        const double past = x % kEdge + 0.5 - kEdge / 2;
        const auto ramp = [&](double across) { return std::clamp(0.5 + past / across, 0.0, 1.0); };
        const double sign = (x * 7 + y * 13) % 2 == 0 ? 1.0 : -1.0;
        const double seen = ramp(width_of(wide));
        truth.push_back(static_cast<float>(ramp(wide)));
        image.push_back(static_cast<float>(seen + sign * noise * 4.0 * seen * (1.0 - seen)));
        width.push_back(past < 0.0 && truth.back() > 0.0f ? static_cast<float>(wide) : kInfinity);
      }
    }
  }

  std::optional<double> measure(double texel = 1.0) const {
    const std::span<const float> images[] = {image};
    return measure_penumbra_growth(
        {.images = images, .truth = truth, .mask = mask, .width_ws = width, .texel_ws = texel, .columns = kColumns});
  }
};

TEST(PenumbraGrowth, IsTheSlopeOverTheTruthsWidth) {
  const auto grows = [](const std::function<double(double)>& width_of) { return *Ramps(3.0, width_of).measure(); };
  EXPECT_NEAR(grows([](double width) { return width; }), 1.0, 1e-9);
  EXPECT_NEAR(grows([](double width) { return 0.7 * width; }), 0.7, 0.02);
  EXPECT_NEAR(grows([](double) { return 8.0; }), 0.0, 0.02);
  EXPECT_NEAR(grows([](double) { return 1e-3; }), 0.0, 0.02) << "hard";
  EXPECT_NEAR(grows([](double width) { return 18.0 - width; }), -1.0, 0.05);
}

TEST(PenumbraGrowth, NoiseDoesNotChangeIt) {
  EXPECT_NEAR(*Ramps(
                   3.0, [](double width) { return width; }, 0.1)
                   .measure(),
              1.0, 0.05);
  EXPECT_NEAR(*Ramps(
                   3.0, [](double) { return 8.0; }, 0.1)
                   .measure(),
              0.0, 0.05);
}

TEST(PenumbraGrowth, WhatAFilterCutsAtItsWidest_DoesNotCount) {
  const double texel = 0.4;
  EXPECT_NEAR(
      *Ramps(3.0, [&](double width) { return std::min(width, kGrowthLimits.most_texels * texel); }).measure(texel), 1.0,
      1e-9);
}

TEST(PenumbraGrowth, NeedsPenumbraeOfDifferentWidths_AboveThoseOfTexels) {
  const auto same = [](double width) { return width; };
  EXPECT_FALSE(Ramps(13.0, same).measure());
  EXPECT_FALSE(Ramps(3.0, same).measure(4.0))
      << "wide enough for the map's texels from 8 pixels on: less than a factor of 2";
  Ramps none(3.0, same);
  std::ranges::fill(none.width, kInfinity);
  EXPECT_FALSE(none.measure());
  Ramps masked(3.0, same);
  std::ranges::fill(masked.mask, std::uint8_t{0});
  EXPECT_FALSE(masked.measure());
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(TexelHealth, CountsTexels_NotChannels) {
  const std::vector<float> values = {1.0f, kInfinity, kInfinity, -kInfinity, kNan, kInfinity, 2.0f, -3.0f};
  const TexelHealth health = check_texels({values, 2, 65504.0, false});
  EXPECT_EQ(health.texels, 4);
  EXPECT_EQ(health.overflowed, 2);
  EXPECT_EQ(health.nan, 1);
  EXPECT_EQ(health.broken(), 3);
  EXPECT_FALSE(health.largest) << "an overflowed map has no largest number";
  EXPECT_FALSE(health.negative_variance);
}

TEST(TexelHealth, LargestIsAMagnitude) {
  const std::vector<float> values = {1.0f, -3.0f, 2.0f};
  EXPECT_EQ(check_texels({values, 1, 65504.0, false}).largest, 3.0);
}

/// The warp of an exponential-variance map in both directions: two pairs, each with a variance.
TEST(TexelHealth, VarianceOfEveryPair_IsCounted) {
  const std::vector<float> values = {0.5f, 0.25f, 0.5f, 0.26f, 0.5f, 0.25f, 0.5f, 0.24f, 0.5f, 0.2f, kNan, 0.0f};
  const TexelHealth health = check_texels({values, 4, 65504.0, true});
  EXPECT_EQ(health.negative_variance, 1) << "the second; the third is NaN";
  EXPECT_FLOAT_EQ(static_cast<float>(*health.lowest_variance), 0.24f - 0.25f);
  const std::vector<float> variance = measure_variance({values, 4, 65504.0, true});
  EXPECT_FLOAT_EQ(variance[0], 0.0f);
  EXPECT_FLOAT_EQ(variance[1], 0.24f - 0.25f);
  EXPECT_TRUE(std::isnan(variance[2]));
}

/// A GL may saturate half floats instead of making them infinite; after the blur nothing looks wrong any more.
TEST(TexelHealth, Saturation_IsOverflow_AndReachesAsFarAsTheBlur) {
  std::vector<float> before(49, 1.0f), blurred(49, 900.0f);
  before[3 * 7 + 1] = 65504.0f;
  StoredMap map{blurred, 1, 65504.0, false, before, 2};
  const TexelHealth health = check_texels(map);
  EXPECT_EQ(health.overflowed, 4 * 5) << "columns 0 to 3 of rows 1 to 5";
  EXPECT_FALSE(health.largest);
  const std::vector<float> headroom = measure_headroom(map);
  EXPECT_EQ(headroom[5 * 7 + 3], -kInfinity);
  EXPECT_NEAR(headroom[5 * 7 + 4], std::log(65504.0 / 900.0), 1e-4);
  EXPECT_GT(headroom[6 * 7], 0.0f);
  map.before_blur[3 * 7 + 1] = 65472.0f;
  EXPECT_EQ(check_texels(map).overflowed, 0);
  map.border = {65504.0f};
  EXPECT_EQ(check_texels(map).overflowed, 49 - 3 * 3) << "all whose blur reads what lies outside";
}

/// The two limits that everybody quotes: 11.09 in 16 bits, 88.72 in 32.
TEST(Headroom, OfOne_IsTheLargestExponent) {
  const std::vector<float> values = {1.0f, std::exp(4.0f), 0.0f, kInfinity, kNan};
  const std::vector<float> half = measure_headroom({values, 1, 65504.0, false});
  EXPECT_NEAR(half[0], 11.09f, 0.005f);
  EXPECT_NEAR(half[1], 7.09f, 0.005f);
  EXPECT_EQ(half[2], kInfinity);
  EXPECT_EQ(half[3], -kInfinity);
  EXPECT_TRUE(std::isnan(half[4]));
  EXPECT_NEAR(measure_headroom({values, 1, static_cast<double>(std::numeric_limits<float>::max()), false})[0], 88.72f,
              0.005f);
}

TEST(Bound, Darker_IsAViolationOnlyBeyondTheTolerance) {
  const std::vector<float> image = {0.5f, 0.5f, 0.5f, 0.7f, 0.1f, kNan};
  const std::vector<double> model = {0.6, 0.5, 0.6, 0.6, 0.1, 0.6}, closer(6, 0.6);
  const std::vector<double> tolerance = {0.2, 0.05, std::nan(""), 0.0, HUGE_VAL, 0.0};
  const BoundCheck check = check_bound({image, model, closer, tolerance});
  EXPECT_EQ(check.receivers, 4) << "neither the one without a receiver nor the one that is NaN";
  EXPECT_EQ(check.violations, 1);
  EXPECT_EQ(check.exact_violations, 2) << "the second and the fifth, whose models are darker too";
  EXPECT_NEAR(check.shortfall_max, 0.5, 1e-6);
  EXPECT_THAT(check.shortfall, ElementsAre(::testing::FloatNear(0.1f, 1e-6f), ::testing::FloatNear(0.1f, 1e-6f), 0.0f,
                                           0.0f, ::testing::FloatNear(0.5f, 1e-6f), 0.0f));
  EXPECT_THAT(check.violation, ElementsAre(0.0f, ::testing::FloatNear(0.05f, 1e-6f), 0.0f, 0.0f, 0.0f, 0.0f));
}

}  // namespace
}  // namespace shadowbench::metrics
