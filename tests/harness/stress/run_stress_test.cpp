#include "filters/kernel.h"
#include "harness/stress/axis.h"
#include "harness/stress/synthetic_scene.h"
#include "tests/test_files.h"

namespace shadowbench::stress {
namespace {

using records::StressAgreement;

Axis make_axis(double low, double high, bool log = true) {
  Axis axis;
  axis.id = "test";
  axis.quantity = "value";
  axis.log = log;
  axis.range = axis.limits = {low, high};
  axis.coarse_samples = 9;
  return axis;
}

/// Degraded from one value on, broken from another on.
Case make_steps(double degraded, double broken, int* count = nullptr) {
  Case item;
  item.observe = [=](double value) {
    if (count) ++*count;
    const Verdict verdict = value >= broken ? Verdict::kBroken : value >= degraded ? Verdict::kDegraded : Verdict::kOk;
    return Observation{verdict, value, "because"};
  };
  return item;
}

TEST(FindOnsets, FindsBothToOnePercent_OnALogarithmicAxis) {
  const records::StressCase found = find_onsets(make_steps(12.34, 567.8), make_axis(1.0, 1e4));
  ASSERT_TRUE(found.degraded && found.broken);
  EXPECT_GE(found.degraded->value, 12.34);
  EXPECT_LT(*found.degraded->last_before, 12.34);
  EXPECT_LE(found.degraded->value / *found.degraded->last_before, 1.0101);
  EXPECT_GE(found.broken->value, 567.8);
  EXPECT_LE(found.broken->value / *found.broken->last_before, 1.0101);
  EXPECT_EQ(found.broken->why, "because");
}

TEST(FindOnsets, FindsToOnePercent_OnALinearAxisThatBeginsAtZero) {
  const records::StressCase found = find_onsets(make_steps(0.037, 61.0), make_axis(0.0, 90.0, false));
  EXPECT_NEAR(found.degraded->value, 0.037, 0.00037);
  EXPECT_NEAR(found.broken->value, 61.0, 0.61);
}

TEST(FindOnsets, WholeNumbers_AreFoundExactly) {
  Axis axis = make_axis(1.0, 4096.0);
  axis.whole = true;
  const records::StressCase found = find_onsets(make_steps(1e9, 777.0), axis);
  EXPECT_EQ(found.broken->value, 777.0);
  EXPECT_EQ(*found.broken->last_before, 776.0);
  for (const records::StressSample& sample : found.samples) EXPECT_EQ(sample.value, std::round(sample.value));
}

TEST(FindOnsets, CaseOfAFewValues_IsAskedForThoseInTheRange_AndForNoneBetween) {
  Case item = make_steps(3.0, 1e9);
  item.values = {1.0, 2.0, 5.0, 2000.0};
  const records::StressCase found = find_onsets(item, make_axis(1.0, 1000.0));
  ASSERT_THAT(found.samples, SizeIs(3));
  EXPECT_EQ(found.samples[2].value, 5.0);
  EXPECT_EQ(found.degraded->value, 5.0);
  EXPECT_EQ(*found.degraded->last_before, 2.0);
  EXPECT_THAT(find_onsets(item, make_axis(6.0, 1000.0)).not_available, HasSubstr("value 1, 2, 5, 2000 alone"));
}

TEST(FindOnsets, FromTheHighEnd_FindsTheFirstChangeDownwards) {
  Axis axis = make_axis(1.0, 1000.0);
  axis.from = SearchFrom::kHigh;
  Case item;
  item.observe = [](double value) { return Observation{value < 20.0 ? Verdict::kBroken : Verdict::kOk, value, {}}; };
  const records::StressCase found = find_onsets(item, axis);
  EXPECT_NEAR(found.broken->value, 20.0, 0.2);
  EXPECT_GE(*found.broken->last_before, 20.0);
}

TEST(FindOnsets, BreakingAtOnce_IsNotDegraded) {
  const records::StressCase found = find_onsets(make_steps(50.0, 50.0), make_axis(1.0, 1000.0));
  EXPECT_FALSE(found.degraded);
  EXPECT_NEAR(found.broken->value, 50.0, 0.5);
}

TEST(FindOnsets, NothingChanges_NothingIsFound) {
  const records::StressCase found = find_onsets(make_steps(1e9, 1e9), make_axis(1.0, 1000.0));
  EXPECT_FALSE(found.degraded || found.broken);
  EXPECT_THAT(found.samples, SizeIs(9));
}

TEST(FindOnsets, RangeThatBeginsBroken_HasNoValueBefore) {
  const records::StressCase found = find_onsets(make_steps(0.5, 0.5), make_axis(1.0, 1000.0));
  EXPECT_EQ(found.broken->value, 1.0);
  EXPECT_FALSE(found.broken->last_before);
}

TEST(FindOnsets, ObservesNoValueTwice_AndCountsAll) {
  int count = 0;
  const records::StressCase found = find_onsets(make_steps(10.0, 10.0, &count), make_axis(1.0, 1000.0));
  EXPECT_EQ(static_cast<std::size_t>(count), found.samples.size());
  EXPECT_LE(count, 9 + 9);
}

TEST(FindOnsets, VerdictsThatGetBetterAgain_AreNoted) {
  Case item;
  item.observe = [](double value) {
    return Observation{value > 10.0 && value < 200.0 ? Verdict::kBroken : Verdict::kOk, value, {}};
  };
  const records::StressCase found = find_onsets(item, make_axis(1.0, 1000.0));
  EXPECT_NEAR(found.broken->value, 10.0, 0.11);
  ASSERT_THAT(found.notes, SizeIs(1));
  EXPECT_THAT(found.notes[0], HasSubstr("ok again at 421.7"));
  EXPECT_THAT(find_onsets(make_steps(5.0, 50.0), make_axis(1.0, 1000.0)).notes, SizeIs(0));
}

TEST(FindOnsets, MeasuredThatIsNotFinite_IsAbsent) {
  Case item;
  item.observe = [](double) { return Observation{Verdict::kBroken, std::numeric_limits<double>::quiet_NaN(), "NaN"}; };
  EXPECT_FALSE(find_onsets(item, make_axis(1.0, 2.0)).samples[0].measured);
}

TEST(FindOnsets, ErrorAtTheFirstValue_IsNotAvailable_LaterOnesAreBroken) {
  Case item;
  item.observe = [](double) -> Observation { throw Error(ErrorKind::kUsage, "this GL lacks it"); };
  EXPECT_EQ(find_onsets(item, make_axis(1.0, 1000.0)).not_available, "this GL lacks it");
  item.observe = [](double value) {
    if (value > 100.0) throw Error(ErrorKind::kContext, "no memory");
    return Observation{};
  };
  const records::StressCase found = find_onsets(item, make_axis(1.0, 1000.0));
  EXPECT_EQ(found.not_available, "");
  EXPECT_NEAR(found.broken->value, 100.0, 1.01);
  EXPECT_EQ(found.broken->why, "no memory");
}

TEST(FindOnsets, AbsentCase_KeepsItsReason) {
  const records::StressCase found =
      find_onsets(Case{.filter = "vsm", .not_available = "no such format"}, make_axis(1.0, 2.0));
  EXPECT_EQ(found.not_available, "no such format");
  EXPECT_THAT(found.samples, SizeIs(0));
}

/// Gives how a case that breaks at `measured` compares with a theory.
records::StressLimit compare_one(double measured, std::optional<double> onset, TheoryKind kind, double low = 1.0,
                                 double high = 1000.0) {
  Case item = make_steps(measured, measured);
  item.theories = {{onset, kind, "formula", "source", Verdict::kBroken}};
  const Axis axis = make_axis(low, high);
  return compare(item, find_onsets(item, axis), axis).at(0);
}

bool agrees(double measured, std::optional<double> onset, TheoryKind kind, double low = 1.0) {
  const StressAgreement found = compare_one(measured, onset, kind, low).agreement;
  EXPECT_THAT(found, AnyOf(StressAgreement::kAgrees, StressAgreement::kDisagrees));
  return found == StressAgreement::kAgrees;
}

TEST(Compare, TheoriesAgreeWithinTenPercent_AndRoundingBoundsWithinAFactorOfEight) {
  for (const TheoryKind kind : {TheoryKind::kOverflow, TheoryKind::kQuantum, TheoryKind::kSlope}) {
    for (const double near : {107.0, 93.0}) EXPECT_TRUE(agrees(near, 100.0, kind)) << near;
    for (const double off : {113.0, 89.0}) EXPECT_FALSE(agrees(off, 100.0, kind)) << off;
  }
  for (const double near : {700.0, 13.0}) EXPECT_TRUE(agrees(near, 100.0, TheoryKind::kRounding)) << near;
  for (const double off : {830.0, 12.0}) EXPECT_FALSE(agrees(off, 100.0, TheoryKind::kRounding)) << off;
  EXPECT_NEAR(*compare_one(50.0, 100.0, TheoryKind::kOverflow).ratio, 0.5, 0.006) << "measured over theory";
}

TEST(Compare, TheoryThatSaysNone_OrBeyondTheRange_AgreesWhereNothingIsMet) {
  EXPECT_TRUE(agrees(1e9, std::nullopt, TheoryKind::kOverflow));
  EXPECT_FALSE(agrees(50.0, std::nullopt, TheoryKind::kOverflow));
  EXPECT_TRUE(agrees(1e9, 5000.0, TheoryKind::kOverflow));
  EXPECT_FALSE(agrees(1e9, 500.0, TheoryKind::kOverflow));
  EXPECT_TRUE(agrees(1e9, 500.0, TheoryKind::kRounding)) << "a factor of 8 reaches beyond";
}

TEST(Compare, TheoryBeforeTheRange_AgreesWhereTheRangeBeginsWithIt) {
  EXPECT_TRUE(agrees(11.0, 11.09, TheoryKind::kOverflow, 50.0));
  EXPECT_FALSE(compare_one(11.0, 11.09, TheoryKind::kOverflow, 50.0).ratio);
  EXPECT_FALSE(agrees(1e9, 11.09, TheoryKind::kOverflow, 50.0));
  EXPECT_FALSE(agrees(11.0, 88.7, TheoryKind::kOverflow, 50.0));
}

TEST(Compare, Explanation_IsAskedForOnlyWhereTheoryIsMissed_AndMayNotApply) {
  const Axis axis = make_axis(1.0, 1000.0);
  Case item = make_steps(50.0, 50.0);
  item.explain = [](const Disagreement& d) { return *d.measured < 60.0 ? "it is early" : ""; };
  item.theories = {{100.0, TheoryKind::kOverflow, "f", "s", Verdict::kBroken},
                   {50.0, TheoryKind::kOverflow, "f", "s", Verdict::kBroken}};
  const auto limits = compare(item, find_onsets(item, axis), axis);
  EXPECT_EQ(limits[0].agreement, StressAgreement::kExplained);
  EXPECT_EQ(limits[0].explanation, "it is early");
  EXPECT_EQ(limits[1].explanation, "");
  Case late = make_steps(500.0, 500.0);
  late.explain = item.explain;
  late.theories = {item.theories[0]};
  EXPECT_EQ(compare(late, find_onsets(late, axis), axis)[0].agreement, StressAgreement::kDisagrees);
}

const Expected kRamp{{0.1, 0.4, 0.6, 0.9}, 0.02, 4};

TEST(Judge, IsOk_WithinTheBound) {
  const Observation seen = judge({{0.1, 0.41, 0.6, 0.9}, 0}, kRamp);
  EXPECT_EQ(seen.verdict, Verdict::kOk);
  EXPECT_NEAR(*seen.measured, 0.01, 1e-12);
}

TEST(Judge, IsDegraded_OverTheBound) {
  const Observation seen = judge({{0.1, 0.45, 0.6, 0.9}, 0}, kRamp);
  EXPECT_EQ(seen.verdict, Verdict::kDegraded);
  EXPECT_THAT(seen.why, HasSubstr("0.05"));
}

TEST(Judge, OverflownTexels_AreBroken_HoweverTheImageLooks) {
  const Observation seen = judge({kRamp.visibility, 3}, kRamp);
  EXPECT_EQ(seen.verdict, Verdict::kBroken);
  EXPECT_THAT(seen.why, HasSubstr("3 texels"));
}

TEST(Judge, NotFinite_IsBroken_WithNothingMeasured) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Observation seen = judge({{0.1, bad, 0.6, 0.9}, 0}, kRamp);
    EXPECT_EQ(seen.verdict, Verdict::kBroken);
    EXPECT_FALSE(seen.measured);
  }
}

TEST(Judge, AllLitOrAllDark_IsBroken_UnlessItShouldBe) {
  EXPECT_THAT(judge({{1.0, 1.0, 1.0, 1.0}, 0}, kRamp).why, HasSubstr("all 4 receivers are lit"));
  EXPECT_THAT(judge({{0.0, 0.0, 0.0, 0.0}, 0}, kRamp).why, HasSubstr("all 4 receivers are dark"));
  EXPECT_EQ(judge({{1.0, 1.0}, 0}, {{1.0, 1.0}, 0.02, 0}).verdict, Verdict::kOk);
}

TEST(Judge, FallsWithinARun_AreBroken_BetweenRunsTheyAreNot) {
  const Expected expected{{0.2, 0.8, 0.2, 0.8}, 0.5, 2};
  EXPECT_EQ(judge({{0.2, 0.8, 0.2, 0.8}, 0}, expected).verdict, Verdict::kOk);
  EXPECT_THAT(judge({{0.5, 0.35, 0.2, 0.8}, 0}, expected).why, HasSubstr("falls by 0.15"));
  EXPECT_EQ(judge({{0.5, 0.45, 0.2, 0.8}, 0}, expected).verdict, Verdict::kOk);  // less than kLargestFall
}

/// What the kernel of a receiver holds, read from the map itself.
double find_lit_share(const EdgeScene& edge, std::size_t i, int radius) {
  const std::vector<float> weights = filters::gaussian_weights(radius);
  const auto x = static_cast<int>(edge.scene.receivers[i].x * static_cast<float>(edge.scene.size));
  const auto y = static_cast<int>(edge.scene.receivers[i].y * static_cast<float>(edge.scene.size));
  double share = 0.0;
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const float depth = edge.scene.depths[static_cast<std::size_t>((y + dy) * edge.scene.size + x + dx)];
      const double weight = static_cast<double>(weights[static_cast<std::size_t>(dx + radius)] *
                                                weights[static_cast<std::size_t>(dy + radius)]);
      if (depth == edge.scene.receivers[i].z) share += weight;
    }
  }
  return share;
}

TEST(EdgeScene, Kernels_HoldTheShareThatIsSaid_OfTwoDepths) {
  for (const int radius : {1, 4, 9}) {
    const EdgeScene edge = make_edge_scene(radius, {{0.2f, 0.5f}, {0.3f, 0.6f}, {0.4f, 0.7f}});
    ASSERT_EQ(edge.lit_share.size(), 3 * edge.run);
    for (std::size_t i = 0; i < edge.lit_share.size(); ++i) {
      EXPECT_NEAR(find_lit_share(edge, i, radius), edge.lit_share[i], 1e-6) << radius << " " << i;
      EXPECT_GT(edge.lit_share[i], 0.0);
      EXPECT_LT(edge.lit_share[i], 1.0);
      if (i % edge.run == 0) continue;
      EXPECT_GT(edge.lit_share[i], edge.lit_share[i - 1]);
    }
  }
}

TEST(EdgeScene, WithoutABlur_ReceiversStandBetweenTwoTexels) {
  const EdgeScene edge = make_edge_scene(0, {{0.2f, 0.5f}});
  for (std::size_t i = 0; i < edge.lit_share.size(); ++i) {
    const double texels = static_cast<double>(edge.scene.receivers[i].x) * edge.scene.size - 0.5;
    EXPECT_NEAR(texels - (edge.scene.size / 2 - 1), edge.lit_share[i], 1e-5);
  }
}

/// A box of 7 texels beside an edge d texels away holds 1/2 + d / 7 of what lies on this side.
TEST(EdgeScene, OfABox_HoldsTheShareOfItsAreaAcrossTheEdge) {
  const EdgeScene edge = make_edge_scene(filters::Kernel::make_box(7), {{0.2f, 0.5f}, {0.3f, 0.6f}});
  ASSERT_EQ(edge.lit_share.size(), 2 * edge.run);
  EXPECT_GT(edge.run, 20u);
  for (std::size_t i = 0; i < edge.lit_share.size(); ++i) {
    const double offset = static_cast<double>(edge.scene.receivers[i].x) * edge.scene.size - edge.scene.size / 2;
    EXPECT_NEAR(edge.lit_share[i], 0.5 + offset / 7.0, 1e-5) << i;
    EXPECT_GT(edge.lit_share[i], 0.0);
    EXPECT_LT(edge.lit_share[i], 1.0 - 1e-9) << "the other depth is not in this kernel";
  }
}

}  // namespace
}  // namespace shadowbench::stress
