// `shadowbench stress`, as a user calls it.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;

class StressCommand : public ProgramTest {
 protected:
  nlohmann::json read_stress() const { return nlohmann::json::parse(read_text(folder() / "out" / "stress.json")); }
};

TEST_F(StressCommand, WritesTheReport_WithLimitsBesideTheory) {
  const Outcome outcome = run("stress --out out --filters vsm --axes warp-exponent,vsm-cancellation");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* name : {"stress.json", "stress.md", "stress.html", "stress.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / name)) << name;
  EXPECT_THAT(outcome.out, HasSubstr("out/stress.html"));
  for (const char* chart : {"id=\"stress.warp-exponent\"", "id=\"stress.vsm-cancellation\""})
    EXPECT_THAT(read_text(folder() / "out" / "stress.html"), HasSubstr(chart));
  const nlohmann::json stress = read_stress();
  ASSERT_EQ(stress["axes"].size(), 2u);
  EXPECT_EQ(stress["axes"][0]["id"], "warp-exponent");
  EXPECT_EQ(stress["filters"], nlohmann::json({"vsm"}));
  EXPECT_NEAR(stress["axes"][0]["cases"][0]["limits"][0]["ratio"].get<double>(), 1.0, 0.02);
  EXPECT_EQ(stress["disagreements"], 0);
}

TEST_F(StressCommand, WhatIsNotAvailable_IsSaid) {
  const Outcome outcome = run("stress --out out --filters vsm --axes esm-exponent");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err,
              HasSubstr("not available: filters (GL): no chosen filter's front matter declares 'exponent'"));
  EXPECT_THAT(read_text(folder() / "out" / "stress.html"), HasSubstr("not available"));
}

TEST_F(StressCommand, RangeIsTheUsers) {
  ASSERT_EQ(run("stress --out out --filters vsm --axes warp-exponent --range warp-exponent=3,9").exit_code, 0);
  const nlohmann::json axis = read_stress()["axes"][0];
  EXPECT_EQ(axis["range"], nlohmann::json({3.0, 9.0}));
  for (const auto& sample : axis["cases"][0]["samples"]) EXPECT_TRUE(sample["value"] >= 3.0 && sample["value"] <= 9.0);
}

/// The mistake: a 16-bit map at an exponent for 32 bits ranks its filter last; within its format it does not.
TEST_F(StressCommand, ReplaysTheMistake_AndFlagsIt) {
  const Outcome outcome = run("stress --out out --filters esm --axes esm-exponent --range esm-exponent=1,200");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json exhibit = read_stress()["axes"][0]["exhibits"][0];
  const nlohmann::json rows = exhibit["table"]["rows"];
  EXPECT_EQ(rows[0][0], "esm (c=80, store=r16f)");
  EXPECT_EQ(rows[0][3], "3 of 3");
  EXPECT_EQ(rows[0][1].get<std::string>().rfind("0 of", 0), std::string::npos);  // it has texels that are not finite
  EXPECT_EQ(rows[1][1].get<std::string>().rfind("0 of", 0), 0u);
  EXPECT_LT(std::stod(rows[1][2].get<std::string>()), std::stod(rows[0][2].get<std::string>()));
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / exhibit["pictures"][0]["file"].get<std::string>()));
}

TEST_F(StressCommand, List_NamesAxesAndParameters) {
  const Outcome outcome = run("stress --list");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* word : {"esm-exponent", "warp-exponent", "vsm-cancellation", "esm:c", "vsm:min_variance"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
}

TEST_F(StressCommand, BadInput_IsRefused) {
  expect_refusal("stress --out out --axes esm-exponnet", 2, {"--axes", "'esm-exponnet'", "esm-exponent"});
  expect_refusal("stress --out out --axes esm-exponent, ", 2, {"--axes", "''"});
  expect_refusal("stress --out out --range esm-exponent=10,10", 2, {"--range", "empty"});
  expect_refusal("stress --out out --range esm-exponent=200,10", 2, {"--range", "reversed"});
  expect_refusal("stress --out out --range esm-exponent=1,nan", 2, {"--range", "'nan'", "finite"});
  expect_refusal("stress --out out --range esm-exponent=a,b", 2, {"--range", "'a'"});
  expect_refusal("stress --out out --range esm-exponent=-1,10", 2, {"--range", "beyond", "1 .. 1e+06"});
  expect_refusal("stress --out out --range nothing=1,10", 2, {"--range", "'nothing'"});
  expect_refusal("stress --out out --axes warp-exponent --range esm-exponent=1,10", 2, {"not among --axes"});
  expect_refusal("stress --out out --filters vsn", 2, {"'vsn'", "vsm"});
  expect_refusal("stress --out out --filter-file " + user_filter("nine_compares.glsl"), 2,
                 {"--filter-file", "no scalar model", "nine_compares.glsl"});
  expect_refusal("stress --out out --gl vulkan", 2, {"'vulkan'"});
  expect_refusal("stress --out /proc/none", 6, {"/proc/none"});
}

}  // namespace
}  // namespace shadowbench::test
