// Experiments of many cells: overridden, interrupted, continued, sharded and merged, as a user does it.

#include <map>

#include "tests/harness/cli/faults.h"

namespace shadowbench::test {
namespace {

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
  EXPECT_THAT(outcome.err, HasSubstr(std::to_string(kCells) + " cells; "));
  EXPECT_THAT(outcome.err, HasSubstr("of timing, the rest ray tracing and images"));
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

TEST_F(Sweep, ClaimsOfAUsersFilter_AreInItsCells_AndNoAdviceWhereNothingShowsThem) {
  write("mine.glsl",
        "/*+++\ntitle = \"M\"\nsource = \"s\"\nkind = \"other\"\nclaims = [\"own-claim\"]\nradius_texels = 0\n+++*/\n"
        "float visibility(Receiver r) { return compare_nearest(r, vec2(0.0), r.depth); }\n");
  succeed(
      "run --scene cubes --map-size 32 --size 32x18 --rounds 1 --no-attribution --filters none,mine --filter-file "
      "mine.glsl --out out");
  EXPECT_EQ(read_cells()[0]["claims"], json::array());
  EXPECT_EQ(read_cells()[1]["claims"], json::array({"own-claim"}));
  const Outcome advice = run("advise out --requires own-claim");
  EXPECT_EQ(advice.exit_code, 1) << advice.out;
  EXPECT_THAT(advice.out, HasSubstr("'own-claim' is claimed, not shown: nothing is measured of it"));
  // So small a picture has too few pixels for rates.
  EXPECT_THAT(read_cells()[0]["absent"]["artefact.leak"].get<std::string>(), StartsWith("fewer than 100 receivers"));
  EXPECT_THAT(read_cells()[0]["nothing_to_see"], ::testing::Contains("artefact.leak"));
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
  const Outcome by_time = run("advise out --cheapest time");
  EXPECT_EQ(by_time.exit_code, 1);
  EXPECT_THAT(by_time.err, HasSubstr("several kinds of machine measured the run"));
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
  expect_refusal("run none.toml --out out", 3, {"none.toml"});
  write("bad.toml", "map_sise = 3\n");
  expect_refusal("run bad.toml --out out", 3, {"bad.toml:1", "did you mean 'map_size'"});
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
  expect_refusal("run e.toml --rounds auto --budget 100 --out out", 2, {"48 cells", "1 h 20 min", "--yes"});
  // So large a picture takes more than an hour on any machine that draws with its processor.
  expect_refusal("run e.toml --rounds 10000 --size 3840x2160 --out out", 2,
                 {"48 cells", "of timing", "--yes", "fewer --rounds"});
  EXPECT_FALSE(exists("out"));
  succeed("run e.toml --rounds auto --budget 100 --precision 1 --yes --out out");
}

}  // namespace
}  // namespace shadowbench::test
