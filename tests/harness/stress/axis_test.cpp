// The axes without a GL.

#include "harness/stress/axis.h"

#include <numeric>

#include "filters/model.h"
#include "harness/stress/synthetic_scene.h"
#include "tests/harness/stress/stress_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::stress {
namespace {

/// Gives the message of the usage error that a range is refused with.
std::string refuse(const std::string& range, const std::string& axes = "") {
  std::vector<Axis> chosen = choose_axes(axes);
  const Error error = error_of([&] { apply_range(chosen, range); });
  EXPECT_EQ(error.kind(), ErrorKind::kUsage);
  EXPECT_THAT(error.message(), Not(HasSubstr("\n")));
  return error.message();
}

TEST(AxisTable, EveryAxisSaysWhatItIs) {
  ASSERT_FALSE(axis_table().empty());
  for (const Axis& axis : axis_table()) {
    SCOPED_TRACE(axis.id);
    for (const std::string* text : {&axis.id, &axis.title, &axis.quantity, &axis.measured, &axis.broken_when})
      EXPECT_NE(*text, "");
    EXPECT_LT(axis.range.low, axis.range.high);
    EXPECT_LE(axis.limits.low, axis.range.low);
    EXPECT_GE(axis.limits.high, axis.range.high);
    EXPECT_TRUE(!axis.log || axis.limits.low > 0.0);
    EXPECT_GE(axis.coarse_samples, 2);
    EXPECT_TRUE(axis.make_cases);
  }
}

TEST(AxisTable, EveryCaseObserves_OrSaysWhyNot) {
  const AxisInputs inputs = make_inputs();
  for (const Axis& axis : axis_table()) {
    const std::vector<Case> cases = axis.make_cases(inputs);
    EXPECT_FALSE(cases.empty()) << axis.id;
    for (const Case& item : cases) {
      EXPECT_NE(item.observe == nullptr, item.not_available.empty()) << axis.id << " " << item.variant;
      EXPECT_NE(item.variant, "") << axis.id;
      for (const Theory& theory : item.theories)
        EXPECT_FALSE(theory.formula.empty() || theory.source.empty()) << axis.id << " " << item.variant;
    }
  }
}

/// What a filter declares of its map is what some axis drives.
TEST(AxisTable, DeclaredParameters_AreDriven) {
  for (const filters::FilterRequest& request : make_inputs("all,teaching").filters) {
    const filters::FilterSpec& spec = request.spec;
    for (const std::string& declared : {spec.exponent, spec.variance_floor}) {
      const auto drives = [&](const Axis& axis) { return axis.driven_param && axis.driven_param(spec) == declared; };
      EXPECT_TRUE(declared.empty() || std::ranges::any_of(axis_table(), drives)) << spec.id << ":" << declared;
    }
  }
}

TEST(ChooseAxes, TakesThoseNamed_InThatOrder) {
  const auto axes = choose_axes("warp-exponent,esm-exponent");
  ASSERT_THAT(axes, SizeIs(2));
  EXPECT_EQ(axes[0].id, "warp-exponent");
  EXPECT_THAT(choose_axes(""), SizeIs(axis_table().size()));
}

TEST(ChooseAxes, UnknownOnes_AreRefusedWithTheNearest) {
  for (const auto& [text, word] : {std::pair("esm-exponnet", "did you mean 'esm-exponent'"),
                                   std::pair("zzz", "known: "), std::pair("esm-exponent,esm-exponent", "twice")}) {
    const std::string message = error_of([&, text = text] { choose_axes(text); }).message();
    EXPECT_THAT(message, AllOf(HasSubstr("--axes"), HasSubstr(word)));
  }
}

TEST(ApplyRange, SetsTheRangeOfItsAxisAlone) {
  std::vector<Axis> axes = choose_axes("");
  apply_range(axes, "esm-exponent=10,2e2");
  for (const Axis& axis : axes) {
    const bool set = axis.id == "esm-exponent";
    EXPECT_EQ(axis.range.low == 10.0 && axis.range.high == 200.0, set) << axis.id;
  }
}

TEST(ApplyRange, BadRanges_AreRefusedInOneLine) {
  EXPECT_THAT(refuse("esm-exponent=10,10"), AllOf(HasSubstr("empty"), HasSubstr("esm-exponent=10,10")));
  EXPECT_THAT(refuse("esm-exponent=200,10"), AllOf(HasSubstr("reversed"), HasSubstr("write esm-exponent=10,200")));
  EXPECT_THAT(refuse("esm-exponent=nan,10"), HasSubstr("'nan'"));
  EXPECT_THAT(refuse("esm-exponent=1,inf"), AllOf(HasSubstr("'inf'"), HasSubstr("finite number")));
  EXPECT_THAT(refuse("esm-exponent=1e999,2"), HasSubstr("'1e999'"));
  EXPECT_THAT(refuse("esm-exponent=ten,20"), HasSubstr("'ten'"));
  EXPECT_THAT(refuse("esm-exponent=,20"), HasSubstr("''"));
  EXPECT_THAT(refuse("esm-exponent=10,20,30"), HasSubstr("'20,30'"));
  EXPECT_THAT(refuse("esm-exponent=10"), HasSubstr("AXIS=LO,HI"));
  EXPECT_THAT(refuse("esm-exponent"), HasSubstr("AXIS=LO,HI"));
  EXPECT_THAT(refuse("esm-exponent=-5,10"), AllOf(HasSubstr("beyond"), HasSubstr("1 .. 1e+06")));
  EXPECT_THAT(refuse("esm-exponent=1,1e9"), HasSubstr("beyond"));
  EXPECT_THAT(refuse("esm-exp=1,10"), HasSubstr("did you mean 'esm-exponent'"));
  EXPECT_THAT(refuse("esm-exponent=1,10", "warp-exponent"),
              AllOf(HasSubstr("not among --axes"), HasSubstr("esm-exponent")));
}

TEST(Driven, ComesFromTheFrontMatter_AndKeepsTheUsersValues) {
  const Axis axis = choose_axes("esm-exponent")[0];
  const AxisInputs inputs = make_inputs("vsm,esm:radius=3");
  EXPECT_EQ(axis.driven_param(inputs.filters[0].spec), "");
  EXPECT_EQ(axis.driven_param(inputs.filters[1].spec), "c");
  for (const Case& item : axis.make_cases(inputs)) {
    EXPECT_EQ(item.filter, "esm");
    const bool blurs = item.variant.find("no blur") == std::string::npos;
    EXPECT_TRUE(!item.is_available() || !blurs || filters::number(item.params, "radius") == 3.0) << item.variant;
  }
  EXPECT_THAT(list_choices(inputs.filters[1], "store"), ElementsAre("r32f", "r16f"));
  EXPECT_THAT(list_choices(make_inputs("esm:store=r16f").filters[0], "store"), ElementsAre("r16f"));
  EXPECT_THAT(list_choices(inputs.filters[1], "nothing"), SizeIs(0));
}

TEST(Driven, WithoutAGl_GlCasesSayThatThereIsNone) {
  for (const char* id : {"esm-exponent", "map-size"})
    for (const Case& item : choose_axes(id)[0].make_cases(make_inputs("none,vsm,esm")))
      EXPECT_EQ(item.not_available.find("no GL") != std::string::npos, item.level == Level::kGl)
          << id << " " << item.variant;
}

TEST(DescribeAxes, NamesThemAll) {
  const std::string text = describe_axes(make_inputs().filters);
  for (const Axis& axis : axis_table()) EXPECT_THAT(text, HasSubstr(axis.id));
  EXPECT_THAT(text, AllOf(HasSubstr("esm:c"), HasSubstr("vsm:min_variance")));
}

/// Every case that runs without a GL keeps to its theory, or says why not.
TEST(Axes, ModelsAndArithmetic_MeetTheirTheories) {
  const AxisInputs inputs = make_inputs("vsm,esm,vsm_sat,vssm");
  for (const char* id : {"esm-exponent", "vsm-cancellation"})
    expect_theories_met(choose_axes(id)[0], inputs, Level::kModel, true);
  for (const char* id : {"warp-exponent", "vsm-cancellation"})
    expect_theories_met(choose_axes(id)[0], inputs, Level::kArithmetic, true);
}

/// The case of an axis that has this variant and level.
Case find_case(const std::string& axis, const std::string& variant, Level level,
               const std::string& filters = "vsm,esm") {
  for (Case& item : choose_axes(axis)[0].make_cases(make_inputs(filters)))
    if (item.variant == variant && item.level == level) return std::move(item);
  ADD_FAILURE() << "no case " << variant;
  return {};
}

/// The papers' limits of the second moment of a warp on [-1,1]; a 16-bit map at exponent 10 is far beyond its own.
TEST(WarpExponent, OverflowsWhereTheSecondMomentDoes) {
  const Axis axis = choose_axes("warp-exponent")[0];
  for (const auto& [variant, limit] :
       {std::pair("32-bit float, one second moment", 44.36), std::pair("16-bit float, one second moment", 5.545),
        std::pair("32-bit float, sum of 81 second moments", 42.16)}) {
    EXPECT_NEAR(find_onsets(find_case("warp-exponent", variant, Level::kArithmetic), axis).broken->value / limit, 1.0,
                0.011)
        << variant;
  }
  EXPECT_EQ(find_case("warp-exponent", "16-bit float, one second moment", Level::kArithmetic).observe(10.0).verdict,
            Verdict::kBroken);
}

/// NUMBERS: the variance of a constant depth that should be 0 reaches 7.2e-4 in 16-bit floats, 2.3e-5 in UNORM16.
TEST(VsmCancellation, Wall_LeaksByTheVarianceThatIsNotThere) {
  const Observation half =
      find_case("vsm-cancellation", "16-bit float, 81 taps of one depth, no minimum", Level::kArithmetic)
          .observe(std::sqrt(1.0 / 7.2e-4));
  EXPECT_NEAR(*half.measured, 0.5, 0.06);
  const Observation unorm =
      find_case("vsm-cancellation", "16-bit unorm, 81 taps of one depth, no minimum", Level::kArithmetic)
          .observe(std::sqrt(1.0 / 2.3e-5));
  EXPECT_NEAR(*unorm.measured, 0.5, 0.06);
}

/// The bound on the table's roundings holds, and is no more than a factor of 3 away.
TEST(VsmCancellation, SummedAreaTable_DegradesWithinItsBound_AndNearIt) {
  const Axis axis = choose_axes("vsm-cancellation")[0];
  for (const char* filter : {"vsm_sat", "vsm_sat:radius=31", "vssm", "vssm:max_radius=30"}) {
    const Case item = find_case("vsm-cancellation", "rg32f, min_variance 0", Level::kModel, filter);
    const double ratio = find_onsets(item, axis).degraded->value / *item.theories.at(0).onset;
    EXPECT_GT(ratio, 1.0) << filter;
    EXPECT_LT(ratio, 3.0) << filter;
  }
}

/// Boxes of 9 texels leave a texel 24 bits, boxes of 65 texels 4e9 / 65^2 steps: half a step is 8.9 roundings then.
TEST(VsmCancellation, SummedAreaTable_LosesBitsWithItsArea) {
  const auto theory = [](const char* filter) {
    return *find_case("vsm-cancellation", "rg32f, min_variance 0", Level::kModel, filter).theories.at(0).onset;
  };
  const double rounding = 0x1p-24, all_others = 13.5 * rounding;
  EXPECT_NEAR(theory("vsm_sat") / theory("vsm_sat:radius=31"),
              std::sqrt((all_others + 0.5 / 946745.0) / (all_others + 0.5 * rounding)), 1e-3);
}

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

/// Every case that runs without a GL keeps to its theory.
TEST(GeometryAxes, Models_MeetTheirTheories) {
  const AxisInputs inputs = make_inputs("none,tent3x3,teach4x4,poisson,vsm:bleed_reduction=0,slope_variance=0,esm");
  for (const char* id : {"light-bleeding", "kernel-radius", "taps"})
    expect_theories_met(choose_axes(id)[0], inputs, Level::kModel, false);
}

/// Half each, first gap 1, second g: 1 / (1 + (1 + 2 g)^2), which is 0.1 at g = 1.
TEST(LightBleeding, TwoOccluders_FollowTheClosedForm) {
  const Case item = find_case("light-bleeding", "2 occluders", Level::kModel, "vsm:bleed_reduction=0,slope_variance=0");
  EXPECT_NEAR(item.theories.at(0).onset.value(), 1.0, 0.01);
  for (const double ratio : {1e-4, 0.01, 0.2, 1.0, 4.0})
    EXPECT_NEAR(item.observe(ratio).measured.value(), 1.0 / (1.0 + std::pow(1.0 + 2.0 * ratio, 2.0)), 2e-3) << ratio;
  EXPECT_EQ(item.observe(0.5).verdict, Verdict::kDegraded);
  EXPECT_EQ(item.observe(2.0).verdict, Verdict::kOk);
}

TEST(LightBleeding, ParametersThatChangeTheFormula_AreNamed) {
  const Axis axis = choose_axes("light-bleeding")[0];
  const Case item = find_case("light-bleeding", "2 occluders", Level::kModel, "vsm:bleed_reduction=0.2");
  const auto limits = compare(item, find_onsets(item, axis), axis);
  ASSERT_EQ(limits.at(0).agreement, records::StressAgreement::kExplained);
  EXPECT_THAT(limits[0].explanation, HasSubstr("bleed_reduction"));
  for (const char* variant : {"2 occluders", "16 occluders"}) {
    const Case defaults = find_case("light-bleeding", variant, Level::kModel, "vsm");
    EXPECT_EQ(compare(defaults, find_onsets(defaults, axis), axis).at(0).agreement,
              records::StressAgreement::kExplained)
        << variant;
  }
}

/// An explanation must not cover for numbers that the exact model does not have.
TEST(LightBleeding, WhatTheExactModelDoesNotDo_IsNotExplained) {
  const Case item = find_case("light-bleeding", "2 occluders", Level::kModel, "vsm:bleed_reduction=0,slope_variance=0");
  records::StressCase record;
  record.samples = {{3.0, Verdict::kDegraded, 0.2, ""}};
  EXPECT_EQ(item.explain({item.theories.at(0), 3.0, record}), "");
}

/// 16 bits do not hold exp(80), with or without a kernel.
TEST(KernelRadius, OverflowOfTheStore_IsNotBlamedOnTheRadius) {
  const Axis axis = choose_axes("kernel-radius")[0];
  const Case item = find_case("kernel-radius", "blurred map", Level::kModel, "esm:store=r16f");
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

/// Its front matter lists radii 1, 2 and 3, and no other is a filter.
TEST(KernelRadius, ListedRadii_AreTheOnlyOnesAskedFor) {
  const Axis axis = choose_axes("kernel-radius")[0];
  const records::StressCase found =
      find_onsets(find_case("kernel-radius", "disk of comparisons", Level::kModel, "gather_pcf"), axis);
  ASSERT_EQ(found.samples.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.samples[i].value, static_cast<double>(i + 1));
    EXPECT_LT(found.samples[i].measured.value(), 1e-5);
  }
}

TEST(Axes, FiltersThatTheyHaveNothingToAsk_AreReported) {
  const auto expect = [](const char* axis, const char* filters, const char* words) {
    const std::vector<Case> cases = choose_axes(axis)[0].make_cases(make_inputs(filters));
    EXPECT_THAT(cases, Contains(::testing::Field(&Case::not_available, HasSubstr(words)))) << axis;
  };
  for (const char* axis : {"esm-exponent", "warp-exponent", "vsm-cancellation"})
    expect(axis, "none", "front matter declares '");
  expect("grazing-light", "vsm", "kind comparison");
  expect("light-bleeding", "none", "encodes");
  expect("kernel-radius", "none", "radius");
  expect("taps", "none", "taps");
  expect("depth-formats", "none", "no GL");
}

}  // namespace
}  // namespace shadowbench::stress
