// `shadowbench bias`, as a user calls it.

#include <gmock/gmock.h>

#include "report/images/picture_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;

class BiasCommand : public ProgramTest {
 protected:
  std::vector<std::vector<std::string>> read_csv() const {
    std::stringstream text(read_text(folder() / "out" / "bias.csv"));
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(text, line, '\r'); text.get()) {
      std::stringstream fields(line + ",");
      rows.emplace_back();
      for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
    }
    return rows;
  }

  /// The acne of a mode and filter at a factor; "" where it is absent.
  std::string acne(const std::string& mode, const std::string& filter, const std::string& factor) const {
    for (const auto& row : read_csv())
      if (row.at(3) == mode && row.at(5) == filter && row.at(6) == factor) return row.at(11);
    return "no row";
  }
};

TEST_F(BiasCommand, WritesPageTableAndPictures_ForEveryMode_AndTheTheoreticalAmountRemovesAcne) {
  const Outcome outcome = run("bias --out out --size 160x90 --map-size 128 --filters none,tent3x3,vsm");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("out/bias.html"));
  std::map<std::string, int> rows;
  for (const auto& row : read_csv()) ++rows[row.at(3)];
  for (const char* mode : {"constant", "slope", "plane", "normal-offset", "polygon-offset"}) {
    EXPECT_EQ(rows[mode], 3 * 8) << mode;
    for (const char* filter : {"none", "tent3x3"}) {
      EXPECT_GT(std::stod(acne(mode, filter, "0")), 0.1) << mode << " " << filter;
      EXPECT_LT(std::stod(acne(mode, filter, "1")), 0.05) << mode << " " << filter;  // the 95th percentile's amount
    }
  }
  EXPECT_EQ(rows["receiver-plane"], 2 * 8);  // VSM reads a prefiltered map
  for (const char* mode : {"front-cull", "midpoint"}) EXPECT_EQ(rows[mode], 3) << mode;
  const std::string page = read_text(folder() / "out" / "bias.html");
  EXPECT_THAT(page, HasSubstr("Left out: vsm"));
  for (const auto& [mode, count] : rows) {
    if (mode == "mode") continue;
    EXPECT_THAT(page, HasSubstr("bias." + mode + ".png"));
    EXPECT_GT(images::read_picture(folder() / "out" / ("bias." + mode + ".png")).width, 160) << mode;
  }
}

/// The chart has the filters that are drawn; nothing is said of a map that culling emptied.
TEST_F(BiasCommand, FiltersThatAreLeftOut_HaveNoCurve) {
  write("open.toml",
        "title = \"open\"\n[camera]\nposition = [3, 5, 5]\ntarget = [0, 0, 0]\n[light]\nazimuth_deg = "
        "40\nelevation_deg = 50\n"
        "[[object]]\nshape = \"plane\"\nsize = [8, 8]\n");
  ASSERT_EQ(run("bias --out out --scene open.toml --size 160x90 --map-size 128 --filters none,vsm").exit_code, 0);
  for (const auto& row : read_csv()) EXPECT_NE(row.at(3), "front-cull");
  const std::string page = read_text(folder() / "out" / "bias.html");
  EXPECT_THAT(page, HasSubstr("Left out: none, which would read an empty map"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "out" / "bias.front-cull.png"));
  const std::size_t chart = page.find("{\"id\":\"bias.receiver-plane\"");
  ASSERT_NE(chart, std::string::npos);
  const std::string series = page.substr(chart, page.find("\"selectors\"", chart) - chart);
  EXPECT_THAT(series, HasSubstr("none: acne"));
  EXPECT_THAT(series, ::testing::Not(HasSubstr("vsm: acne")));
}

/// A sun, a spot light and a bulb, whose map has six layers.
TEST_F(BiasCommand, AllLights_AreAnswered_OrThoseThatAreNamed) {
  const std::string small = "bias --scene three_lights --size 160x90 --map-size 128 --filters none,pcf2x2 --out ";
  const auto list_scenes = [&] {
    std::set<std::string> scenes;
    for (const auto& row : read_csv()) scenes.insert(row.at(0));
    scenes.erase("scene");
    return scenes;
  };
  ASSERT_EQ(run(small + "out").exit_code, 0);
  EXPECT_THAT(list_scenes(), ::testing::ElementsAre("three_lights.bulb", "three_lights.spot", "three_lights.sun"));
  EXPECT_THAT(read_text(folder() / "out" / "bias.html"),
              HasSubstr("Depth bias on three_lights under sun, spot, bulb, map 128, 160 x 90"));
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "bias.bulb.constant.png"));
  const std::string file = user_filter("nine_compares.glsl");
  ASSERT_EQ(run(small + "out --light-name spot --ground --filter-file '" + file + "'").exit_code, 0);
  EXPECT_THAT(list_scenes(), ::testing::ElementsAre("three_lights.spot"));
  EXPECT_NE(acne("constant", "nine_compares", "1"), "no row");
  expect_refusal(small + "none --light-name moon", 2, {"--light-name", "'moon'"});
}

TEST_F(BiasCommand, BesideAReport_ItsAnswerHasTheBiasToShip) {
  const std::string same = " --scene fence --size 160x90 --map-size 128 --filters none,pcf2x2 --out out";
  ASSERT_EQ(run("run --rounds 1 --phases 1" + same).exit_code, 0);
  EXPECT_THAT(read_text(folder() / "out" / "summary.md"), ::testing::Not(HasSubstr("bias to ship")));
  const Outcome outcome = run("bias" + same + "/bias");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(read_text(folder() / "out" / "summary.md"), HasSubstr("| bias to ship | fence: "));
}

TEST_F(BiasCommand, BadInput_IsRefused) {
  expect_refusal("bias --out out --scene stepz", 2, {"'stepz'", "steps"});
  expect_refusal("bias --out out --scene no/such.toml", 3, {"no/such.toml"});
  expect_refusal("bias --out out --filters tent3", 2, {"'tent3'", "tent3x3"});
  expect_refusal("bias --out out --filters none,none", 2, {"names 'none' twice"});
  expect_refusal("bias --size 240x135 --map-size 128 --out out --filter-file " + user_filter("broken_glsl.glsl"), 5,
                 {"broken_glsl.glsl"});
  expect_refusal("bias --out out --map-size 0", 2, {"--map-size", "'0'"});
  expect_refusal("bias --out out --size 12", 2, {"--size", "'12'"});
  expect_refusal("bias --out out --size 8x8 --map-size 64 --filters none", 3,
                 {"wholly lit", "100 are needed", "--size"});
  write("file", "");
  expect_refusal("bias --scene steps --filters none --out file/out --size 64x36 --map-size 64", 6, {"file"});
}

}  // namespace
}  // namespace shadowbench::test
