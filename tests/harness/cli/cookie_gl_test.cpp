// A run with a cookie, as a user calls it: what depends on it, and what does not.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "report/images/picture_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kCookieRun =
    "run --out out --size 64x36 --map-size 64 --rounds 1 --no-attribution --no-grids --filters none,pcf2x2 --scene "
    "lamp.toml";

class CookieRun : public ProgramTest {
 protected:
  /// The scene `lamp` with more lines in its [light].
  void write_lamp(const std::string& lines) const {
    std::string text = read_text(SHADOWBENCH_SOURCE_DIR "/data/scenes/teaching/lamp.toml");
    text.insert(text.find("type = \"spot\""), lines);
    write("lamp.toml", text);
  }

  void write_cookie(const std::vector<float>& grey_columns) const {
    images::Image picture(static_cast<int>(grey_columns.size()), 1, 3);
    for (std::size_t i = 0; i < picture.texels.size(); ++i) picture.texels[i] = grey_columns[i / 3];
    images::write_picture_png(folder() / "cookie.png", picture);
  }

  /// What standard error said, of a run that must succeed.
  std::string run_lamp() const {
    const Outcome outcome = run(kCookieRun);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.err;
  }

  json cells() const { return json::parse(read_text(folder() / "out" / "results.json"))["cells"]; }
};

TEST_F(CookieRun, OfBlack_LeavesTheErrorsOfVisibility_AndNoneInThePicture) {
  write_lamp("");
  run_lamp();
  const json plain = cells();
  write_lamp("cookie = 'cookie.png'\n");
  write_cookie({0.0f});
  run_lamp();
  const json black = cells();
  ASSERT_EQ(black.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    json without = plain[i]["error"], with = black[i]["error"];
    EXPECT_GT(without["flip"], 0.001);
    EXPECT_EQ(with["flip"], 0.0) << "the truth is shaded with the same cookie";
    without.erase("flip");
    with.erase("flip");
    EXPECT_EQ(with, without);
    EXPECT_EQ(black[i]["artefact"], plain[i]["artefact"]);
  }
}

TEST_F(CookieRun, AnotherPictureInTheSameFile_IsNoticedWhenARunGoesOn) {
  write_lamp("cookie = 'cookie.png'\n");
  write_cookie({0.0f, 1.0f});
  run_lamp();
  EXPECT_THAT(run_lamp(), HasSubstr("2 of them finished before"));
  write_cookie({1.0f, 0.0f});
  EXPECT_THAT(run_lamp(), Not(HasSubstr("finished before")));
}

TEST_F(CookieRun, WithoutThePicture_IsRefused) {
  write_lamp("cookie = 'cookie.png'\n");
  expect_refusal(kCookieRun, 3, {"lamp.toml:10", "'cookie' in [light]", "there is no file", "cookie.png"});
}

}  // namespace
}  // namespace shadowbench::test
