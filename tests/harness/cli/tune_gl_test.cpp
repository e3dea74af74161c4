// `shadowbench tune` and `run --tuned`, as a user calls them.

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSmallScene = " --out out --scene cubes --map-size 128 --size 96x54 ";

class TuneCommand : public ProgramTest {
 protected:
  nlohmann::json read_tuned() const { return nlohmann::json::parse(read_text(folder() / "out" / "tuned.json")); }

  nlohmann::json read_results() const { return nlohmann::json::parse(read_text(folder() / "report" / "results.json")); }

  Outcome tune(const std::string& arguments) const { return run("tune" + std::string(kSmallScene) + arguments); }

  /// What the filter at its default scores in the view that is the scene's own.
  double default_score(const std::string& metric) const {
    EXPECT_EQ(tune("--filters poisson --budget 1 --metric " + metric).exit_code, 0);
    return read_default_score();
  }

  double read_default_score() const {
    const nlohmann::json tuned = read_tuned();
    for (const auto& view : tuned["filters"][0]["views"])
      if (view["view"] == "as it is") return view["score"]["default"].get<double>();
    return -1.0;
  }
};

TEST_F(TuneCommand, FindsParametersThatAreBetterOnUnseenViews) {
  const Outcome outcome = tune("--filters vsm:bleed_reduction=0,slope_variance=0,esm --budget 30");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* part :
       {"## vsm", "## esm", "Gain on unseen views", "within 10 % of the best", "out/tuned.json", "padded by 4"})
    EXPECT_THAT(outcome.out, HasSubstr(part));
  EXPECT_EQ(read_text(folder() / "out" / "tune.md") + "parameters: out/tuned.json\n", outcome.out);
  EXPECT_THAT(read_text(folder() / "out" / "tune.html"), HasSubstr("tuned.json"));
  const nlohmann::json tuned = read_tuned();
  ASSERT_EQ(tuned["filters"].size(), 2u);
  const nlohmann::json& vsm = tuned["filters"][0];
  EXPECT_EQ(vsm["verdict"], "better");
  EXPECT_LT(vsm["unseen"]["tuned"], vsm["unseen"]["default"]);
  EXPECT_EQ(vsm["searched"].size(), 2u);  // the others were set
  EXPECT_EQ(vsm["views"].size(), 9u);
  EXPECT_LE(vsm["search_evaluations"], 30);
  for (const auto& param : vsm["searched"]) EXPECT_EQ(vsm["params"][param["name"].get<std::string>()], param["found"]);
}

/// Of the filters given one has nothing to tune.
TEST_F(TuneCommand, UnderAFixedFit_GoesOnWithoutWhatCannotBeTuned) {
  const Outcome outcome =
      run("tune --out out --scene avenue --fit cascades:count=2,split=0.5,blend=0.1 --map-size 128 --size 96x54 "
          "--filters none,poisson --budget 3");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("there is nothing to tune of 'none'"));
  const nlohmann::json tuned = read_tuned();
  EXPECT_EQ(tuned["fit"], "cascades:count=2,split=0.5,blend=0.1,depths=all");
  ASSERT_EQ(tuned["filters"].size(), 1u);
  EXPECT_EQ(tuned["filters"][0]["id"], "poisson");
  EXPECT_EQ(tuned["filters"][0]["fit"], tuned["fit"]);
}

/// `run` under the fit that was found has the error that is said of it, and nearly the least of a scan: that is of one
/// of the three views that the fit was found on.
TEST_F(TuneCommand, OfCascades_FindsSplitAndBlend) {
  const std::string same = " --scene avenue --filters none --map-size 128 --size 96x54 ";
  const Outcome outcome = run("tune --out out --fit cascades:count=3 --budget 20" + same);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json filter = read_tuned()["filters"][0];
  EXPECT_EQ(filter["verdict"], "better");
  const nlohmann::json split = filter["searched"][0], blend = filter["searched"][1];
  EXPECT_EQ(split["name"], "split");
  EXPECT_EQ(blend["name"], "blend");
  const std::string found = fmt::format("cascades:count=3,split={},blend={},depths=all", split["found"].get<double>(),
                                        blend["found"].get<double>());
  EXPECT_EQ(filter["fit"], found);
  EXPECT_THAT(outcome.out, HasSubstr("--fit " + found));
  std::string fits = " --fit " + found + " --fit cascades:count=3";
  for (const double each : {0.3, 0.7, 0.8, 0.9, 1.0})
    if (each != split["found"].get<double>())  // or one fit is named twice
      fits += fmt::format(" --fit cascades:count=3,split={},blend={}", each, blend["found"].get<double>());
  const Outcome scan =
      run("run --out report --rounds 1 --phases 1 --no-attribution --pad-texels 1 --no-grids" + fits + same);
  ASSERT_EQ(scan.exit_code, 0) << scan.err;
  const nlohmann::json cells = read_results()["cells"];
  ASSERT_GE(cells.size(), 6u);
  for (const auto& view : filter["views"]) {
    if (view["view"] != "as it is") continue;
    EXPECT_EQ(view["score"]["tuned"], cells[0]["error"]["rmse"]);
    EXPECT_EQ(view["score"]["default"], cells[1]["error"]["rmse"]);
  }
  for (const auto& cell : cells) EXPECT_LT(cells[0]["error"]["rmse"], 1.1 * cell["error"]["rmse"].get<double>());
}

/// The camera stands by the edge of the ground and looks along it: turned away from it, it sees next to none.
TEST_F(TuneCommand, AViewOfFewReceivers_IsLeftOutAndNamed) {
  std::string scene = read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/data/scenes/teaching/avenue.toml");
  const std::size_t place = scene.find("position"), light = scene.find("vertical_fov_deg");
  ASSERT_LT(place, light);
  scene.replace(place, light - place, "position = [29.5, 1.7, -60]\ntarget = [29.5, 0.9, -75]\n");
  std::ofstream(folder() / "edge.toml") << scene;
  const Outcome outcome =
      run("tune --out out --scene edge.toml --map-size 128 --size 96x54 --filters poisson --budget 1");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(read_text(folder() / "out" / "tune.md"), HasSubstr("receivers, less than half the "));
  EXPECT_LT(read_tuned()["filters"][0]["views"].size(), 9u);
}

/// exp(c) of the cleared depth 1 is infinite in r32f above c = 88.72, wherever the image shows it or not.
TEST_F(TuneCommand, SettingsThatOverflowTheMap_CountAsWhollyWrong) {
  ASSERT_EQ(tune("--filters esm:radius=0 --budget 3").exit_code, 0);
  std::stringstream csv(read_text(folder() / "out" / "evaluations.csv"));
  int overflown = 0;
  for (std::string line; std::getline(csv, line);) {
    const std::size_t at = line.find("c=");
    if (at == std::string::npos || std::stod(line.substr(at + 2)) < 88.73) continue;
    EXPECT_THAT(line, HasSubstr(",1\r"));
    ++overflown;
  }
  EXPECT_GT(overflown, 3);
}

TEST_F(TuneCommand, Evaluations_AreAllInTheTable) {
  ASSERT_EQ(tune("--filters esm --budget 12").exit_code, 0);
  const std::string csv = read_text(folder() / "out" / "evaluations.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + read_tuned()["filters"][0]["evaluations"].get<int>());
  EXPECT_THAT(csv, HasSubstr("esm,1,default,radius=4 c=80,"));
}

TEST_F(TuneCommand, IsTheSameTwice) {
  ASSERT_EQ(tune("--filters poisson --budget 10").exit_code, 0);
  const std::string first = read_text(folder() / "out" / "tuned.json"),
                    table = read_text(folder() / "out" / "evaluations.csv");
  ASSERT_EQ(tune("--filters poisson --budget 10 --no-cache").exit_code, 0);
  EXPECT_EQ(read_text(folder() / "out" / "tuned.json"), first);
  EXPECT_EQ(read_text(folder() / "out" / "evaluations.csv"), table);
}

/// What is made small is what 'run' reports, of the same map.
TEST_F(TuneCommand, Scores_AreThoseOfRun) {
  ASSERT_EQ(run("run --out report --scene cubes --map-size 128 --size 96x54 --rounds 1 --phases 1 --no-attribution "
                "--filters poisson --width own --pad-texels 4")
                .exit_code,
            0);
  const nlohmann::json error = read_results()["cells"][0]["error"];
  for (const char* metric : {"rmse", "mae", "p95", "flip"})
    EXPECT_EQ(default_score(metric), error[metric].get<double>()) << metric;
}

/// The depth bias lights what is blocked: that is a gap, and no leak.
TEST_F(TuneCommand, Leak_IsThatOfRun_UnderMuchBias) {
  const std::string same = " --scene cubes --map-size 512 --size 240x135 --filters poisson --bias constant:depth=0.1 ";
  ASSERT_EQ(run("run --out report --rounds 1 --phases 1 --no-attribution --width own --pad-texels 4" + same).exit_code,
            0);
  const nlohmann::json artefact = read_results()["cells"][0]["artefact"];
  EXPECT_GT(artefact["contact_gap"], 0.9);
  EXPECT_LT(artefact["leak"], 0.01);
  ASSERT_EQ(run("tune --out out --budget 1 --metric leak" + same).exit_code, 0);
  EXPECT_EQ(read_default_score(), artefact["leak"].get<double>());
}

TEST_F(TuneCommand, Acne_IsTunedOverItsMask) {
  const Outcome outcome = tune("--filters poisson --metric acne --budget 4 --bias none");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json filter = read_tuned()["filters"][0];
  EXPECT_GT(filter["training"]["default"], 0.1);  // without bias
  EXPECT_TRUE(filter["unseen_truth_se"].is_null());
  ASSERT_EQ(tune("--filters poisson --metric acne --budget 1").exit_code, 0);
  EXPECT_LT(read_tuned()["filters"][0]["training"]["default"], 0.02);
}

/// Nobody asked for 'fence' by name: its bars are too thin for a leak.
TEST_F(TuneCommand, ScenesWithoutTheMetric_AreSkipped_WhereNoneIsNamed) {
  const Outcome outcome =
      run("tune --out out --map-size 256 --size 240x135 --metric leak --filters poisson --budget 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json scenes = read_tuned()["scenes"];
  EXPECT_GE(scenes.size(), 1u);
  EXPECT_EQ(std::count(scenes.begin(), scenes.end(), "fence"), 0);
  EXPECT_THAT(outcome.out, HasSubstr("Left out:\n\n- fence, "));
  EXPECT_THAT(outcome.out, HasSubstr("- fence, as it is"));
}

TEST_F(TuneCommand, Run_TakesTheParameters_AndTheCommandLineGoesFirst) {
  ASSERT_EQ(tune("--filters vsm:bleed_reduction=0,slope_variance=0 --budget 20").exit_code, 0);
  const nlohmann::json params = read_tuned()["filters"][0]["params"];
  const Outcome outcome =
      run("run --out report --scene cubes --map-size 64 --size 96x54 --rounds 1 --no-truth --tuned out/tuned.json "
          "--filters vsm,vsm:radius=9,esm --width own");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("no parameters for esm"));
  EXPECT_THAT(outcome.err, HasSubstr("128 texels, this run draws 64"));
  const nlohmann::json cells = read_results()["cells"];
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0]["params"], params);
  EXPECT_NE(params["radius"], 4);
  EXPECT_EQ(cells[1]["params"]["radius"], 9);
  EXPECT_EQ(cells[1]["params"]["min_variance"], params["min_variance"]);
  EXPECT_EQ(cells[2]["params"]["radius"], 4);
}

TEST_F(TuneCommand, BadInput_IsRefused) {
  expect_refusal("tune --out out", 2, {"--filter", "required"});
  expect_refusal("tune --out out --filters ''", 2, {"--filters", "at least one"});
  expect_refusal("tune --out out --filters vsn", 2, {"'vsn'", "vsm"});
  expect_refusal("tune --out out --filters none", 2, {"nothing to tune", "'none'"});
  expect_refusal("tune --out out --filters poisson:radius=2", 2, {"nothing to tune", "poisson (radius=2)"});
  expect_refusal("tune --out out --filters vsm,vsm:store=rg16f", 2, {"names 'vsm' twice", "--out"});
  expect_refusal("tune --out out --filters nine_compares --filter-file " + user_filter("nine_compares.glsl"), 2,
                 {"--filter-file", "built-in"});
  expect_refusal("tune --out out --filters vsm --metric ssim", 2, {"'ssim'", "rmse, mae, p95, flip, leak, acne"});
  expect_refusal("tune --out out --filters vsm --budget 0", 2, {"--budget", "'0'"});
  expect_refusal("tune --out out --filters vsm --budget 10001", 2, {"--budget", "10001", "1 .. 10000"});
  expect_refusal("tune --out out --filters vsm --light noon", 2, {"--light", "'noon'"});
  expect_refusal("tune --out out --filters vsm --bias receiver-plane", 2, {"vsm"});
  expect_refusal("tune --out out --filters vsm --scene stepz", 2, {"'stepz'", "steps"});
  expect_refusal("tune --out out --filters vsm --scene cubes --scene cubes", 2, {"two scenes", "'cubes'"});
  expect_refusal("tune --filters vsm --metric leak" + std::string(kSmallScene), 3,
                 {"'cubes'", "leak", "needs 100", "--scene"});
  write("file", "");
  expect_refusal("tune --filters vsm --scene cubes --map-size 64 --size 32x18 --budget 1 --out file/out", 6, {"file"});
  EXPECT_FALSE(std::filesystem::exists(folder() / "out" / "tuned.json"));
}

TEST_F(TuneCommand, BadTunedFiles_AreRefused) {
  write("cut.json", "{\"schema_version\": 1,");
  expect_refusal("run --out out --scene cubes --tuned cut.json", 3, {"cut.json", "cut off"});
  expect_refusal("run --out out --scene cubes --tuned none.json", 3, {"none.json", "--tuned"});
  write(
      "wide.json",
      R"({"schema_version": 2, "metric": "rmse", "map_size": 64, "filters": [{"id": "vsm", "fit": "tight", "params": {"radius": 65}}]})");
  expect_refusal("run --out out --scene cubes --tuned wide.json", 3,
                 {"wide.json", "filters[0].params.radius", "0 .. 64"});
}

}  // namespace
}  // namespace shadowbench::test
