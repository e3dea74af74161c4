// `shadowbench bias`, `stress`, `tune` and `run --tuned`, as a user calls them.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "report/images/picture_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

class BiasCommand : public ProgramTest {
 protected:
  std::vector<std::vector<std::string>> read_csv() const {
    std::stringstream text(read("out/bias.csv"));
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
  const Outcome outcome = succeed("bias --out out --size 160x90 --map-size 128 --filters none,tent3x3,vsm");
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
  const std::string page = read("out/bias.html");
  EXPECT_THAT(page, HasSubstr("Left out: vsm"));
  for (const auto& [mode, count] : rows) {
    if (mode == "mode") continue;
    EXPECT_THAT(page, HasSubstr("bias." + mode + ".png"));
    EXPECT_GT(images::read_picture(folder() / "out" / ("bias." + mode + ".png")).width, 160) << mode;
  }
}

TEST_F(BiasCommand, AMapThatCullingEmpties_IsLeftOut) {
  write("open.toml",
        "title = \"open\"\n[camera]\nposition = [3, 5, 5]\ntarget = [0, 0, 0]\n[light]\nazimuth_deg = 40\n"
        "elevation_deg = 50\n[[object]]\nshape = \"plane\"\nsize = [8, 8]\n");
  succeed("bias --out out --scene open.toml --size 160x90 --map-size 128 --filters none,vsm");
  for (const auto& row : read_csv()) EXPECT_NE(row.at(3), "front-cull");
  const std::string page = read("out/bias.html");
  EXPECT_THAT(page, HasSubstr("Left out: none, which would read an empty map"));
  EXPECT_FALSE(exists("out/bias.front-cull.png"));
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
  succeed(small + "out");
  EXPECT_THAT(list_scenes(), ElementsAre("three_lights.bulb", "three_lights.spot", "three_lights.sun"));
  EXPECT_THAT(read("out/bias.html"), HasSubstr("Depth bias on three_lights under sun, spot, bulb, map 128, 160 x 90"));
  EXPECT_TRUE(exists("out/bias.bulb.constant.png"));
  const std::string file = user_filter("nine_compares.glsl");
  succeed(small + "out --light-name spot --ground --filter-file '" + file + "'");
  EXPECT_THAT(list_scenes(), ElementsAre("three_lights.spot"));
  EXPECT_NE(acne("constant", "nine_compares", "1"), "no row");
  expect_refusal(small + "none --light-name moon", 2, {"--light-name", "'moon'"});
}

TEST_F(BiasCommand, BesideAReport_ItsAnswerHasTheBiasToShip) {
  const std::string same = " --scene fence --size 160x90 --map-size 128 --filters none,pcf2x2 --out out";
  succeed("run --rounds 1 --phases 1" + same);
  EXPECT_THAT(read("out/summary.md"), Not(HasSubstr("bias to ship")));
  succeed("bias" + same + "/bias");
  EXPECT_THAT(read("out/summary.md"), HasSubstr("| bias to ship | fence: "));
}

TEST_F(BiasCommand, BadInput_IsRefused) {
  expect_refusals(
      {{"bias --out out --scene stepz", 2, {"'stepz'", "steps"}},
       {"bias --out out --scene no/such.toml", 3, {"no/such.toml"}},
       {"bias --out out --filters tent3", 2, {"'tent3'", "tent3x3"}},
       {"bias --out out --filters none,none", 2, {"names 'none' twice"}},
       {"bias --size 240x135 --map-size 128 --out out --filter-file " + user_filter("broken_glsl.glsl"),
        5,
        {"broken_glsl.glsl"}},
       {"bias --out out --map-size 0", 2, {"--map-size", "'0'"}},
       {"bias --out out --size 12", 2, {"--size", "'12'"}},
       {"bias --out out --size 8x8 --map-size 64 --filters none", 3, {"wholly lit", "100 are needed", "--size"}}});
  write("file", "");
  expect_refusal("bias --scene steps --filters none --out file/out --size 64x36 --map-size 64", 6, {"file"});
}

class StressCommand : public ProgramTest {
 protected:
  json read_stress() const { return read_json("out/stress.json"); }
};

TEST_F(StressCommand, WritesTheReport_WithLimitsBesideTheory) {
  const Outcome outcome = succeed("stress --out out --filters vsm --axes warp-exponent,vsm-cancellation");
  for (const char* name : {"stress.json", "stress.md", "stress.html", "stress.csv"})
    EXPECT_TRUE(exists(std::string("out/") + name)) << name;
  EXPECT_THAT(outcome.out, HasSubstr("out/stress.html"));
  for (const char* chart : {"id=\"stress.warp-exponent\"", "id=\"stress.vsm-cancellation\""})
    EXPECT_THAT(read("out/stress.html"), HasSubstr(chart));
  const json stress = read_stress();
  ASSERT_EQ(stress["axes"].size(), 2u);
  EXPECT_EQ(stress["axes"][0]["id"], "warp-exponent");
  EXPECT_EQ(stress["filters"], json({"vsm"}));
  EXPECT_NEAR(stress["axes"][0]["cases"][0]["limits"][0]["ratio"].get<double>(), 1.0, 0.02);
  EXPECT_EQ(stress["disagreements"], 0);
}

TEST_F(StressCommand, WhatIsNotAvailable_IsSaid) {
  const Outcome outcome = succeed("stress --out out --filters vsm --axes esm-exponent");
  EXPECT_THAT(outcome.err,
              HasSubstr("not available: filters (GL): no chosen filter's front matter declares 'exponent'"));
  EXPECT_THAT(read("out/stress.html"), HasSubstr("not available"));
}

TEST_F(StressCommand, BadInput_IsRefused) {
  expect_refusals({{"stress --out out --axes esm-exponnet", 2, {"--axes", "'esm-exponnet'", "esm-exponent"}},
                   {"stress --out out --axes esm-exponent, ", 2, {"--axes", "''"}},
                   {"stress --out out --range esm-exponent=10,10", 2, {"--range", "empty"}},
                   {"stress --out out --axes warp-exponent --range esm-exponent=1,10", 2, {"not among --axes"}},
                   {"stress --out out --filters vsn", 2, {"'vsn'", "vsm"}},
                   {"stress --out out --filter-file " + user_filter("nine_compares.glsl"),
                    2,
                    {"--filter-file", "no scalar model", "nine_compares.glsl"}},
                   {"stress --out out --gl vulkan", 2, {"'vulkan'"}},
                   {"stress --out out --cache kept", 2, {"--cache is gone"}},
                   {"stress --out /proc/none", 6, {"/proc/none"}}});
}

constexpr const char* kSmallScene = " --out out --scene cubes --map-size 128 --size 96x54 ";

class TuneCommand : public ProgramTest {
 protected:
  json read_tuned() const { return read_json("out/tuned.json"); }

  Outcome tune(const std::string& arguments) const { return succeed("tune" + std::string(kSmallScene) + arguments); }

  /// What the filter at its default scores in the view that is the scene's own.
  double read_default_score() const {
    const json tuned = read_tuned();
    for (const auto& view : tuned["filters"][0]["views"])
      if (view["view"] == "as it is") return view["score"]["default"].get<double>();
    return -1.0;
  }
};

TEST_F(TuneCommand, FindsParametersThatAreBetterOnUnseenViews) {
  const Outcome outcome = tune("--filters vsm:bleed_reduction=0,slope_variance=0,esm --budget 30");
  for (const char* part :
       {"## vsm", "## esm", "Gain on unseen views", "within 10 % of the best", "out/tuned.json", "padded by 4"})
    EXPECT_THAT(outcome.out, HasSubstr(part));
  EXPECT_EQ(read("out/tune.md") + "parameters: out/tuned.json\n", outcome.out);
  EXPECT_THAT(read("out/tune.html"), HasSubstr("tuned.json"));
  const json tuned = read_tuned();
  ASSERT_EQ(tuned["filters"].size(), 2u);
  const json& vsm = tuned["filters"][0];
  EXPECT_EQ(vsm["verdict"], "better");
  EXPECT_LT(vsm["unseen"]["tuned"], vsm["unseen"]["default"]);
  EXPECT_EQ(vsm["searched"].size(), 2u);  // the others were set
  EXPECT_EQ(vsm["views"].size(), 9u);
  EXPECT_LE(vsm["search_evaluations"], 30);
  for (const auto& param : vsm["searched"]) EXPECT_EQ(vsm["params"][param["name"].get<std::string>()], param["found"]);
}

/// Of the filters given one has nothing to tune.
TEST_F(TuneCommand, UnderAFixedFit_GoesOnWithoutWhatCannotBeTuned) {
  const Outcome outcome = succeed(
      "tune --out out --scene avenue --fit cascades:count=2,split=0.5,blend=0.1 --map-size 128 --size 96x54 "
      "--filters none,poisson --budget 3");
  EXPECT_THAT(outcome.err, HasSubstr("there is nothing to tune of 'none'"));
  const json tuned = read_tuned();
  EXPECT_EQ(tuned["fit"], "cascades:count=2,split=0.5,blend=0.1,depths=all");
  ASSERT_EQ(tuned["filters"].size(), 1u);
  EXPECT_EQ(tuned["filters"][0]["id"], "poisson");
  EXPECT_EQ(tuned["filters"][0]["fit"], tuned["fit"]);
}

/// `run` under the fit that was found has the error that is said of it, and nearly the least of a scan: that is of one
/// of the three views that the fit was found on.
TEST_F(TuneCommand, OfCascades_FindsSplitAndBlend) {
  const std::string same = " --scene avenue --filters none --map-size 128 --size 96x54 ";
  const Outcome outcome = succeed("tune --out out --fit cascades:count=3 --budget 20" + same);
  const json filter = read_tuned()["filters"][0];
  EXPECT_EQ(filter["verdict"], "better");
  const json split = filter["searched"][0], blend = filter["searched"][1];
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
  succeed("run --out report --rounds 1 --phases 1 --no-attribution --pad-texels 1 --no-grids" + fits + same);
  const json cells = read_cells("report");
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
  std::string scene = read_source("data/scenes/teaching/avenue.toml");
  const std::size_t place = scene.find("position"), light = scene.find("vertical_fov_deg");
  ASSERT_LT(place, light);
  scene.replace(place, light - place, "position = [29.5, 1.7, -60]\ntarget = [29.5, 0.9, -75]\n");
  write("edge.toml", scene);
  succeed("tune --out out --scene edge.toml --map-size 128 --size 96x54 --filters poisson --budget 1");
  EXPECT_THAT(read("out/tune.md"), HasSubstr("receivers, less than half the "));
  EXPECT_LT(read_tuned()["filters"][0]["views"].size(), 9u);
}

/// exp(c) of the cleared depth 1 is infinite in r32f above c = 88.72, wherever the image shows it or not.
TEST_F(TuneCommand, SettingsThatOverflowTheMap_CountAsWhollyWrong) {
  tune("--filters esm:radius=0 --budget 3");
  std::stringstream csv(read("out/evaluations.csv"));
  int overflown = 0;
  for (std::string line; std::getline(csv, line);) {
    const std::size_t at = line.find("c=");
    if (at == std::string::npos || std::stod(line.substr(at + 2)) < 88.73) continue;
    EXPECT_THAT(line, HasSubstr(",1\r"));
    ++overflown;
  }
  EXPECT_GT(overflown, 3);
}

TEST_F(TuneCommand, IsTheSameTwice_WithAllEvaluationsInTheTable) {
  tune("--filters esm --budget 12");
  const std::string first = read("out/tuned.json"), table = read("out/evaluations.csv");
  EXPECT_EQ(std::ranges::count(table, '\n'), 1 + read_tuned()["filters"][0]["evaluations"].get<int>());
  EXPECT_THAT(table, HasSubstr("esm,1,default,radius=4 c=80,"));
  tune("--filters esm --budget 12 --no-cache");
  EXPECT_EQ(read("out/tuned.json"), first);
  EXPECT_EQ(read("out/evaluations.csv"), table);
}

/// What is made small is what 'run' reports, of the same map.
TEST_F(TuneCommand, Scores_AreThoseOfRun) {
  succeed(
      "run --out report --scene cubes --map-size 128 --size 96x54 --rounds 1 --phases 1 --no-attribution "
      "--filters poisson --width own --pad-texels 4");
  const json error = read_cells("report")[0]["error"];
  for (const char* metric : {"rmse", "mae", "p95", "flip"}) {
    tune(std::string("--filters poisson --budget 1 --metric ") + metric);
    EXPECT_EQ(read_default_score(), error[metric].get<double>()) << metric;
  }
}

/// The depth bias lights what is blocked: that is a gap, and no leak.
TEST_F(TuneCommand, Leak_IsThatOfRun_UnderMuchBias) {
  const std::string same = " --scene cubes --map-size 512 --size 240x135 --filters poisson --bias constant:depth=0.1 ";
  succeed("run --out report --rounds 1 --phases 1 --no-attribution --width own --pad-texels 4" + same);
  const json artefact = read_cells("report")[0]["artefact"];
  EXPECT_GT(artefact["contact_gap"], 0.9);
  EXPECT_LT(artefact["leak"], 0.01);
  succeed("tune --out out --budget 1 --metric leak" + same);
  EXPECT_EQ(read_default_score(), artefact["leak"].get<double>());
}

TEST_F(TuneCommand, Acne_IsTunedOverItsMask) {
  const Outcome outcome = tune("--filters poisson --metric acne --budget 4 --bias none");
  const json filter = read_tuned()["filters"][0];
  EXPECT_GT(filter["training"]["default"], 0.1);  // without bias
  EXPECT_TRUE(filter["unseen_truth_se"].is_null());
  tune("--filters poisson --metric acne --budget 1");
  EXPECT_LT(read_tuned()["filters"][0]["training"]["default"], 0.02);
}

/// Nobody asked for 'fence' by name: its bars are too thin for a leak.
TEST_F(TuneCommand, ScenesWithoutTheMetric_AreSkipped_WhereNoneIsNamed) {
  const Outcome outcome =
      succeed("tune --out out --map-size 256 --size 240x135 --metric leak --filters poisson --budget 2");
  const json scenes = read_tuned()["scenes"];
  EXPECT_GE(scenes.size(), 1u);
  EXPECT_EQ(std::count(scenes.begin(), scenes.end(), "fence"), 0);
  EXPECT_THAT(outcome.out, HasSubstr("Left out:\n\n- fence, "));
  EXPECT_THAT(outcome.out, HasSubstr("- fence, as it is"));
}

TEST_F(TuneCommand, Run_TakesTheParameters_AndTheCommandLineGoesFirst) {
  tune("--filters vsm:bleed_reduction=0,slope_variance=0 --budget 20");
  const json params = read_tuned()["filters"][0]["params"];
  const Outcome outcome = succeed(
      "run --out report --scene cubes --map-size 64 --size 96x54 --rounds 1 --no-truth --tuned out/tuned.json "
      "--filters vsm,vsm:radius=9,esm --width own");
  EXPECT_THAT(outcome.err, HasSubstr("no parameters for esm"));
  EXPECT_THAT(outcome.err, HasSubstr("128 texels, this run draws 64"));
  const json cells = read_cells("report");
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0]["params"], params);
  EXPECT_NE(params["radius"], 4);
  EXPECT_EQ(cells[1]["params"]["radius"], 9);
  EXPECT_EQ(cells[1]["params"]["min_variance"], params["min_variance"]);
  EXPECT_EQ(cells[2]["params"]["radius"], 4);
}

TEST_F(TuneCommand, BadInput_IsRefused) {
  expect_refusals({{"tune --out out", 2, {"--filter", "required"}},
                   {"tune --out out --filters ''", 2, {"--filters", "at least one"}},
                   {"tune --out out --filters vsn", 2, {"'vsn'", "vsm"}},
                   {"tune --out out --filters none", 2, {"nothing to tune", "'none'"}},
                   {"tune --out out --filters poisson:radius=2", 2, {"nothing to tune", "poisson (radius=2)"}},
                   {"tune --out out --filters vsm,vsm:store=rg16f", 2, {"names 'vsm' twice", "--out"}},
                   {"tune --out out --filters nine_compares --filter-file " + user_filter("nine_compares.glsl"),
                    2,
                    {"--filter-file", "built-in"}},
                   {"tune --out out --filters vsm --metric ssim", 2, {"'ssim'", "rmse, mae, p95, flip, leak, acne"}},
                   {"tune --out out --filters vsm --budget 0", 2, {"--budget", "'0'"}},
                   {"tune --out out --filters vsm --budget 10001", 2, {"--budget", "10001", "1 .. 10000"}},
                   {"tune --out out --filters vsm --light noon", 2, {"--light", "'noon'"}},
                   {"tune --out out --filters vsm --bias receiver-plane", 2, {"vsm"}},
                   {"tune --out out --filters vsm --scene stepz", 2, {"'stepz'", "steps"}},
                   {"tune --out out --filters vsm --scene cubes --scene cubes", 2, {"two scenes", "'cubes'"}},
                   {"tune --filters vsm --metric leak" + std::string(kSmallScene),
                    3,
                    {"'cubes'", "leak", "needs 100", "--scene"}}});
  write("file", "");
  expect_refusal("tune --filters vsm --scene cubes --map-size 64 --size 32x18 --budget 1 --out file/out", 6, {"file"});
  EXPECT_FALSE(exists("out/tuned.json"));
}

TEST_F(TuneCommand, BadTunedFiles_AreRefused) {
  write("cut.json", "{\"schema_version\": 1,");
  expect_refusal("run --out out --scene cubes --tuned cut.json", 3, {"cut.json", "cut off"});
  expect_refusal("run --out out --scene cubes --tuned none.json", 3, {"none.json", "--tuned"});
}

}  // namespace
}  // namespace shadowbench::test
