// `shadowbench flicker`, as a user calls it.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;

using FlickerCommand = ProgramTest;

TEST_F(FlickerCommand, WritesTheReport) {
  const Outcome outcome = run("flicker --out out --no-cache --filters none,vsm --frames 3 --map-size 128 --size 96x54");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("out/flicker.html"));
  for (const char* name :
       {"flicker.json", "flicker.csv", "flicker.md", "flicker.html", "flicker.light.png", "flicker.camera.png"})
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / name)) << name;
  for (const char* chart : {"flicker.light", "flicker.light.snapped", "flicker.camera", "flicker.camera.snapped"})
    EXPECT_THAT(read_text(folder() / "out" / "flicker.html"), HasSubstr(fmt::format("id=\"{}\"", chart)));
  const nlohmann::json flicker = nlohmann::json::parse(read_text(folder() / "out" / "flicker.json"));
  ASSERT_EQ(flicker["motions"].size(), 2u);
  EXPECT_EQ(flicker["motions"][0]["id"], "light");
  EXPECT_EQ(flicker["motions"][1]["fit"], "view");
  EXPECT_EQ(flicker["motions"][1]["truth"]["traced"], false);
  EXPECT_EQ(flicker["motions"][0]["variants"][0]["filters"][0]["step_change"].size(), 2u)
      << "two steps between three frames";
}

TEST_F(FlickerCommand, BadInput_IsRefused) {
  expect_refusal("flicker --out out --frames 1", 2, {"--frames", "'1'", "2 or more"});
  expect_refusal("flicker --out out --frames many", 2, {"--frames", "'many'"});
  expect_refusal("flicker --out out --motion wind", 2, {"--motion", "'wind'", "light, camera"});
  expect_refusal("flicker --out out --motion light,light", 2, {"--motion", "twice"});
  expect_refusal("flicker --out out --size 96", 2, {"--size", "'96'"});
  expect_refusal("flicker --out out --map-size 0", 2, {"--map-size", "'0'"});
  expect_refusal("flicker --out out --map-size 2 --size 96x54 --filters none", 2, {"a map of 2 texels"});
  expect_refusal("flicker --out out --filters vsn", 2, {"'vsn'", "vsm"});
  EXPECT_FALSE(std::filesystem::exists(folder() / "out" / "flicker.json"));
}

}  // namespace
}  // namespace shadowbench::test
