// What a run says of how far it is.

#include <algorithm>
#include <cstdio>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

/// One line: "16/40 · 35 s, 20 s left · cubes · 64 · times".
struct Line {
  int done = 0;
  std::string text;
};

class ProgressOfARun : public ProgramTest {
 protected:
  std::vector<Line> draw(const std::string& options) const {
    std::vector<Line> lines;
    std::istringstream text(succeed(small("--every-step --gl software " + options)).err);
    for (std::string line; std::getline(text, line);)
      if (int done = 0, all = 0, end = 0;
          std::sscanf(line.c_str(), "%d/%d · %*d %n", &done, &all, &end) == 2 && end > 0)
        lines.push_back({done, line});
    return lines;
  }
};

TEST_F(ProgressOfARun, NamesEveryStep_AndCountsCells) {
  for (const char* options : {"--fresh --filters none,vsm", "--fresh --filters none,vsm --no-truth"}) {
    const std::vector<Line> lines = draw(options);
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines.front().done, 0);
    EXPECT_THAT(lines.back().text, AllOf(StartsWith("2/2 · "), ::testing::EndsWith(" · done")));
    EXPECT_TRUE(std::ranges::is_sorted(lines, {}, &Line::done));
    for (const char* step : {"· none", "· vsm", "times", "phases", "pictures", "writing the report"}) {
      const auto is_of_step = [&](const Line& line) { return line.text.find(step) != std::string::npos; };
      EXPECT_TRUE(std::ranges::any_of(lines, is_of_step)) << step;
    }
    const auto names_truth = [](const Line& line) { return line.text.find("truth") != std::string::npos; };
    EXPECT_EQ(std::ranges::any_of(lines, names_truth), std::string(options).find("--no-truth") == std::string::npos);
  }
}

TEST_F(ProgressOfARun, StartsAnewWithWhatIsLeft) {
  draw("--filters none --pad-texels 4");
  EXPECT_EQ(draw("--filters none,vsm --pad-texels 4").front().done, 1);
}

TEST_F(ProgressOfARun, SaysHowLongItTookAndTheRest) {
  const std::vector<Line> lines =
      draw("--scene cubes --scene stack --filters none,vsm --no-truth --rounds 150 --size 960x540");
  const auto second = std::ranges::find(lines, 2, &Line::done);
  ASSERT_NE(second, lines.end());
  int taken_s = 0, left_s = 0;
  ASSERT_EQ(std::sscanf(second->text.c_str(), "2/4 · %d s, %d s left · stack", &taken_s, &left_s), 2) << second->text;
  EXPECT_EQ(left_s, taken_s) << "one half is done";
}

/// Standard output and standard error of a run are what a build server's log shows.
TEST_F(ProgressOfARun, InALog_TakesTwelveLinesAtMost_AndTheSummaryStandsThereOnce) {
  const Outcome outcome = succeed(small("--gl software --scene cubes --scene stack --map-size 64,128 --no-truth"));
  const std::string log = outcome.err + outcome.out;
  EXPECT_LE(std::ranges::count(log, '\n'), 12) << log;
  EXPECT_THAT(outcome.err, HasSubstr("32 cells; "));
  EXPECT_GE(log.find("16/32 · "), log.find("32 cells; ")) << "it says how far it is meanwhile";
  EXPECT_NE(log.find("16/32 · "), log.npos);
  EXPECT_THAT(outcome.err, ContainsRegex("32/32 · [0-9]+ s · done\n$"));
  EXPECT_EQ(outcome.err.find(" done\n"), outcome.err.rfind(" done\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("^The cheapest is [^\n]+; its error was not measured[.]\n"));
  EXPECT_THAT(outcome.out, HasSubstr("report: out/index.html\n"));
}

TEST_F(ProgressOfARun, OfFiltersForTeaching_EndsWithoutAnAnswer) {
  EXPECT_THAT(succeed(small("--gl software --filters teach4x4")).out, StartsWith("report: out/index.html\n"));
}

TEST_F(ProgressOfARun, InALog_WarningsStay_HoweverManyThereAre) {
  std::string scenes;
  for (int i = 0; i < 12; ++i)
    scenes +=
        " --scene " + write("below" + std::to_string(i) + ".toml", read_source("data/scenes/cubes.toml")).string();
  const Outcome outcome =
      succeed(small("--gl software --filters none --size 32x18 --map-size 32 --no-truth --light 0,-20" + scenes));
  for (int i = 0; i < 12; ++i) EXPECT_THAT(outcome.err, HasSubstr("warning: below" + std::to_string(i) + ": "));
  EXPECT_THAT(outcome.err, ContainsRegex("12/12 · [0-9]+ s · done"));
}

}  // namespace
}  // namespace shadowbench::test
