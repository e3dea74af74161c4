#include "tests/harness/cli/faults.h"

namespace shadowbench::test {
namespace {

// Experiments of many cells: overridden, interrupted, continued, sharded and merged, as a user does it.

constexpr const char* kExperiment =
    "title = 'small'\nscene = ['cubes', 'stack']\nmap_size = [32, 64]\nsize = '64x36'\nrounds = 1\ngrids = "
    "false\nattribution = false\n"
    "[[filter]]\nid = 'none'\n[[filter]]\nid = 'vsm'\nradius = [1, 2, 3]\n[[filter]]\nid = 'poisson'\ntaps = [8, 16]\n"
    "radius = {linear = [1, 4], count = 4}\n";
constexpr std::size_t kCells = 2 * 2 * (1 + 3 + 2 * 4);

/// Experiments of many cells, in a folder with e.toml.
class Sweep : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    write("e.toml", kExperiment);
  }

  std::map<std::string, std::filesystem::file_time_type> cell_times() const {
    std::map<std::string, std::filesystem::file_time_type> times;
    for (const auto& entry : std::filesystem::directory_iterator(folder() / "out" / "cells"))
      times[entry.path().filename().string()] = entry.last_write_time();
    return times;
  }
};

TEST_F(Sweep, MeasuresTheProduct_AndTheCommandLineHasTheLastWord) {
  Outcome outcome = succeed("run e.toml --out out");
  EXPECT_THAT(outcome.err, HasSubstr(std::to_string(kCells) + " cells\n"));
  const json all = read_results();
  EXPECT_EQ(all["cells"].size(), kCells);
  EXPECT_EQ(all["experiment"]["title"], "small");
  EXPECT_EQ(all["experiment"]["cells"], kCells);
  for (const json& cell : all["cells"]) {
    EXPECT_TRUE(exists("out/" + cell["images"]["visibility"].get<std::string>()));
    EXPECT_TRUE(cell["images"]["grid"].is_null());
    EXPECT_FALSE(cell["error"]["rmse"].is_null());
    EXPECT_FALSE(cell["ratio_to_none"]["moving"].is_null());
    EXPECT_EQ(cell["time_ms"]["stopped"], "rounds");
  }
  succeed("run e.toml --out small --scene cubes --map-size 16 --filters pcf2x2 --size 32x18,16x9");
  const json one = read_results("small");
  ASSERT_EQ(one["cells"].size(), 2u);
  EXPECT_EQ(one["cells"][0]["map_size"], 16);
  EXPECT_EQ(one["cells"][0]["size"]["width"], 32);
  EXPECT_EQ(one["cells"][1]["size"]["width"], 16);
  EXPECT_NE(one["cells"][0]["images"]["visibility"], one["cells"][1]["images"]["visibility"]);
  EXPECT_FALSE(one["cells"][0]["ratio_to_none"]["lookup"].is_null())
      << "timed beside the reference, which is not in the run";
}

/// What the files hold decides, not when they were written: the clock may have been set back, or forth.
TEST_F(Sweep, ReportIsThatOfItsCells_WhateverTheClockSaid) {
  succeed("run e.toml --out out --scene cubes --map-size 32");
  const std::string again = "run e.toml --out out --scene cubes --map-size 32";
  const std::filesystem::path written = folder() / "out" / "results.json";
  using std::chrono::hours;
  std::filesystem::last_write_time(written, std::filesystem::file_time_type::clock::now() - hours(1));
  EXPECT_THAT(run(again).err, HasSubstr("nothing is left to do"));
  const std::string cell = "out/cells/" + read_cells()[0]["key"].get<std::string>() + ".json";
  json slower = json::parse(read_text(folder() / cell));
  slower["cell"]["time_ms"]["lookup"]["median"] = 12345.0;
  write(cell, slower.dump());
  std::filesystem::last_write_time(written, std::filesystem::file_time_type::clock::now() + hours(1));
  succeed(again);
  EXPECT_EQ(read_cells()[0]["time_ms"]["lookup"]["median"], 12345.0);
}

TEST_F(Sweep, Grids_OfAFinishedRun_AreDrawnAgainInAnotherWidth) {
  const std::string again =
      "run --grids --pictures --scene cubes --filters none --size 64x36 --map-size 32 --rounds 1 --phases 1 --out out";
  ASSERT_EQ(run(again).exit_code, 0);
  const auto before = cell_times();
  const std::filesystem::path grid = folder() / "out" / "cubes.grid.png";
  const std::string usual = read_text(grid);
  ASSERT_EQ(run(again + " --grid-width 700").exit_code, 0);
  EXPECT_NE(read_text(grid), usual);
  EXPECT_EQ(cell_times(), before) << "nothing is measured again";
  EXPECT_THAT(run(again + " --grid-width=700").err, HasSubstr("nothing is left to do"));
  ASSERT_EQ(run(again + " --grid-width 3.3in").exit_code, 0);
  EXPECT_EQ(read_results()["cells"][0]["images"]["grid"], "cubes.grid.svg");
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "cubes.grid.svg"));
  ASSERT_EQ(run(again).exit_code, 0);
  EXPECT_EQ(read_text(grid), usual);
}

TEST_F(Sweep, Continued_MeasuresNothingTwice_UnlessSomethingChanged) {
  succeed("run e.toml --out out");
  const auto before = cell_times();
  const json first = read_results();
  Outcome outcome = succeed("run e.toml --out out");
  EXPECT_THAT(outcome.err, HasSubstr(std::to_string(kCells) + " of them finished before"));
  EXPECT_EQ(cell_times(), before);
  EXPECT_THAT(outcome.err, HasSubstr("nothing is left to do"));
  EXPECT_THAT(run("run e.toml --out out --precision 0.2 --budget 1").err, HasSubstr("nothing is left to do"))
      << "the number of rounds is told";
  EXPECT_EQ(read_results(), first);
  // Without its page or its results the report is made again, and nothing else.
  for (const char* page : {"index.html", "summary.md"}) {
    std::filesystem::remove(folder() / "out" / page);
    succeed("run e.toml --out out");
    EXPECT_TRUE(exists(std::string("out/") + page));
  }
  std::filesystem::remove(folder() / "out" / "results.json");
  succeed("run e.toml --out out");
  EXPECT_EQ(cell_times(), before);
  EXPECT_EQ(read_cells(), first["cells"]);
  EXPECT_EQ(read_results()["work"]["passes_run"], 0);
  EXPECT_TRUE(read_results()["work"]["attribution_s"].is_null()) << "not asked for";
  // One cell is gone, one is cut off.
  std::filesystem::remove(folder() / "out" / "cells" / before.begin()->first);
  write("out/cells/" + before.rbegin()->first, "{");
  outcome = run("run e.toml --out out");
  EXPECT_THAT(outcome.err, HasSubstr(std::to_string(kCells - 2) + " of them finished before"));
  const auto after = cell_times();
  std::size_t same = 0;
  for (const auto& [name, time] : before) same += after.at(name) == time ? 1 : 0;
  EXPECT_EQ(same, kCells - 2);
  // Another seed is another measurement, and so is a fresh one.
  EXPECT_THAT(run("run e.toml --out out --seed 2").err, Not(HasSubstr("finished before")));
  EXPECT_THAT(run("run e.toml --out out --seed 2 --fresh").err, Not(HasSubstr("finished before")));
}

/// Whatever draws them, cells are of one experiment; but a run counts those of its own OpenGL alone as finished.
TEST_F(Sweep, CellsOfAnotherOpenGl_AreMeasuredAnew_AndThoseOfAnotherProcessorStay) {
  const std::string few = "run e.toml --scene cubes --map-size 32 --filters none,pcf2x2,tent3x3,vsm --out out";
  succeed(few);
  const json first = read_results();
  ASSERT_EQ(first["cells"].size(), 4u);
  EXPECT_EQ(first["cells"][0]["machine"]["renderer"], first["gl"]["renderer"]);
  EXPECT_EQ(first["cells"][0]["machine"]["cpu"], first["machine"]["cpu"]);
  const auto edit = [&](std::size_t i, const json& patch) {
    const std::string cell = "out/cells/" + first["cells"][i]["key"].get<std::string>() + ".json";
    write(cell, json::parse(read_text(folder() / cell)).patch(patch).dump());
  };
  edit(0, json::parse(R"([{"op": "replace", "path": "/cell/machine/renderer", "value": "another"}])"));
  edit(1, json::parse(R"([{"op": "remove", "path": "/cell/machine"}])"));
  edit(2, json::parse(R"([{"op": "replace", "path": "/cell/machine/cpu", "value": "another"}])"));
  EXPECT_THAT(run(few).err, HasSubstr("2 of them finished before"));
  const json second = read_results();
  EXPECT_EQ(second["experiment"], first["experiment"]);
  for (const std::size_t measured : {0, 1})
    EXPECT_EQ(second["cells"][measured]["machine"], first["cells"][measured]["machine"]);
  EXPECT_EQ(second["cells"][2]["machine"]["cpu"], "another");
}

TEST_F(Sweep, ClaimsOfAUsersFilter_AreInItsCells) {
  copy_filter("none", "mine", "claims = [\"own-claim\"]\n");
  succeed(small("--map-size 32 --size 32x18 --no-attribution --filters none,mine --filter-file mine.glsl"));
  EXPECT_EQ(read_cells()[0]["claims"], json::array());
  EXPECT_EQ(read_cells()[1]["claims"], json::array({"own-claim"}));
  // So small a picture has too few pixels for rates.
  EXPECT_THAT(read_cells()[0]["absent"]["artefact.leak"].get<std::string>(), StartsWith("fewer than 100 receivers"));
  EXPECT_THAT(read_cells()[0]["nothing_to_see"], Contains("artefact.leak"));
  EXPECT_EQ(run("advise out --max-leak 1").exit_code, 1);
}

TEST_F(Sweep, Killed_LeavesAPageOfWhatIsFinished) {
  const pid_t pid = start("run e.toml --out out");
  EXPECT_TRUE(wait_until([&] { return count_cells() >= kCells / 2 + 4; }));
  kill(pid, SIGKILL);
  wait_for(pid);
  EXPECT_FALSE(exists("out/results.json"));
  EXPECT_THAT(read("out/index.html"), HasSubstr("1 of 2 scenes, 24 of 48 cells"));
  succeed("run e.toml --out out");
  EXPECT_THAT(read("out/index.html"), Not(HasSubstr("of 2 scenes")));
}

TEST_F(Sweep, ShardsMerged_EqualTheWhole) {
  succeed("run e.toml --out whole");
  std::size_t cells = 0;
  for (const char* shard : {"1", "2", "3"}) {
    succeed("run e.toml --shard " + std::string(shard) + "/3 --out s" + shard);
    cells += read_results(std::string("s") + shard)["cells"].size();
  }
  EXPECT_EQ(cells, kCells);
  succeed("merge s3 s1 s2 --out out");
  expect_same("whole", "out");
  EXPECT_TRUE(exists("out/index.html"));
  // What was merged counts as finished.
  EXPECT_THAT(run("run e.toml --out out").err, HasSubstr(std::to_string(kCells) + " of them finished before"));
}

TEST_F(Sweep, ShardsOfTwoKindsOfMachine_AreMerged_AndOneWarningSaysSo) {
  const std::string few = "run e.toml --scene cubes --map-size 32 --filters none,pcf2x2,tent3x3,vsm ";
  for (const char* shard : {"1", "2"}) succeed(few + "--shard " + shard + "/2 --out s" + shard);
  for (const auto& entry : std::filesystem::directory_iterator(folder() / "s2" / "cells")) {
    json cell = json::parse(read_text(entry.path()));
    cell["cell"]["machine"]["renderer"] = "Another rasteriser";
    write("s2/cells/" + entry.path().filename().string(), cell.dump());
  }
  succeed("merge s1 s2 --out out");
  const json merged = read_results();
  ASSERT_EQ(merged["warnings"].size(), 1u);
  EXPECT_THAT(merged["warnings"][0].get<std::string>(), StartsWith("Several kinds of machine measured"));
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(merged["cells"][i]["machine"]["renderer"] == "Another rasteriser", i % 2 == 1) << i;
  expect_refusal("advise out --cheapest time", 1, {"several kinds of machine measured the run"});
  succeed("advise out --cheapest bytes");
}

TEST_F(Sweep, ShardsThatDoNotFit_AreRefused) {
  const std::string few =
      "run e.toml --scene cubes --map-size 32 --filters none,vsm:radius=1,vsm:radius=2,pcf2x2,tent3x3 ";
  for (const char* shard : {"1", "2"}) succeed(few + "--shard " + shard + "/2 --out s" + shard);
  succeed(few + "--shard 1/3 --out other");
  succeed(few + "--seed 5 --shard 2/2 --out seed");
  expect_refusals({{"merge s1 s1 --out out", 2, {"both shard 1/2"}},
                   {"merge s1 --out out", 2, {"shard 2/2 is missing", "--shard 2/2"}},
                   {"merge s1 other --out out", 3, {"other", "no shard of the experiment"}},
                   {"merge s1 seed --out out", 3, {"no shard of the experiment"}},
                   {"merge s1 none --out out", 3, {"none/results.json"}}});
  json cut = read_results("s2");
  cut["cells"].erase(0);
  write("s2/results.json", cut.dump());
  expect_refusal("merge s1 s2 --out out", 3, {"s2", "holds 1 cells", "has 2"});
  write("s2/results.json", "{\"cells\": [");
  expect_refusal("merge s1 s2 --out out", 3, {"s2/results.json", "cut off"});
  EXPECT_FALSE(exists("out"));
}

TEST_F(Sweep, BadExperimentsAndShards_AreRefused) {
  expect_refusal("run quik --out out", 2, {"did you mean 'quick'"});
  write("bad.toml", "\nborder = 'mirror'\n");
  expect_refusal("run bad.toml --out out", 3, {"bad.toml:2", "--border", "mirror"});
  write("bad.toml", "scene = 'cubes'\nmap_size = 'many'\n");
  expect_refusals({{"run bad.toml --out out", 2, {"--map-size", "many"}},
                   {"run e.toml --view top --out out", 2, {"no scene has a view 'top'", "main"}},
                   {"run e.toml --size 64x36,64x36 --out out", 2, {"--size", "twice"}},
                   {"run e.toml --shard 3 --out out", 2, {"--shard", "I/N"}},
                   {"run e.toml --shard 0/3 --out out", 2, {"--shard", "'0'"}},
                   {"run e.toml --shard 4/3 --out out", 2, {"--shard", "1 .. 3"}},
                   {"run e.toml --shard 999/999 --out out", 2, {"--shard 999/999 is empty", std::to_string(kCells)}},
                   {"run e.toml --grids --shard 1/3 --out out", 2, {"--shard", "--no-grids"}}});
}

/// What would take hours is counted and asked about, before anything is written.
TEST_F(Sweep, TooManyCells_AskForYes) {
  write("huge.toml",
        "scene = 'cubes'\nsize = '16x9'\nmap_size = 16\nrounds = 1\ngrids = false\ntruth = false\n[[filter]]\nid = "
        "'esm'\n"
        "c = {linear = [1, 2000], count = 2001}\n");
  expect_refusal("run huge.toml --out out", 2, {"2001 cells", "--yes"});
  expect_refusal("run e.toml --rounds auto --budget 100 --out out", 2, {"48 cells", "--yes", "--budget"});
  EXPECT_FALSE(exists("out"));
  succeed("run e.toml --rounds auto --budget 100 --precision 1 --yes --out out");
}

// `shadowbench bias`, `stress`, `tune` and `run --tuned`, as a user calls them.

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
  EXPECT_THAT(page, HasSubstr("vsm, which reads a prefiltered map"));
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
  EXPECT_THAT(page, HasSubstr("none, which would read an empty map"));
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
                   {"stress --out out --range esm-exponent=10,10", 2, {"--range", "empty"}},
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

}  // namespace
}  // namespace shadowbench::test
