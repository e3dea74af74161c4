// Input that is odd and not wrong: the run is done, and says what is odd.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr const char* kBlock =
    "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\n"
    "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n";

class OddInput : public ProgramTest {
 protected:
  Outcome draw(const std::string& rest) const {
    return run("run --out out --size 64x36 --map-size 64 --rounds 1 --phases 1 --no-attribution --filters none " +
               rest);
  }
  std::string results() const { return read_text(folder() / "out" / "results.json"); }
};

TEST_F(OddInput, SceneNamedAsAFormula_IsDefusedInCsv_AndKeepsItsNameInJson) {
  write("=cmd.obj", kBlock);
  ASSERT_EQ(draw("--scene ./=cmd.obj").exit_code, 0);
  for (const char* table : {"timings.csv", "accuracy.csv"}) {
    const std::string csv = read_text(folder() / "out" / table);
    EXPECT_THAT(csv, HasSubstr("'=cmd,"));
    EXPECT_THAT(csv, Not(ContainsRegex("(^|[\n,\"])=cmd")));
  }
  EXPECT_EQ(nlohmann::json::parse(results())["cells"][0]["scene"], "=cmd");
}

TEST_F(OddInput, FolderWithOneModel_IsTaken) {
  std::filesystem::create_directories(folder() / "block");
  write("block/model.obj", kBlock);
  write("block/readme.txt", "a block");
  for (const char* name : {"block", "./block/"}) {
    const Outcome outcome = draw(std::string("--fresh --ground --scene ") + name);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(nlohmann::json::parse(results())["cells"][0]["scene"], "model");
  }
}

TEST_F(OddInput, BareModel_IsNotedWithTheViewThatWasChosenForIt) {
  write("block.obj", kBlock);
  const Outcome chosen = draw("--ground --strict --scene block.obj");
  EXPECT_EQ(chosen.exit_code, 0) << chosen.err;
  EXPECT_THAT(chosen.err,
              ContainsRegex("block: camera from azimuth [0-9]+, elevation [0-9]+; sun from azimuth [0-9]+, "
                            "elevation [0-9]+: edges of shadows touch [0-9.]+ % of the picture's surfaces"));
  const Outcome lit = draw("--ground --scene block.obj --light 10,30");
  EXPECT_THAT(lit.err, HasSubstr("block: camera from azimuth "));
  EXPECT_THAT(lit.err, Not(HasSubstr("sun from")));
  const Outcome convex = draw("--scene block.obj");
  EXPECT_EQ(convex.exit_code, 0) << convex.err;
  EXPECT_THAT(convex.err, HasSubstr("warning: block: camera from azimuth 30, elevation 24; sun from azimuth 110, "
                                    "elevation 50: the usual view, since none of"));
  EXPECT_THAT(draw("--scene cubes").err, Not(HasSubstr("camera from")));
}

TEST_F(OddInput, LightFromBelow_IsWarnedOf) {
  for (const char* truth : {"", "--no-truth "}) {
    const Outcome outcome = draw(std::string(truth) + "--scene stack --light 10,-30");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("stack: the light shines from below, 30 degrees under the horizon"));
    EXPECT_THAT(nlohmann::json::parse(results())["warnings"].dump(), HasSubstr("shines from below"));
  }
  EXPECT_THAT(draw("--scene stack --light 10,30").err, Not(HasSubstr("warning")));
}

TEST_F(OddInput, LightThatNoSurfaceFaces_IsWarnedOf) {
  write("away.toml",
        "title = \"away\"\n[camera]\nposition = [0, 1, 6]\ntarget = [0, 1, 0]\n[light]\nazimuth_deg = 180\n"
        "elevation_deg = 20\n[[object]]\nshape = \"box\"\nsize = [20, 20, 1]\n");
  const Outcome outcome = draw("--scene away.toml");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("away: the light reaches no surface in view"));
}

TEST_F(OddInput, Strict_TurnsWarningsIntoExitCode1_AndWritesTheReport) {
  const std::string odd = "--scene stack --light 10,-30 ";
  const Outcome strict = draw("--strict " + odd);
  EXPECT_EQ(strict.exit_code, 1) << strict.err;
  EXPECT_THAT(strict.err, HasSubstr("shadowbench: --strict: the report has 1 warning: stack: the light shines"));
  EXPECT_THAT(strict.out, HasSubstr("report: "));
  EXPECT_THAT(results(), HasSubstr("shines from below"));
  EXPECT_EQ(draw("--strict " + odd).exit_code, 1) << "nothing is left to do, and the warning still holds";
  EXPECT_EQ(draw(odd).exit_code, 0);
  EXPECT_EQ(draw("--strict --scene stack --light 10,30").exit_code, 0);
}

TEST_F(OddInput, Strict_CountsACellThatFailed) {
  const std::string failing = "--scene cubes --cell-timeout 0.001 --filter-file " + user_filter("nine_compares.glsl");
  EXPECT_EQ(draw(failing).exit_code, 0);
  const Outcome strict = draw("--strict " + failing);
  EXPECT_EQ(strict.exit_code, 1);
  EXPECT_THAT(strict.err, HasSubstr("cubes: nine_compares: not finished after"));
}

}  // namespace
}  // namespace shadowbench::test
