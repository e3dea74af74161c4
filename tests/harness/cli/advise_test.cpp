// `shadowbench advise`, as a user calls it, on runs that are written by hand.

#include "report/records/json_io.h"
#include "tests/harness/cli/program.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::test {

using namespace records;
namespace {

/// A folder "run" with two filters on two scenes: "none" is fast and wrong, "tent3x3" slow and right.
class Advise : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::vector<CellRecord> cells;
    for (const char* scene : {"cubes", "stack"}) {
      cells.push_back(make_cell(scene, "none", 1.0, 0.06));
      cells.push_back(make_cell(scene, "tent3x3", 4.0, 0.02));
    }
    write_results(folder() / "run", make_run(), cells);
  }

  static CellRecord make_cell(const std::string& scene, const std::string& filter, double ms, double rmse) {
    CellRecord cell = records::make_cell(scene, filter, ms);
    cell.error.rmse = rmse;
    cell.truth.se = 0.001;
    cell.absent.erase("error");
    cell.penumbra.growth = 1.0;
    if (filter == "tent3x3") cell.claims = {"contact-hardening"};
    return cell;
  }
};

TEST_F(Advise, GivesTheCheapestThatKeepsTheLimits) {
  const Outcome outcome = succeed("advise run --max-rmse 0.03");
  EXPECT_THAT(outcome.out, StartsWith("Use tent3x3.\n\ntent3x3: 7.5 ms (CPU) a frame"));
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(run("advise run/results.json --max-rmse 0.03").out, outcome.out);
}

TEST_F(Advise, Options_ReachTheRequest) {
  EXPECT_THAT(run("advise run --light-motion static --max-rmse 1").out, HasSubstr("none: 1 ms (CPU) a frame, static"));
  EXPECT_THAT(run("advise run --cheapest bytes --max-rmse 1").out, HasSubstr(": 4 MiB; cheapest of 1 on the front"));
  EXPECT_THAT(run("advise run --scene cubes --scene stack").out, HasSubstr("on cubes, stack."));
  EXPECT_THAT(run("advise --scene cubes run").out, HasSubstr("judged, on cubes."));
  succeed("advise run --size 960x540");
}

TEST_F(Advise, WhereNoGpuDrew_TheEstimateIsTheCost_AndMillisecondsLimitIt) {
  std::vector<CellRecord> cells = {make_cell("cubes", "none", 1.0, 0.06), make_cell("cubes", "tent3x3", 0.5, 0.02)};
  for (CellRecord& cell : cells) {
    cell.machine = kind_of(make_run().machine, make_run().gl);
    const double us = cell.filter == "none" ? 10.0 : 1000.0;
    cell.gpu = {{"navi21", {{}, GpuEstimateRecord{.lookup_us = us, .bound_by = "memory"}, {}}}};
  }
  write_results(folder() / "cpu", make_run(), cells);
  EXPECT_THAT(run("advise cpu --max-rmse 1").out, HasSubstr("none: 20.7 µs estimated for navi21 of a 1920x1080 frame"));
  EXPECT_THAT(run("advise cpu --max-rmse 1 --cheapest time").out, HasSubstr("tent3x3: 4 ms (CPU) a frame"));
  EXPECT_EQ(run("advise cpu --max-rmse 0.05 --max-ms 2").exit_code, 1) << "its estimate is 2.07 ms, its time 4";
  succeed("advise cpu --max-rmse 0.05 --max-ms 2.1");
  succeed("advise cpu --max-rmse 0.05 --max-ms 2.1 --cheapest bytes");
  EXPECT_EQ(run("advise cpu --max-rmse 0.05 --max-ms 2.1 --cheapest time").exit_code, 1);
}

/// A report may be somebody else's, and its names would steer the terminal.
TEST_F(Advise, NamesOfAReport_AreShownWithoutEscapes) {
  std::vector<CellRecord> cells = records::read_results(folder() / "run" / "results.json").cells;
  for (CellRecord& cell : cells) cell.scene += "\x1b[31m";
  write_results(folder() / "foreign", make_run(), cells);
  const Outcome outcome = run("advise foreign --max-rmse 0.03");
  EXPECT_THAT(outcome.out, HasSubstr("\\x1b[31m"));
  EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos);
}

TEST_F(Advise, EveryLimitOfTheTable_IsAnOption) {
  for (const char* option : {"rmse", "leak", "acne", "contact-gap", "flip", "ms", "bytes", "fetches"}) {
    const Outcome outcome = run("advise run --json --max-" + std::string(option) + " 1e9");
    const json json = json::parse(outcome.out);
    EXPECT_EQ(json["asked"]["limits"]["--max-" + std::string(option)], 1e9) << outcome.err;
  }
}

TEST_F(Advise, NothingFits_ExitsWithOneAndNamesTheLimit) {
  expect_refusal("advise run --max-rmse 0.001", 1,
                 {"none of 2 configurations", "--max-rmse 0.001", "tent3x3 comes closest", "with 0.02"});
  const Outcome outcome = run("advise run --max-rmse 0.001 --json");
  EXPECT_EQ(outcome.exit_code, 1);
  const json json = json::parse(outcome.out);
  EXPECT_EQ(json["fits"], false);
  EXPECT_EQ(json["failing"][0]["limits"][0]["worst"], 0.02);
}

TEST_F(Advise, Json_HoldsTheAnswer) {
  const Outcome outcome = succeed("advise run --max-rmse 0.03 --json");
  const json json = json::parse(outcome.out);
  EXPECT_EQ(json["keeping"][0]["settings"]["filter"], "tent3x3");
  EXPECT_EQ(json["failing"][0]["limits"][0]["worst"], 0.06);
  EXPECT_EQ(json["time_unit"], "ms (CPU)");
}

TEST_F(Advise, LimitsThatAreNotNumbers_AreUsageErrors) {
  for (const char* value : {"abc", "nan", "inf", "-1", "-0.5", "1e999", "5ms", "' '", "0x10"})
    expect_refusals({{std::string("advise run --max-rmse=") + value, 2, {"--max-rmse", "must be a number, 0 or more"}},
                     {"advise run --max-bytes -1", 2, {"--max-bytes: '-1' must be a number, 0 or more"}},
                     {"advise run --max-rmse", 2, {"--max-rmse"}},
                     {"advise run --max-rmse ''", 2, {"--max-rmse"}},
                     {"advise run --max-rmse 1 --max-rmse 2", 2, {"--max-rmse"}}});
}

TEST_F(Advise, UnknownNames_AreUsageErrors) {
  expect_refusals(
      {{"advise run --light-motion fast", 2, {"--light-motion: 'fast' must be one of moving, static"}},
       {"advise run --cheapest money", 2, {"--cheapest: 'money' must be one of time, bytes, fetches, gpu:NAME"}},
       {"advise run --scene stick", 2, {"--scene: the run has no 'stick'; it has cubes, stack"}},
       {"advise run --size 960", 2, {"--size", "'960'"}},
       {"advise", 2, {"RUN"}}});
}

TEST_F(Advise, BadRuns_AreInputErrors) {
  expect_refusal("advise nowhere", 3, {"nowhere", "no such folder or file"});
  std::filesystem::create_directory(folder() / "empty");
  expect_refusal("advise empty", 3, {"empty/results.json", "cannot be opened", "did the command that writes it end?"});
}

TEST_F(Advise, Requires_ReadsTheClaimsOfTheFilters) {
  const Outcome outcome = run("advise --requires contact-hardening run");
  EXPECT_THAT(outcome.out, StartsWith("Use tent3x3.")) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("--requires contact-hardening  shown"));
  EXPECT_THAT(outcome.out, HasSubstr("breaks --requires contact-hardening\n"));
  expect_refusal("advise run --requires temporal", 2, {"--requires", "'temporal'", "contact-hardening"});
}

}  // namespace
}  // namespace shadowbench::test
