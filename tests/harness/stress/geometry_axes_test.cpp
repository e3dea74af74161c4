// The axes that draw their own scenes (grazing-light, light-bleeding, kernel-radius, taps), without a GL.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "harness/stress/axis.h"
#include "harness/stress/exhibits.h"
#include "harness/stress/synthetic_scene.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

using ::testing::HasSubstr;

/// NUMBERS: occluders at .1 and .6, half each, receiver at .7.
TEST(LayerStack, Chebyshev_OfTwoOccluders) {
  EXPECT_NEAR(find_chebyshev({{0.1, 0.6}, 0.7}, {0.5, 0.5}), 0.3378, 1e-4);
  const LayerStack stack = make_layer_stack(2, 0.5, 0.2, 0.7);
  EXPECT_NEAR(stack.depths[0], 0.1, 1e-12);
  EXPECT_NEAR(stack.depths[1], 0.6, 1e-12);
}

/// NUMBERS: half the kernel at the receiver's depth.
TEST(LayerStack, Exponential_OfTwoLayers) {
  EXPECT_NEAR(find_exponential({{0.3, 0.7}, 0.7}, {0.5, 0.5}, 5.0), 0.56767, 1e-5);
  EXPECT_NEAR(find_exponential({{0.3, 0.7}, 0.7}, {0.5, 0.5}, 10.0), 0.50916, 1e-5);
}

TEST(LayerScene, SharesAreThoseOfTheFiltersKernel) {
  for (const int radius : {0, 1, 4, 9}) {
    const AxisInputs inputs =
        make_inputs(fmt::format("vsm:radius={},min_variance=0,bleed_reduction=0,slope_variance=0", radius));
    for (const int count : {2, 4, 16}) {
      const LayerStack stack = make_layer_stack(count, 0.2, 0.5, 0.9);
      const LayerScene layers = make_layer_scene(radius, stack);
      const auto seen = make_model_lookup(inputs, inputs.filters[0], filters::Precision::kExtended)(
                            layers.scene, inputs.filters[0].values)
                            .visibility;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_NEAR(std::accumulate(layers.shares[i].begin(), layers.shares[i].end(), 0.0), 1.0, 1e-12);
        EXPECT_NEAR(seen[i], find_chebyshev(stack, layers.shares[i]), 1e-4) << radius << " " << count;
      }
    }
  }
}

TEST(StraightEdge, WithoutAKernel_IsTheRampBetweenTwoTexels) {
  const SyntheticScene scene = make_straight_edge(0.0);
  const auto lit = compare_whole_kernel(scene, filters::Kernel::make_point(filters::Reconstruction::kBilinear));
  for (std::size_t i = 0; i < lit.size(); ++i) {
    const double texels = static_cast<double>(scene.receivers[i].x) * scene.size - 0.5 * scene.size;
    EXPECT_NEAR(lit[i], std::clamp(texels + 0.5, 0.0, 1.0), 1e-4);
  }
  EXPECT_EQ(lit.front(), 0.0);
  EXPECT_EQ(lit.back(), 1.0);
}

/// A kernel that met the border, which is deeper than all else, would light an exponential map up.
TEST(StraightEdge, WidestKernel_StaysWithinTheMap) {
  const AxisInputs inputs = make_inputs(fmt::format("esm:radius={}", kWidestRadius));
  const auto seen = make_model_lookup(inputs, inputs.filters[0], filters::Precision::kExtended)(
                        make_straight_edge(kWidestRadius), inputs.filters[0].values)
                        .visibility;
  for (const double v : seen) EXPECT_NEAR(v, 0.5, 0.02);
}

TEST(StraightEdge, FiltersThatFall_AreBroken_UnlessTheyAreStochastic) {
  const LookupResult falling{{0.0, 0.6, 0.4, 1.0}, 0};
  EXPECT_EQ(judge_edge(falling, falling.visibility, filters::FilterKind::kBound).verdict, Verdict::kBroken);
  EXPECT_EQ(judge_edge(falling, falling.visibility, filters::FilterKind::kComparison).verdict, Verdict::kBroken);
  EXPECT_EQ(judge_edge(falling, falling.visibility, filters::FilterKind::kStochastic).verdict, Verdict::kOk);
}

HeatMap make_heat_map() {
  HeatMap map{"title",
              "note",
              "quantity",
              {"x", {0.0, 10.0}, {0, 10}},
              {"y", {0.0, 4.0}, {0, 4}},
              images::Image(2, 2, 1),
              1.0,
              [](double) { return 2.0; }};
  *map.values.at(1, 0) = 1.0f;  // high x, high y
  return map;
}

/// Counts the columns of a row of the picture in which a colour is reddish, and near black.
std::pair<int, int> count_red_and_black(const images::Image& picture, int row) {
  std::pair<int, int> counts;
  for (int x = picture.width / 4; x < picture.width; ++x) {
    const float* texel = picture.at(x, row);
    counts.first += texel[0] > 2.0f * texel[1] ? 1 : 0;
    counts.second += texel[0] < 0.2f && texel[2] < 0.2f ? 1 : 0;
  }
  return counts;
}

TEST(HeatMap, HighValuesLieAbove_AndTheCurveWhereItSays) {
  const images::Image picture = images::draw_figure(make_figure(make_heat_map()));
  std::vector<int> red_rows, curve_rows;
  for (int y = 0; y < picture.height; ++y) {
    const auto [red, black] = count_red_and_black(picture, y);
    if (red > 400) red_rows.push_back(y);
    if (black > 600) curve_rows.push_back(y);
  }
  ASSERT_FALSE(red_rows.empty() || curve_rows.empty());
  EXPECT_NEAR(static_cast<double>(red_rows.size()), 240.0, 4.0);  // the upper half of the plot
  EXPECT_NEAR(curve_rows.front(), red_rows.back(), 4);            // y = 2 of 4: where that ends
}

/// Every case that runs without a GL keeps to its theory.
TEST(GeometryAxes, Models_MeetTheirTheories) {
  const AxisInputs inputs = make_inputs("none,tent3x3,teach4x4,poisson,vsm:bleed_reduction=0,slope_variance=0,esm");
  for (const char* id : {"light-bleeding", "kernel-radius", "taps"})
    expect_theories_met(choose_axes(id)[0], inputs, Level::kModel, false);
}

Case find_model_case(const std::string& axis, const AxisInputs& inputs, const std::string& variant) {
  for (Case& item : choose_axes(axis)[0].make_cases(inputs))
    if (item.level == Level::kModel && item.variant == variant) return std::move(item);
  ADD_FAILURE() << "no case " << variant;
  return {};
}

/// Half each, first gap 1, second g: 1 / (1 + (1 + 2 g)^2), which is 0.1 at g = 1.
TEST(LightBleeding, TwoOccluders_FollowTheClosedForm) {
  const Case item =
      find_model_case("light-bleeding", make_inputs("vsm:bleed_reduction=0,slope_variance=0"), "2 occluders");
  EXPECT_NEAR(item.theories.at(0).onset.value(), 1.0, 0.01);
  for (const double ratio : {1e-4, 0.01, 0.2, 1.0, 4.0})
    EXPECT_NEAR(item.observe(ratio).measured.value(), 1.0 / (1.0 + std::pow(1.0 + 2.0 * ratio, 2.0)), 2e-3) << ratio;
  EXPECT_EQ(item.observe(0.5).verdict, Verdict::kDegraded);
  EXPECT_EQ(item.observe(2.0).verdict, Verdict::kOk);
}

TEST(LightBleeding, ParametersThatChangeTheFormula_AreNamed) {
  const Axis axis = choose_axes("light-bleeding")[0];
  const Case item = find_model_case("light-bleeding", make_inputs("vsm:bleed_reduction=0.2"), "2 occluders");
  const auto limits = compare(item, find_onsets(item, axis), axis);
  ASSERT_EQ(limits.at(0).agreement, records::StressAgreement::kExplained);
  EXPECT_THAT(limits[0].explanation, HasSubstr("bleed_reduction"));
  for (const char* variant : {"2 occluders", "16 occluders"}) {
    const Case defaults = find_model_case("light-bleeding", make_inputs("vsm"), variant);
    EXPECT_EQ(compare(defaults, find_onsets(defaults, axis), axis).at(0).agreement,
              records::StressAgreement::kExplained)
        << variant;
  }
}

/// An explanation must not cover for numbers that the exact model does not have.
TEST(LightBleeding, WhatTheExactModelDoesNotDo_IsNotExplained) {
  const Case item =
      find_model_case("light-bleeding", make_inputs("vsm:bleed_reduction=0,slope_variance=0"), "2 occluders");
  records::StressCase record;
  record.samples = {{3.0, Verdict::kDegraded, 0.2, ""}};
  EXPECT_EQ(item.explain({item.theories.at(0), 3.0, record}), "");
}

/// 16 bits do not hold exp(80), with or without a kernel.
TEST(KernelRadius, OverflowOfTheStore_IsNotBlamedOnTheRadius) {
  const Axis axis = choose_axes("kernel-radius")[0];
  const Case item = find_model_case("kernel-radius", make_inputs("esm:store=r16f"), "blurred map");
  const auto limits = compare(item, find_onsets(item, axis), axis);
  EXPECT_EQ(limits.at(0).agreement, records::StressAgreement::kExplained);
  EXPECT_THAT(limits[0].explanation, HasSubstr("every value"));
}

TEST(Explain, WhatBreaksWithinTheRange_IsNotBrokenThroughout) {
  const Theory theory;
  records::StressCase record;
  record.samples = {{1.0, Verdict::kOk, 0.0, ""}, {2.0, Verdict::kBroken, {}, "overflow"}};
  record.broken = records::StressOnset{2.0, 1.0, "overflow"};
  EXPECT_EQ(explain_broken_throughout({theory, 2.0, record}), "");
  record.samples.erase(record.samples.begin());
  EXPECT_THAT(explain_broken_throughout({theory, 2.0, record}), HasSubstr("overflow"));
}

TEST(KernelRadius, RadiusZero_IsNamedForWhatItIs) {
  const Axis axis = choose_axes("kernel-radius")[0];
  const records::StressCase disk =
      find_onsets(find_model_case("kernel-radius", make_inputs("poisson"), "disk of comparisons"), axis);
  ASSERT_EQ(disk.notes.size(), 1u);
  EXPECT_THAT(disk.notes[0], HasSubstr("one hardware 2x2 comparison"));
  const records::StressCase blurred =
      find_onsets(find_model_case("kernel-radius", make_inputs("vsm"), "blurred map"), axis);
  ASSERT_EQ(blurred.notes.size(), 1u);
  EXPECT_THAT(blurred.notes[0], HasSubstr("its formula on one texel"));
}

/// Its front matter lists radii 1, 2 and 3, and no other is a filter.
TEST(KernelRadius, ListedRadii_AreTheOnlyOnesAskedFor) {
  const Axis axis = choose_axes("kernel-radius")[0];
  const records::StressCase found =
      find_onsets(find_model_case("kernel-radius", make_inputs("gather_pcf"), "disk of comparisons"), axis);
  ASSERT_EQ(found.samples.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.samples[i].value, static_cast<double>(i + 1));
    EXPECT_LT(found.samples[i].measured.value(), 1e-5);
  }
}

TEST(Taps, MoreOfThem_AreNearerToTheDisk) {
  const AxisInputs inputs = make_inputs("poisson");
  const records::StressCase found =
      find_onsets(find_model_case("taps", inputs, "taps at radius 3"), choose_axes("taps")[0]);
  ASSERT_EQ(found.notes.size(), 1u);
  for (const char* count : {"with 4,", "with 8,", "with 16,", "with 32;"})
    EXPECT_THAT(found.notes[0], HasSubstr(count));
}

TEST(GeometryAxes, FiltersThatTheyHaveNothingToAsk_AreReported) {
  const auto sole = [](const char* axis, const char* filters) {
    return choose_axes(axis)[0].make_cases(make_inputs(filters)).at(0);
  };
  EXPECT_THAT(sole("grazing-light", "vsm").not_available, HasSubstr("kind comparison"));
  EXPECT_THAT(sole("light-bleeding", "none").not_available, HasSubstr("encodes"));
  EXPECT_THAT(sole("kernel-radius", "none").not_available, HasSubstr("radius"));
  EXPECT_THAT(sole("taps", "none").not_available, HasSubstr("taps"));
  EXPECT_THAT(sole("depth-formats", "none").not_available, HasSubstr("no GL"));
}

}  // namespace
}  // namespace shadowbench::stress
