// How the width of penumbrae grows, on ramps of known widths.

#include "reference/metrics/penumbra_growth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace shadowbench::metrics {
namespace {

constexpr int kColumns = 256, kEdge = 32;  // pixels; an edge in the middle of so many
constexpr float kNone = std::numeric_limits<float>::infinity();

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
        width.push_back(past < 0.0 && truth.back() > 0.0f ? static_cast<float>(wide) : kNone);
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
  std::ranges::fill(none.width, kNone);
  EXPECT_FALSE(none.measure());
  Ramps masked(3.0, same);
  std::ranges::fill(masked.mask, std::uint8_t{0});
  EXPECT_FALSE(masked.measure());
}

}  // namespace
}  // namespace shadowbench::metrics
