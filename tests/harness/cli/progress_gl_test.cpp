// What a run says of how far it is.

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

/// One line: "42.0 % · 16/40 cubes · 64 · times · 20 s left".
struct Line {
  double percent = 0.0;
  std::string text;
};

class ProgressOfARun : public ProgramTest {
 protected:
  std::vector<Line> draw(const std::string& options) const {
    const Outcome outcome =
        run("run --every-step --out out --fresh --gl software --scene cubes --size 64x36 --map-size 64 " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    std::vector<Line> lines;
    std::istringstream text(outcome.err);
    for (std::string line; std::getline(text, line);)
      if (const std::size_t sign = line.find(" % · "); sign != std::string::npos)
        lines.push_back({std::stod(line), line.substr(sign)});
    return lines;
  }
};

TEST_F(ProgressOfARun, NamesEveryStep_AndEveryStepMovesIt) {
  for (const char* options : {"--filters none,vsm", "--filters none,vsm --no-grids --rounds 3", "--no-truth"}) {
    const std::vector<Line> lines = draw(options);
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines.front().percent, 0.0);
    EXPECT_EQ(lines.back().percent, 100.0);
    EXPECT_THAT(lines.back().text, ::testing::EndsWith(" done"));
    std::set<double> shares;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      EXPECT_GE(lines[i].percent, lines[i - 1].percent) << lines[i].text;
      shares.insert(lines[i].percent);
    }
    EXPECT_GE(shares.size(), lines.size() / 2) << options;
    for (const char* step : {"· none", "· vsm", "times", "phases", "pictures", "writing the report"}) {
      const auto is_of_step = [&](const Line& line) { return line.text.find(step) != std::string::npos; };
      EXPECT_TRUE(std::ranges::any_of(lines, is_of_step)) << step;
    }
    const auto names_truth = [](const Line& line) { return line.text.find("truth") != std::string::npos; };
    EXPECT_EQ(std::ranges::any_of(lines, names_truth), std::string(options) != "--no-truth");
    EXPECT_LT(lines[lines.size() - 3].percent, 100.0) << "what is not done is not 100 %";
  }
}

TEST_F(ProgressOfARun, StartsAnewWithWhatIsLeft) {
  draw("--filters none --no-grids --rounds 1 --pad-texels 4");
  const Outcome outcome = run(
      "run --every-step --out out --gl software --scene cubes --size 64x36 --map-size 64 --filters none,vsm --no-grids "
      "--rounds 1 --pad-texels 4");
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("0.0 % · 1/2 cubes · 64 · vsm"));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("100.0 % · 2/2 done"));
}

/// Standard output and standard error of a run are what a build server's log shows.
TEST_F(ProgressOfARun, InALog_TakesTenLinesAtMost_AndTheSummaryStandsThereOnce) {
  const Outcome outcome = run(
      "run --out out --gl software --scene cubes --scene stack --size 64x36 --map-size 64,128 --rounds 1 --no-truth");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string log = outcome.err + outcome.out;
  EXPECT_LE(std::ranges::count(log, '\n'), 10) << log;
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("32 cells; "));
  EXPECT_GE(log.find(" % · "), log.find("32 cells; "));
  EXPECT_NE(log.find(" % · "), log.rfind(" % · ")) << "it says how far it is meanwhile";
  EXPECT_THAT(outcome.err, ::testing::EndsWith("100.0 % · 32/32 done\n"));
  EXPECT_EQ(outcome.err.find("32/32 done"), outcome.err.rfind("32/32 done"));
  EXPECT_EQ(outcome.out, "report: out/index.html\n");
}

TEST_F(ProgressOfARun, InALog_WarningsStay_HoweverManyThereAre) {
  std::string scenes;
  for (int i = 0; i < 12; ++i)
    scenes += " --scene " + write("below" + std::to_string(i) + ".toml",
                                  read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/data/scenes/cubes.toml"))
                                .string();
  const Outcome outcome =
      run("run --out out --gl software --filters none --size 32x18 --map-size 32 --rounds 1 "
          "--no-truth --light 0,-20" +
          scenes);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (int i = 0; i < 12; ++i)
    EXPECT_THAT(outcome.err, ::testing::HasSubstr("warning: below" + std::to_string(i) + ": "));
  EXPECT_THAT(outcome.err, ::testing::HasSubstr("12/12 done"));
}

}  // namespace
}  // namespace shadowbench::test
