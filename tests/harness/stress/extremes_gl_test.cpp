// What the axes of extreme maps measure, and that they see what is wrong.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/harness/stress/stress_fixture.h"

namespace shadowbench::stress {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

Case find_case(const AxisInputs& inputs, const std::string& axis, const std::string& filter, const std::string& part) {
  for (Case& item : choose_axes(axis)[0].make_cases(inputs))
    if (item.filter == filter && item.level == Level::kGl && item.variant.find(part) != std::string::npos)
      return std::move(item);
  ADD_FAILURE() << "no case " << part;
  return {};
}

/// Every case of these axes that runs on this GL keeps to its theory.
TEST(ExtremeAxes, GlCases_MeetTheirTheories) {
  for (const char* id : {"map-edge", "map-size", "poisoned-input"}) {
    Axis axis = choose_axes(id)[0];
    if (axis.whole) axis.range.high = std::min(axis.range.high, 512.0);  // larger maps cost seconds
    expect_theories_met(axis, make_gl_inputs("none,box3x3,poisson,esm,vsm,msm_packed32,msm_packed64"), Level::kGl,
                        false);
  }
}

TEST(MapSize, OneTexelIsAMap) {
  for (const char* id : {"none", "pcf2x2", "poisson", "vsm", "esm", "vsm_sat", "csm_conv"}) {
    const Observation seen = find_case(make_gl_inputs(id), "map-size", id, "half").observe(1.0);
    EXPECT_EQ(seen.verdict, Verdict::kOk) << id << ": " << seen.why;
    EXPECT_TRUE(seen.measured);
  }
}

/// A texel of 32 bits has 64 shares: by its own design, in a map of any size.
TEST(MapSize, WhatAFilterPacks_IsNoFaultOfTheMap_ButIsSaid) {
  const AxisInputs inputs = make_gl_inputs("msm_packed32,msm_packed64");
  for (const char* id : {"msm_packed32", "msm_packed64"}) {
    const Case item = find_case(inputs, "map-size", id, "half");
    EXPECT_LT(item.observe(6.0).measured.value(), 1e-5) << id;
    EXPECT_EQ(item.remark({}).size(), id == std::string("msm_packed32") ? 1u : 0u) << id;
  }
}

/// Four terms of a Fourier series leave light behind an occluder, in a large map as in a small one.
TEST(MapSize, WhatAFormulaLeavesOfTwoDepths_IsExpectedOfMapsOfEverySize) {
  const AxisInputs inputs = make_gl_inputs("csm_conv");
  const Case item = find_case(inputs, "map-size", "csm_conv", "half");
  for (const double size : {256.0, 257.0, 512.0}) EXPECT_LT(item.observe(size).measured.value(), 1e-3) << size;
}

TEST(MapSize, AboveTheLimit_IsRefusedBeforeAnythingIsAllocated) {
  const AxisInputs inputs = make_gl_inputs("none");
  const std::vector<Exhibit> exhibits = choose_axes("map-size")[0].make_exhibits(inputs);
  ASSERT_EQ(exhibits.size(), 1u);
  const auto& rows = exhibits[0].table->rows;
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_THAT(rows[0][2],
              AnyOf(HasSubstr("ok: dark behind an occluder, lit beside it"), HasSubstr("not available: it needs")));
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_THAT(rows[i][2], AllOf(HasSubstr("refused"), HasSubstr(fmt::format("at most {}", rows[0][0]))));
}

}  // namespace
}  // namespace shadowbench::stress
