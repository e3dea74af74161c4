// `shadowbench run --lights`, as a user calls it.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSmallLights =
    "run --out out --size 64x36 --map-size 64 --rounds 3 --scene cubes --no-attribution --no-grids ";

class Lights : public ProgramTest {
 protected:
  json results() const { return json::parse(read_text(folder() / "out" / "results.json")); }

  void expect_valid() const {
    const std::string check = "/usr/bin/python3 -m jsonschema -i '" + (folder() / "out" / "results.json").string() +
                              "' '" + (folder() / "out" / "results.schema.json").string() + "'";
    EXPECT_EQ(std::system(check.c_str()), 0);
  }
};

TEST_F(Lights, AreTimedForEveryCell_ByAscendingCount_UsersFiltersToo) {
  const Outcome outcome =
      run(std::string(kSmallLights) + "--lights 4,1,2 --filters none,vsm,nine_compares --filter-file " +
          user_filter("nine_compares.glsl"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_valid();
  const json all = results();
  ASSERT_EQ(all["cells"].size(), 3u);
  for (const json& cell : all["cells"]) {
    ASSERT_EQ(cell["lights"].size(), 3u) << cell["filter"];
    for (std::size_t i = 0; i < 3; ++i) {
      const json& each = cell["lights"][i];
      const std::int64_t count = std::int64_t{1} << i;
      EXPECT_EQ(each["count"], count);
      EXPECT_EQ(each["static_ms"]["n"], 3);
      EXPECT_GT(each["moving_ms"]["median"], each["static_ms"]["median"]);
      EXPECT_EQ(each["maps_bytes"], count * cell["cost"]["map_bytes"].get<std::int64_t>());
    }
    EXPECT_FALSE(cell["absent"].contains("lights"));
  }
  const json& none = all["cells"][0];
  EXPECT_EQ(none["lights"][2]["ratio_to_none"]["moving"]["ci95"], json({1.0, 1.0}));
  const std::string page = read_text(folder() / "out" / "index.html");
  EXPECT_THAT(page, HasSubstr("<figure class=\"chart\" id=\"lights\">"));
}

TEST_F(Lights, ThatWereNotAskedFor_AreAbsentWithTheReason) {
  ASSERT_EQ(run(std::string(kSmallLights) + "--filters none").exit_code, 0);
  expect_valid();
  const json cell = results()["cells"][0];
  EXPECT_TRUE(cell["lights"].is_null());
  EXPECT_EQ(cell["absent"]["lights"], "the run was made without --lights");
  EXPECT_THAT(read_text(folder() / "out" / "index.html"), Not(HasSubstr("id=\"lights\"")));
}

/// Cells that were measured without lights, or with others, are measured again.
TEST_F(Lights, AreNoticedWhenARunGoesOn) {
  const std::string common = std::string(kSmallLights) + "--filters none,vsm ";
  ASSERT_EQ(run(common).exit_code, 0);
  EXPECT_THAT(run(common).err, HasSubstr("2 of them finished before"));
  EXPECT_THAT(run(common + "--lights 1,2").err, Not(HasSubstr("finished before")));
  EXPECT_EQ(results()["cells"][1]["lights"].size(), 2u);
  EXPECT_THAT(run(common + "--lights 2,1").err, HasSubstr("2 of them finished before"));
  EXPECT_THAT(run(common + "--lights 1").err, Not(HasSubstr("finished before")));
}

TEST_F(Lights, OfAnExperimentFile_AreOverriddenByTheCommandLine) {
  write("e.toml",
        "scene = 'cubes'\nmap_size = 32\nsize = '32x18'\nrounds = 1\ntruth = false\nlights = [1, 3]\n[[filter]]\nid = "
        "'none'\n");
  ASSERT_EQ(run("run e.toml --out out").exit_code, 0);
  EXPECT_EQ(results()["cells"][0]["lights"][1]["count"], 3);
  ASSERT_EQ(run("run e.toml --out out --lights 2").exit_code, 0);
  ASSERT_EQ(results()["cells"][0]["lights"].size(), 1u);
  EXPECT_EQ(results()["cells"][0]["lights"][0]["count"], 2);
}

TEST_F(Lights, AreCountedInTheTimeThatIsAnnounced) {
  expect_refusal("run --out out --scene cubes --filters none --map-size 64 --size 64x36 --budget 1800 --lights 1,2", 2,
                 {"1 h 30 min", "--yes"});
}

TEST_F(Lights, BadCounts_AreRefused) {
  const std::string common = std::string(kSmallLights) + "--filters none --lights ";
  expect_refusal(common + "0", 2, {"--lights", "'0'", "whole number"});
  expect_refusal(common + "-2", 2, {"--lights"});
  expect_refusal(common + "1.5", 2, {"--lights", "'1.5'", "whole number"});
  expect_refusal(common + "two", 2, {"--lights", "'two'"});
  expect_refusal(common + "1,,2", 2, {"--lights", "''"});
  expect_refusal(common + "''", 2, {"--lights", "missing"});
  expect_refusal(common + "2,1,2", 2, {"--lights", "2 twice"});
  expect_refusal(common + "1,17", 2, {"--lights", "17", "1 .. 16"});
  expect_refusal("run --out out --scene cubes --filters none,vsm --map-size 64,4096 --lights 1,8", 2,
                 {"--lights", "8 lights", "4096", "1536 MiB", "1024 MiB"});
  write("bad.toml", "scene = 'cubes'\nlights = [1, 2.5]\n");
  expect_refusal("run bad.toml --out out", 2, {"--lights", "'2.5'"});
}

}  // namespace
}  // namespace shadowbench::test
