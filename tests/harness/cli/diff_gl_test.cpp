// What a run reports, checked with `shadowbench diff` from the pictures that the run left.

#include <nlohmann/json.hpp>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using Recheck = ProgramTest;

TEST_F(Recheck, DiffOfTheSavedPictures_GivesTheErrorsOfTheRun) {
  ASSERT_EQ(run("run --grids --out out --size 96x54 --map-size 64 --rounds 1 --phases 1 --scene cubes --filters "
                "none,vsm:radius=6")
                .exit_code,
            0);
  const nlohmann::json results = nlohmann::json::parse(read_text(folder() / "out" / "results.json"));
  const char* labels[] = {"none", "vsm (radius=6)"};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string label = labels[i];
    const nlohmann::json& error = results["cells"][i]["error"];
    const Outcome values = run("diff --json 'out/cubes.exr#" + label +
                               ".visibility' 'out/cubes.exr#truth.area' --mask 'out/cubes.exr#truth.mask'");
    ASSERT_EQ(values.exit_code, 0) << values.err;
    const nlohmann::json diff = nlohmann::json::parse(values.out);
    for (const char* name : {"rmse", "mae", "p95", "max", "mean"})
      EXPECT_EQ(diff[name].get<double>(), error[name].get<double>()) << label << " " << name;
    EXPECT_NE(error["rmse"], 0.0);
    EXPECT_EQ(diff["compared"], results["cells"][i]["receivers"]);
    EXPECT_EQ(diff["not_finite"], 0);
  }
}

TEST_F(Recheck, FlipOfTheSavedPictures_IsTheFlipOfTheRun) {
  // A user's filter is drawn by another process: its picture has been through a file already.
  write("copied.glsl", read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/filters/pcf2x2.glsl"));
  ASSERT_EQ(run("run --grids --all-parts --out out --size 96x54 --map-size 64 --rounds 1 --scene cubes --filters "
                "pcf2x2,copied "
                "--filter-file copied.glsl")
                .exit_code,
            0);
  const nlohmann::json results = nlohmann::json::parse(read_text(folder() / "out" / "results.json"));
  const char* labels[] = {"pcf2x2", "copied"};
  for (std::size_t i = 0; i < 2; ++i) {
    const Outcome outcome = run("diff --json 'out/cubes.exr#" + std::string(labels[i]) +
                                ".picture' 'out/cubes.exr#truth.picture' --metric flip");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const double flip = nlohmann::json::parse(outcome.out)["flip"];
    EXPECT_GT(flip, 0.0);
    EXPECT_EQ(flip, results["cells"][i]["error"]["flip"].get<double>()) << labels[i];
  }
}

}  // namespace
}  // namespace shadowbench::test
