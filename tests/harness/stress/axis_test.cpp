#include "harness/stress/axis.h"

#include <gmock/gmock.h>

#include <cmath>

#include "base/error.h"
#include "filters/model.h"
#include "harness/options/options.h"
#include "harness/stress/run_stress.h"
#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

const filters::Catalogue& catalogue() {
  static const filters::Catalogue filters(options::find_resources().filters);
  return filters;
}

/// Gives the message of the usage error that a range is refused with.
std::string refuse(const std::string& range, const std::string& axes = "") {
  std::vector<Axis> chosen = choose_axes(axes);
  try {
    apply_range(chosen, range);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    EXPECT_EQ(error.message().find('\n'), std::string::npos);
    return error.message();
  }
  return "";
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
  for (const filters::FilterSpec& spec : catalogue().filters()) {
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
  for (const auto& [text, word] :
       {std::pair("esm-exponnet", "did you mean 'esm-exponent'"), std::pair("zzz", "known: "), std::pair("", ""),
        std::pair("esm-exponent,esm-exponent", "twice")}) {
    try {
      choose_axes(text);
      EXPECT_EQ(std::string(text), "");
    } catch (const Error& error) {
      EXPECT_THAT(error.message(), AllOf(HasSubstr("--axes"), HasSubstr(word)));
    }
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
  EXPECT_THAT(list_choices(inputs.filters[1], "store"), ::testing::ElementsAre("r32f", "r16f"));
  EXPECT_THAT(list_choices(make_inputs("esm:store=r16f").filters[0], "store"), ::testing::ElementsAre("r16f"));
  EXPECT_THAT(list_choices(inputs.filters[1], "nothing"), SizeIs(0));
}

TEST(Driven, FiltersThatWereNotChosen_AreReported) {
  for (const char* id : {"esm-exponent", "warp-exponent", "vsm-cancellation"}) {
    const std::vector<Case> cases = choose_axes(id)[0].make_cases(make_inputs("none"));
    EXPECT_TRUE(std::ranges::any_of(cases, [](const Case& item) {
      return item.not_available.find("front matter declares '") != std::string::npos;
    })) << id;
  }
}

TEST(Driven, WithoutAGl_GlCasesSayThatThereIsNone) {
  for (const Case& item : choose_axes("esm-exponent")[0].make_cases(make_inputs()))
    EXPECT_EQ(item.not_available.find("no GL") != std::string::npos, item.level == Level::kGl) << item.variant;
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

TEST(EsmExponent, ModelOverflows_AtTheLogarithmOfTheLargestNumber) {
  const Axis axis = choose_axes("esm-exponent")[0];
  for (const auto& [variant, limit] :
       {std::pair("r32f, linear, depths to 1", 88.72), std::pair("r16f, linear, depths to 1", 11.09),
        std::pair("r32f, linear, depths to 0.5, no blur", 177.4),
        std::pair("r16f, linear, depths to 0.5, no blur", 22.18)}) {
    EXPECT_NEAR(find_onsets(find_case("esm-exponent", variant, Level::kModel), axis).broken->value / limit, 1.0, 0.02)
        << variant;
  }
  EXPECT_FALSE(find_onsets(find_case("esm-exponent", "r32f, log, depths to 1", Level::kModel), axis).broken);
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

}  // namespace
}  // namespace shadowbench::stress
