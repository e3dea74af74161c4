// Where the numbers of real maps break, and that the defaults of every filter stay clear of it on every built-in scene.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "harness/measure/stability_meter.h"
#include "harness/run/run_plan.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

/// Draws cells with stability, without timing or truth to speak of.
std::vector<measure::MeasuredCell> measure(const std::string& scene_name, const std::string& filters,
                                           int map_size = 512, int width = 240, int height = 135) {
  static measure::Renderer renderer = measure::make_renderer(gl::Backend::kAuto, options::find_resources());
  renderer.context->make_current();
  const scene::Scene scene = load_builtin(scene_name);
  options::RunOptions options;
  options.resources = options::find_resources();
  options.filters = catalogue().parse_requests(filters);
  options.width = width;
  options.height = height;
  options.rounds = options::RoundLimits::exactly(1);
  options.phases = 1;  // numbers are looked at in the first of them alone
  options.reference = catalogue().parse_requests("none").front();
  options.truth = false;
  options.stability = true;
  truth::TruthCache cache({}, [](const std::string&) {});
  measure::SceneAssets assets(renderer, options, scene, cache, measure::largest_padding_texels(options.filters));
  const measure::SceneTask task{&scene, &scene.cameras.front(), map_size, options.filters};
  return measure::measure_scene({renderer, options, task, assets}).cells;
}

class Defaults : public ::testing::TestWithParam<std::string> {};

TEST_P(Defaults, NothingBreaks) {
  for (const measure::MeasuredCell& cell : measure(GetParam(), "")) {
    SCOPED_TRACE(cell.label);
    EXPECT_TRUE(std::all_of(cell.visibility.texels.begin(), cell.visibility.texels.end(),
                            [](float v) { return std::isfinite(v); }));
    EXPECT_EQ(cell.record.nan, 0);
    EXPECT_TRUE(cell.record.warnings.empty()) << cell.record.warnings.front();
    const records::StabilityRecord& s = cell.record.stability;
    EXPECT_EQ(s.overflow_texels.value_or(0), 0);
    EXPECT_EQ(s.nan_texels.value_or(0), 0);
    EXPECT_EQ(s.bound_violations.value_or(0), 0);
    EXPECT_EQ(s.bound_exact_violations.value_or(0), 0);
    if (s.negative_variance_texels) {
      std::printf(
          "%s %s: %lld of %d texels with a variance below 0, the lowest %.3g; shortfall of the bound %.3g, 16 bits "
          "change %.3g\n",
          GetParam().c_str(), cell.label.c_str(), static_cast<long long>(*s.negative_variance_texels), 512 * 512,
          *s.lowest_variance, s.bound_shortfall_max.value_or(0.0), s.half_difference_max.value_or(0.0));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Defaults, ::testing::ValuesIn(builtin_scenes()));

/// The famous limits, on a map that the GL made: 11.09 in 16 bits and 88.72 in 32, over the largest depth, which is 1.
TEST(Stability, SafeExponents_AreTheTheoreticalOnes) {
  const auto cells = measure("cubes", "esm:c=2000,store=r16f,esm:c=8,store=r16f,esm:c=2000,esm:c=40,combine=log", 128);
  ASSERT_EQ(cells.size(), 4u);
  for (const std::size_t half : {0u, 1u}) EXPECT_NEAR(*cells[half].record.stability.safe_exponent, 11.09, 0.01 * 11.09);
  EXPECT_NEAR(*cells[2].record.stability.safe_exponent, 88.72, 0.001 * 88.72);
  EXPECT_FALSE(cells[3].record.stability.safe_exponent) << "logarithms do not overflow";
  EXPECT_GT(cells[0].record.stability.overflow_texels, 0);
  EXPECT_FALSE(cells[0].record.stability.headroom);
  EXPECT_NEAR(*cells[1].record.stability.headroom, 11.09 - 8.0, 0.01);
  EXPECT_EQ(cells[1].record.stability.overflow_texels, 0);
}

/// Counts and pictures say the same.
TEST(Stability, Images_HoldWhatIsCounted) {
  const auto cells = measure("stack", "vsm:store=rg16f,esm:c=20,store=r16f", 256);
  const auto count = [](const images::Image& image, auto&& is) {
    return std::count_if(image.texels.begin(), image.texels.end(), is);
  };
  const records::StabilityRecord &vsm = cells[0].record.stability, &esm = cells[1].record.stability;
  EXPECT_GT(vsm.negative_variance_texels, 0);
  EXPECT_EQ(count(
                cells[0].stability.variance, [](float v) { return v < 0.0f; }),
            *vsm.negative_variance_texels);
  EXPECT_EQ(count(cells[1].stability.headroom, [](float v) { return std::isinf(v) && v < 0.0f; }),
            *esm.overflow_texels);
  EXPECT_TRUE(cells[1].stability.variance.empty());
  EXPECT_GT(*esm.bound_violations, 0) << "an overflow is no rounding";
  EXPECT_GT(vsm.half_difference_max, 0.01);
  EXPECT_GT(count(cells[0].stability.half_difference, [](float v) { return std::abs(v) > 0.01f; }), 0);
}

/// The same whichever of the two stores the cell itself has.
TEST(Stability, HalfDifference_IsHalfLessSingle) {
  const auto cells = measure("stack", "vsm:store=rg16f,vsm:store=rg32f", 256);
  EXPECT_EQ(cells[0].record.stability.half_difference_max, cells[1].record.stability.half_difference_max);
  EXPECT_EQ(cells[0].stability.half_difference.texels, cells[1].stability.half_difference.texels);
  std::vector<float> difference = cells[0].visibility.texels;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= cells[1].visibility.texels[i];
  EXPECT_EQ(cells[0].stability.half_difference.texels, difference);
}

/// Light-bleeding reduction gives the bound up, and says so; a filter that promises it still is held to it.
TEST(Stability, ReducedBleeding_IsNoBound) {
  const auto cells = measure("stack", "vsm,vsm:bleed_reduction=0,pcf2x2", 512);
  EXPECT_FALSE(cells[0].record.stability.bound_violations);
  EXPECT_EQ(cells[0].record.absent.at("stability.bound_violations"),
            "the filter is a bound with bleed_reduction=0 only");
  EXPECT_EQ(cells[1].record.stability.bound_violations, 0);
  EXPECT_FALSE(cells[2].record.stability.bound_violations);
  EXPECT_EQ(cells[2].record.absent.count("stability.bound_violations"), 1u);
}

}  // namespace
}  // namespace shadowbench::test
