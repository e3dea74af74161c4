#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "harness/stress/axis.h"

namespace shadowbench::stress {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

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

using records::StressAgreement;

TEST(Compare, OverflowQuantumAndSlope_AgreeWithinTenPercent) {
  for (const TheoryKind kind : {TheoryKind::kOverflow, TheoryKind::kQuantum, TheoryKind::kSlope}) {
    EXPECT_EQ(compare_one(107.0, 100.0, kind).agreement, StressAgreement::kAgrees);
    EXPECT_EQ(compare_one(93.0, 100.0, kind).agreement, StressAgreement::kAgrees);
    EXPECT_EQ(compare_one(113.0, 100.0, kind).agreement, StressAgreement::kDisagrees);
    EXPECT_EQ(compare_one(89.0, 100.0, kind).agreement, StressAgreement::kDisagrees);
  }
}

TEST(Compare, RoundingBounds_AgreeWithinAFactorOfEight) {
  EXPECT_EQ(compare_one(700.0, 100.0, TheoryKind::kRounding).agreement, StressAgreement::kAgrees);
  EXPECT_EQ(compare_one(13.0, 100.0, TheoryKind::kRounding).agreement, StressAgreement::kAgrees);
  EXPECT_EQ(compare_one(830.0, 100.0, TheoryKind::kRounding).agreement, StressAgreement::kDisagrees);
  EXPECT_EQ(compare_one(12.0, 100.0, TheoryKind::kRounding).agreement, StressAgreement::kDisagrees);
}

TEST(Compare, RatioIsMeasuredOverTheory) {
  EXPECT_NEAR(*compare_one(50.0, 100.0, TheoryKind::kOverflow).ratio, 0.5, 0.006);
}

TEST(Compare, TheoryThatSaysNone_AgreesWhereNothingIsMet) {
  EXPECT_EQ(compare_one(1e9, std::nullopt, TheoryKind::kOverflow).agreement, StressAgreement::kAgrees);
  EXPECT_EQ(compare_one(50.0, std::nullopt, TheoryKind::kOverflow).agreement, StressAgreement::kDisagrees);
}

TEST(Compare, TheoryBeyondTheRange_AgreesWhereNothingIsMet) {
  EXPECT_EQ(compare_one(1e9, 5000.0, TheoryKind::kOverflow).agreement, StressAgreement::kAgrees);
  EXPECT_EQ(compare_one(1e9, 500.0, TheoryKind::kOverflow).agreement, StressAgreement::kDisagrees);
  EXPECT_EQ(compare_one(1e9, 500.0, TheoryKind::kRounding).agreement,
            StressAgreement::kAgrees);  // a factor of 8 reaches beyond
}

TEST(Compare, TheoryBeforeTheRange_AgreesWhereTheRangeBeginsWithIt) {
  EXPECT_EQ(compare_one(11.0, 11.09, TheoryKind::kOverflow, 50.0).agreement, StressAgreement::kAgrees);
  EXPECT_FALSE(compare_one(11.0, 11.09, TheoryKind::kOverflow, 50.0).ratio);
  EXPECT_EQ(compare_one(1e9, 11.09, TheoryKind::kOverflow, 50.0).agreement, StressAgreement::kDisagrees);
  EXPECT_EQ(compare_one(11.0, 88.7, TheoryKind::kOverflow, 50.0).agreement, StressAgreement::kDisagrees);
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

}  // namespace
}  // namespace shadowbench::stress
