// What a run measures: phases and weights of the truth, kernels of equal width, minification, and errors found again.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>

#include "report/images/stored_picture.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

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

using Phases = ProgramTest;

constexpr const char* kPhasesRun = "--size 96x54 --map-size 128 --no-attribution ";

TEST_F(Phases, EveryCellHasItsGroups_AndThePageSaysWhatTheyCanTell) {
  for (const json& cell : measure(std::string(kPhasesRun) + "--filters none,tent5x5,castano5")) {
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
  EXPECT_THAT(read("out/index.html"), HasSubstr("Smallest detectable RMSE difference"));
}

TEST_F(Phases, OfOne_SayThatNothingIsKnownOfTheOthers) {
  const json cell = measure(std::string(kPhasesRun) + "--filters none --phases 1")[0];
  EXPECT_TRUE(cell["error"]["rmse_ci95"].is_null());
  EXPECT_TRUE(cell["error"]["flicker"].is_null());
  for (const char* field : {"error.rmse_ci95", "error.rmse_replicates", "error.flicker", "error.flicker_ci95"})
    EXPECT_THAT(cell["absent"][field].get<std::string>(), HasSubstr("--phases")) << field;
  EXPECT_THAT(read("out/index.html"), Not(HasSubstr("Smallest detectable RMSE difference")));
}

/// The weights differ under such a lamp: the run says so, errors follow the option, and pictures are held against the
/// same truth.
TEST_F(Phases, TruthWeight_ChoosesWhatVisibilityIsHeldAgainst) {
  write("low.toml", kLowLamp);
  const std::string start = std::string(kPhasesRun) + "--scene low.toml --filters none --phases 1 ";
  const json area = measure(start)[0], cosine = measure(start + "--truth-weight cosine")[0];
  EXPECT_GT(area["truth"]["weight_rmse"], 0.01);
  EXPECT_EQ(area["truth"]["weight_rmse"], cosine["truth"]["weight_rmse"]);
  EXPECT_THAT(area["warnings"].dump(), HasSubstr("choose with --truth-weight"));
  EXPECT_NE(area["error"]["rmse"], cosine["error"]["rmse"]);
  EXPECT_EQ(area["error"]["flip"], cosine["error"]["flip"]);
  const Outcome wrong = run(small(start + "--truth-weight cosin"));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--truth-weight: 'cosin' must be area or cosine"));
}

TEST_F(Phases, ByDefault_KernelsAreAsWideAsTheLightAsks_AndNoneIsWorseThanNoFilter) {
  const json cells =
      measure("--size 240x135 --map-size 512 --no-attribution --filters none,tent3x3,poisson,vsm,esm,evsm4");
  for (const json& cell : cells) {
    EXPECT_EQ(cell["kernel"]["class"], "light") << cell["filter"];
    EXPECT_GT(cell["kernel"]["light_texels"], 0.0) << cell["filter"];
    if (!cell["kernel"].contains("by_light")) continue;
    EXPECT_EQ(cell["kernel"]["by_light"], "radius");
    EXPECT_LT(cell["error"]["rmse"], cells[0]["error"]["rmse"]) << cell["filter"];
  }
}

constexpr int kFine = 4, kSmallWidth = 192, kSmallHeight = 108;

class Minification : public ProgramTest {
 protected:
  void measure(const char* out, int width, int height, const std::string& filters) const {
    succeed(fmt::format(
        "run --grids --scene minified --size {}x{} --map-size 2048 --rounds 1 --no-attribution --out {} --filter-file "
        "'{}/tests/user_filters/vsm_mips.glsl' --filters {}",
        width, height, out, SHADOWBENCH_SOURCE_DIR, filters));
  }

  std::vector<float> read(const char* out, const std::string& part) const {
    return images::read_stored_picture((folder() / out / "minified.exr").string() + "#" + part).image.texels;
  }
};

/// The mean of each pixel's finer pixels; less than 0 where some of them are no receivers.
std::vector<double> average(const std::vector<float>& fine, const std::vector<float>& mask) {
  std::vector<double> mean(kSmallWidth * kSmallHeight, 0.0);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const std::size_t x = i % (kFine * kSmallWidth) / kFine, y = i / (kFine * kSmallWidth) / kFine;
    mean[y * kSmallWidth + x] += mask[i] > 0.0f ? static_cast<double>(fine[i]) / (kFine * kFine) : -1e9;
  }
  return mean;
}

TEST_F(Minification, MipsEndFlicker_AndAnisotropyKeepsMoreOfTheShadow) {
  measure("small", kSmallWidth, kSmallHeight, "vsm_mips:lookup=finest,vsm_mips:lookup=mips,vsm_mips");
  measure("fine", kFine * kSmallWidth, kFine * kSmallHeight, "none --phases 1");
  const std::vector<double> truth = average(read("fine", "truth.area"), read("fine", "truth.mask"));
  std::map<std::string, double> flicker, rmse;
  const auto document = read_json("small/results.json");
  for (const auto& cell : document["cells"]) {
    const std::string lookup = cell["params"]["lookup"];
    EXPECT_GE(cell["coverage"]["fewest_texels_per_pixel"], 8.0);
    EXPECT_EQ(cell["status"], "ok");
    flicker[lookup] = cell["error"]["flicker"];
    const std::string label = lookup == "anisotropic" ? "vsm_mips" : fmt::format("vsm_mips (lookup={})", lookup);
    const std::vector<float> seen = read("small", label + ".visibility");
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (truth[i] < 0.0) continue;
      sum += std::pow(static_cast<double>(seen[i]) - truth[i], 2.0);
      count += 1.0;
    }
    ASSERT_GT(count, 2000.0);
    rmse[lookup] = std::sqrt(sum / count);
    std::printf("%s: flicker %.4f, RMSE to the mean truth of a pixel %.4f, to that of its middle %.4f\n",
                lookup.c_str(), flicker[lookup], rmse[lookup], cell["error"]["rmse"].get<double>());
  }
  EXPECT_LT(flicker["mips"], 0.4 * flicker["finest"]);
  EXPECT_LT(flicker["anisotropic"], 0.4 * flicker["finest"]);
  EXPECT_LT(rmse["anisotropic"], 0.5 * rmse["finest"]);
  EXPECT_LT(rmse["anisotropic"], 0.5 * rmse["mips"]) << "a square as wide as the footprint is long blurs";
}

/// What a run reports, checked with `shadowbench diff` from the pictures that the run left.
using Recheck = ProgramTest;

TEST_F(Recheck, DiffOfTheSavedPictures_GivesTheErrorsOfTheRun) {
  // A user's filter is drawn by another process: its picture has been through a file already.
  copy_filter("pcf2x2", "copied");
  const json cells = measure(
      "--grids --all-parts --size 96x54 --phases 1 --filters none,vsm:radius=6,pcf2x2,copied --filter-file "
      "copied.glsl");
  const auto diff = [&](const json& cell, const std::string& part, const std::string& rest) {
    const std::string label = cell["images"]["parts"];
    return json::parse(succeed("diff --json 'out/cubes.exr#" + label + part + "' 'out/cubes.exr#truth" + rest).out);
  };
  for (const json& cell : cells) {
    SCOPED_TRACE(cell["filter"]);
    const json values = diff(cell, ".visibility", ".area' --mask 'out/cubes.exr#truth.mask'");
    for (const char* name : {"rmse", "mae", "p95", "max", "mean"}) EXPECT_EQ(values[name], cell["error"][name]) << name;
    EXPECT_NE(values["rmse"], 0.0);
    EXPECT_EQ(values["compared"], cell["receivers"]);
    EXPECT_EQ(values["not_finite"], 0);
    EXPECT_EQ(diff(cell, ".picture", ".picture' --metric flip")["flip"], cell["error"]["flip"]);
    EXPECT_GT(cell["error"]["flip"], 0.0);
  }
}

}  // namespace
}  // namespace shadowbench::test
