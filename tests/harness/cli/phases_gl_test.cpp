// What a run says of how sure its errors are, and of the truth that they are held against, as a user calls it.

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSmall = "run --size 96x54 --map-size 128 --rounds 1 --no-attribution ";

/// A rectangular lamp close to the floor, with a post in between.
constexpr const char* kLowLamp = R"(title = "A low lamp"
[camera]
position = [0.0, 2.5, 3.0]
target = [0.0, 0.0, 0.0]
[light]
type = "spot"
position = [0.9, 1.0, 0.0]
target = [0.0, 0.0, 0.0]
cone_deg = 120
size = [0.9, 0.2]
[[material]]
name = "grey"
color = [0.5, 0.5, 0.5]
[[object]]
shape = "plane"
size = [4, 4]
material = "grey"
[[object]]
shape = "box"
size = [0.3, 0.6, 0.3]
center = [0.0, 0.3, 0.0]
material = "grey"
)";

class Phases : public ProgramTest {
 protected:
  json results(const std::string& out = "out") const { return json::parse(read_text(folder() / out / "results.json")); }
};

TEST_F(Phases, EveryCellHasItsGroups_AndThePageSaysWhatTheyCanTell) {
  ASSERT_EQ(run(std::string(kSmall) + "--scene cubes --filters none,tent5x5,castano5 --out out").exit_code, 0);
  for (const json& cell : results()["cells"]) {
    ASSERT_EQ(cell["phases"], 8);
    const auto groups = cell["error"]["rmse_replicates"].get<std::vector<double>>();
    ASSERT_EQ(groups.size(), 4u);
    const double rmse = cell["error"]["rmse"].get<double>();
    EXPECT_NEAR(std::accumulate(groups.begin(), groups.end(), 0.0) / 4.0, rmse, 1e-12);
    for (const char* name : {"rmse", "flicker"}) {
      const auto interval = cell["error"][std::string(name) + "_ci95"].get<std::array<double, 2>>();
      const double value = cell["error"][name].get<double>();
      EXPECT_GE(value, interval[0]) << name;
      EXPECT_LE(value, interval[1]) << name;
    }
  }
  EXPECT_THAT(read_text(folder() / "out" / "index.html"), HasSubstr("Smallest detectable RMSE difference"));
}

TEST_F(Phases, OfOne_SayThatNothingIsKnownOfTheOthers) {
  ASSERT_EQ(run(std::string(kSmall) + "--scene cubes --filters none --phases 1 --out out").exit_code, 0);
  const json cell = results()["cells"][0];
  EXPECT_TRUE(cell["error"]["rmse_ci95"].is_null());
  EXPECT_TRUE(cell["error"]["flicker"].is_null());
  for (const char* field : {"error.rmse_ci95", "error.rmse_replicates", "error.flicker", "error.flicker_ci95"})
    EXPECT_THAT(cell["absent"][field].get<std::string>(), HasSubstr("--phases")) << field;
  EXPECT_THAT(read_text(folder() / "out" / "index.html"), Not(HasSubstr("Smallest detectable RMSE difference")));
}

/// The weights differ under such a lamp: the run says so, errors follow the option, and pictures are held against the
/// same truth.
TEST_F(Phases, TruthWeight_ChoosesWhatVisibilityIsHeldAgainst) {
  std::ofstream(folder() / "low.toml") << kLowLamp;
  const std::string start = std::string(kSmall) + "--scene low.toml --filters none --phases 1 ";
  const Outcome outcome = run(start + "--out out");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  ASSERT_EQ(run(start + "--truth-weight cosine --out other").exit_code, 0);
  const json area = results()["cells"][0], cosine = results("other")["cells"][0];
  EXPECT_GT(area["truth"]["weight_rmse"], 0.01);
  EXPECT_EQ(area["truth"]["weight_rmse"], cosine["truth"]["weight_rmse"]);
  EXPECT_THAT(area["warnings"].dump(), HasSubstr("choose with --truth-weight"));
  EXPECT_NE(area["error"]["rmse"], cosine["error"]["rmse"]);
  EXPECT_EQ(area["error"]["flip"], cosine["error"]["flip"]);
  const Outcome wrong = run(start + "--truth-weight cosin");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--truth-weight: 'cosin' must be area or cosine"));
}

}  // namespace
}  // namespace shadowbench::test
