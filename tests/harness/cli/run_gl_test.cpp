#include <cstdio>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

// `shadowbench run` and `list`, as a user calls them.

class Command : public ProgramTest {
 protected:
  Outcome draw(const std::string& rest) const { return succeed(small(rest)); }
  std::string read_picture(const std::string& out, const std::string& name) const {
    return read(out + "/images/" + name + ".visibility.png");
  }
  bool has_image(const json& cell, const char* image) const {
    return exists("out/" + cell["images"][image].get<std::string>());
  }
};

TEST_F(Command, ByDefault_AllScenesAndEightFilters_WriteAValidReport) {
  const Outcome outcome = run_as_it_stands("run --gpu none --out out --size 128x72 --map-size 128 --rounds 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(read_cells().size(), 40u);
  for (const auto& cell : read_cells()) EXPECT_EQ(cell["nan"], 0);
  for (const std::string scene : {"cubes", "stack", "fence", "ball", "steps"})
    for (const char* file : {".grid.png", ".exr"}) EXPECT_TRUE(exists("out/" + scene + file)) << scene << file;
  for (const char* file : {"timings.csv", "summary.md", "index.html", "results.schema.json"})
    EXPECT_TRUE(exists(std::string("out/") + file)) << file;
  expect_valid();
}

TEST_F(Command, UserFilter_GetsCellAndPictures_ButNoAttribution) {
  draw("--size 128x72 --filters none,nine_compares:weight=0.5 --filter-file " + user_filter("nine_compares.glsl"));
  ASSERT_EQ(read_cells().size(), 2u);
  const json cell = read_cells()[1];
  EXPECT_EQ(cell["filter"], "nine_compares");
  EXPECT_EQ(cell["status"], "ok");
  EXPECT_EQ(cell["params"]["weight"], 0.5);
  EXPECT_EQ(cell["cost"]["fetches"], 9.0);
  EXPECT_EQ(read_results()["filter_files"]["nine_compares"], user_filter("nine_compares.glsl"));
  for (const char* field : {"kernel.sigma_texels", "attribution"})
    EXPECT_EQ(cell["absent"][field], "the filter declares no kernel, and has no scalar model that knows it");
  EXPECT_TRUE(cell["attribution"]["model"]["share"].is_null());
  EXPECT_FALSE(cell["artefact"]["acne"].is_null());
  EXPECT_FALSE(cell["error"]["rmse"].is_null());
  EXPECT_TRUE(has_image(cell, "picture"));
}

/// A user's copy of a built-in filter: same map, same pixels, same model.
TEST_F(Command, UserFilter_SeesTheSameMapAsTheOthers_AtEverySize) {
  copy_filter("pcf2x2", "copied");
  draw("--grids --map-size 32,64 --filters pcf2x2,vsm,copied --filter-file copied.glsl");
  for (const std::string stem : {"cubes.map32", "cubes.map64"}) {
    EXPECT_FALSE(read_picture("out", stem + ".copied").empty());
    EXPECT_EQ(read_picture("out", stem + ".copied"), read_picture("out", stem + ".pcf2x2")) << stem;
    EXPECT_TRUE(exists("out/" + stem + ".grid.png"));
  }
  const json cells = read_cells();
  for (const char* group : {"error", "attribution", "artefact", "kernel", "excused", "cost", "status"})
    EXPECT_EQ(cells[2][group], cells[0][group]) << group;
}

/// Said where it can do harm: the step is of the depths that are drawn, and reversed floats have none to speak of.
TEST_F(Command, PerspectiveDepthCoarserThanTheBias_IsWarnedOf) {
  const auto warnings = [&](const std::string& more) {
    draw("--no-truth --filters none " + more);
    return read_results()["warnings"].dump();
  };
  EXPECT_THAT(warnings("--perspective-depth 1e5"),
              AllOf(HasSubstr("d32f perspective 100000"), HasSubstr("--reversed-depth")));
  EXPECT_EQ(warnings("--perspective-depth 1e5 --reversed-depth"), "[]");
  EXPECT_EQ(warnings(""), "[]");
}

/// The settings reach the worker: a copy of a built-in filter sees the same map, and its cell the same key's settings.
TEST_F(Command, MapAndLightSettings_AreRecordedAndReachUserFilters) {
  copy_filter("pcf2x2", "copied");
  const std::string common = "--grids --size 96x54 --no-truth --filters none,pcf2x2,copied --filter-file copied.glsl ";
  draw(common + "--out plain");
  const json cells = measure(
      common + "--map-format d16 --perspective-depth 30.5 --reversed-depth --fit view --snap on --light 60,30.5");
  for (const auto& cell : cells) {
    EXPECT_EQ(cell["map_format"], "d16 perspective 30.5 reversed");
    EXPECT_EQ(cell["fit"], "view snapped");
    EXPECT_EQ(cell["light"], "60,30.5");
    EXPECT_EQ(cell["cost"]["map_bytes"], 64 * 64 * 2);
    EXPECT_GT(cell["coverage"]["texels_per_pixel"], 0.0);
    EXPECT_LT(cell["coverage"]["fewest_texels_per_pixel"], cell["coverage"]["texels_per_pixel"]);
    EXPECT_GT(cell["coverage"]["map_used"], 0.05);
    EXPECT_LE(cell["coverage"]["map_filled"], 1.0);
    for (const char* image : {"depth_map", "texel_density"}) {
      EXPECT_TRUE(has_image(cell, image)) << image;
      EXPECT_THAT(read("out/index.html"), HasSubstr(cell["images"][image].get<std::string>()));
    }
  }
  EXPECT_EQ(read_picture("out", "cubes.copied"), read_picture("out", "cubes.pcf2x2"));
  EXPECT_NE(read_picture("out", "cubes.pcf2x2"), read_picture("plain", "cubes.pcf2x2"));
  expect_valid();
}

TEST_F(Command, FilterWhoseLoopTheGlEnds_IsSuspect) {
  const json cells = measure("--size 160x90 --filters none,many_turns --filter-file " + user_filter("many_turns.glsl"));
  EXPECT_EQ(cells[0]["status"], "ok");
  const bool are_ended = does_gl_end_loops();
  EXPECT_EQ(cells[1]["status"], are_ended ? "suspect" : "ok");
  EXPECT_THAT(cells[1]["message"].get<std::string>(), HasSubstr(are_ended ? "this GL ends it without a word" : ""));
}

TEST_F(Command, ASecondRun_TakesItsTruthFromTheCache) {
  const auto work = [&](const std::string& more) {
    draw("--fresh --filters none,pcf2x2" + more);
    return read_results()["work"];
  };
  const json first = work(""), cells = read_cells(), second = work("");
  EXPECT_EQ(first["truths_traced"], 3) << "the view, its surroundings, a kernel; the other is a point";
  EXPECT_EQ(first["truths_cached"], 0);
  EXPECT_EQ(second["truths_traced"], 0);
  EXPECT_EQ(second["truths_cached"], 3);
  for (std::size_t i = 0; i < 2; ++i)
    for (const char* group : {"error", "attribution"}) EXPECT_EQ(cells[i][group], read_cells()[i][group]);
  EXPECT_EQ(work(" --no-cache")["truths_traced"], 3);
}

TEST_F(Command, FrontCull_NamesTheOpenMeshes) {
  draw("--filters none --bias front-cull");
  EXPECT_THAT(read_results()["warnings"].get<std::vector<std::string>>(), ElementsAre(HasSubstr("'floor' is open")));
}

TEST_F(Command, BiasAmounts_AreStatedInAllUnits) {
  const json cell = measure("--filters none --bias constant:texels=2")[0], work = read_results()["work"];
  EXPECT_GT(work["attribution_s"], 0.0);
  EXPECT_LT(work["attribution_s"], work["elapsed_s"]);
  EXPECT_EQ(cell["bias"]["constant_texels"], 2.0);
  EXPECT_GT(cell["map_scale"]["texel_m"], 0.01);
  EXPECT_GT(cell["map_scale"]["depth_range_m"], 1.0);
  EXPECT_THAT(read("out/details.md"), HasSubstr("2 texels (depth 0.0"));
}

TEST_F(Command, WhatWasNotAskedFor_IsAbsent_WithItsOption) {
  const json cell = measure("--filters vsm --no-truth")[0];
  EXPECT_TRUE(cell["error"]["rmse"].is_null());
  EXPECT_EQ(cell["absent"]["error"], "the run was made with --no-truth");
  EXPECT_TRUE(cell["stability"]["overflow_texels"].is_null());
  EXPECT_EQ(cell["absent"]["stability"], "the run was made without --stability");
}

/// A user's file that says what its map holds gets what a built-in filter gets, but for what needs a model.
TEST_F(Command, Stability_IsCountedDrawnAndLinked) {
  write("changed.glsl", read_source("filters/vsm.glsl") + "const float unused = 0.0;\n");
  const json cells = measure(
      "--stability --size 96x54 --no-truth --width own --filters "
      "none,vsm:bleed_reduction=0,esm:c=20,store=r16f,changed:bleed_reduction=0 --filter-file changed.glsl");
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_TRUE(cells[0]["stability"]["overflow_texels"].is_null());
  EXPECT_EQ(cells[0]["absent"]["stability.overflow_texels"], "the filter reads the depth map itself");
  EXPECT_TRUE(cells[0]["images"]["stability"].is_null());
  const json &vsm = cells[1]["stability"], &esm = cells[2]["stability"], &user = cells[3]["stability"];
  EXPECT_EQ(vsm["overflow_texels"], 0);
  EXPECT_GE(vsm["negative_variance_texels"], 0);
  EXPECT_GT(vsm["half_difference_max"], 0.0);
  EXPECT_EQ(vsm["bound_violations"], 0);
  EXPECT_GT(vsm["headroom"], 88.0);
  EXPECT_GT(esm["overflow_texels"], 0);
  EXPECT_TRUE(esm["headroom"].is_null());
  EXPECT_NEAR(esm["safe_exponent"].get<double>(), 11.09, 0.02);
  EXPECT_TRUE(esm["lowest_variance"].is_null());
  for (const char* field : {"overflow_texels", "negative_variance_texels", "lowest_variance", "headroom",
                            "half_difference_max", "half_difference_rms"})
    EXPECT_EQ(user[field], vsm[field]) << field;
  EXPECT_EQ(cells[3]["absent"]["stability.bound_violations"], "the filter has no scalar model");
  for (const std::size_t i : {1, 2, 3}) {
    EXPECT_TRUE(has_image(cells[i], "stability")) << i;
    EXPECT_THAT(read("out/index.html"), HasSubstr(cells[i]["images"]["stability"].get<std::string>()));
  }
  EXPECT_THAT(read("out/index.html"), HasSubstr("an exponent of 11.0"));
  EXPECT_THAT(read_results()["warnings"].dump(),
              AllOf(HasSubstr("choose c <= 11.0"), HasSubstr("store=r32f or combine=log")));
}

TEST_F(Command, MapOfOneTexel_Works) {
  EXPECT_THAT(draw("--map-size 1").err, HasSubstr("a map of 1 texels a side has no room for the"));
  for (const json& cell : read_cells()) EXPECT_EQ(cell["nan"], 0);
}

TEST_F(Command, ListFilters_ShowsWhatTheFrontMatterSays) {
  const Outcome outcome = succeed("list filters");
  for (const char* word :
       {"min_variance", "1e-05", "depth^2", "Donnelly", "per-pixel", "medium 0.65 texels, up to 1.00"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
  const json document = json::parse(run("list filters --json").out);
  EXPECT_GE(document.size(), 21u);
  for (const json& filter : document) {
    const bool has_kernel = filter["claims"].empty();  // where contacts harden, it differs from pixel to pixel
    EXPECT_EQ(filter["kernel"]["sigma_texels"].is_number(), has_kernel);
    EXPECT_EQ(filter["kernel"]["class"].is_string(), has_kernel) << filter["id"];
    EXPECT_EQ(filter["teaching"], filter["id"] == "box3x3" || filter["id"].get<std::string>().starts_with("teach"));
  }
}

TEST_F(Command, ListScenes_NamesTeachingScenesApart) {
  const std::string out = run("list scenes").out;
  const std::size_t heading = out.find("For teaching");
  ASSERT_NE(heading, std::string::npos);
  const std::set<std::string> usual = {"ball", "cubes", "fence", "stack", "steps"};
  std::size_t found = 0;
  for (const auto& scene : json::parse(run("list scenes --json").out)) {
    const auto name = scene["name"].get<std::string>();
    EXPECT_EQ(scene["teaching"], !usual.contains(name)) << name;
    EXPECT_EQ(out.find("\n" + name + " ") < heading || out.starts_with(name), usual.contains(name)) << name;
    found += usual.count(name);
  }
  EXPECT_EQ(found, usual.size());
}

/// A user's copy of a built-in filter, in its own process, shows the same artefact.
TEST_F(Command, BorderSettings_ReachCellsPicturesAndUsersFilters) {
  copy_filter("pcf2x2", "copied");
  std::set<std::string> keys, pictures;
  for (const std::string setting : {"", "--border repeat", "--border edge", "--far-test off"}) {
    const json cells = measure("--scene edge --filters pcf2x2,copied --filter-file copied.glsl " + setting);
    for (const auto& cell : cells) keys.insert(cell["key"].get<std::string>());
    EXPECT_EQ(cells[0]["receivers"], cells[1]["receivers"]);
    EXPECT_EQ(read_picture("out", "edge.pcf2x2"), read_picture("out", "edge.copied")) << setting;
    pictures.insert(read_picture("out", "edge.pcf2x2"));
    if (setting == "--border repeat")
      EXPECT_EQ(cells[0]["range"], json::parse(R"({"border": "repeat", "far_test": true, "behind_test": true})"));
  }
  EXPECT_EQ(keys.size(), 8u);
  EXPECT_EQ(pictures.size(), 4u);
}

TEST_F(Command, BlendCasters_AreHeldAgainstTheirTransmittance) {
  std::set<std::string> keys;
  std::map<std::string, double> rmse;
  for (const std::string name : {"opaque", "hashed", "dither"}) {
    const Outcome outcome =
        draw("--size 160x90 --map-size 512 --scene panes --filters tent7x7 --blend-casters " + name);
    const json cell = read_cells()[0];
    keys.insert(cell["key"].get<std::string>());
    rmse[name] = cell["error"]["rmse"];
    EXPECT_EQ(cell["map_format"], name == "opaque" ? "d32f" : "d32f " + name);
    EXPECT_EQ(outcome.err.find("'pane', which blends") != std::string::npos, name == "opaque") << outcome.err;
  }
  EXPECT_EQ(keys.size(), 3u);
  EXPECT_LT(rmse["hashed"], 0.5 * rmse["opaque"]);
  EXPECT_LT(rmse["dither"], 0.5 * rmse["opaque"]);
}

TEST_F(Command, BehindTestOff_SaysThatItChangesNothing_ButUnderSpots) {
  measure("--scene three_lights --filters none --behind-test off");
  std::vector<std::string> scenes;
  for (const auto& warning : read_results()["warnings"].get<std::vector<std::string>>())
    if (warning.find("--behind-test off changes nothing") != std::string::npos)
      scenes.push_back(warning.substr(0, warning.find(':')));
  EXPECT_THAT(scenes, ElementsAre("three_lights.sun", "three_lights.bulb"));
}

TEST_F(Command, BorderPage_IsDrawnWhereAskedFor_AndLeavesTheNextViewAsItWas) {
  std::string text = read_source("data/scenes/teaching/edge.toml");
  text.replace(text.find("[camera]"), 8, "[[camera]]");
  write("views.toml", text + "[[camera]]\nname = \"second\"\nposition = [0, 12, 0.1]\ntarget = [0, 0, 0]\n");
  const std::string arguments = "--grids --scene views.toml --filters none,vsm --border repeat ";
  measure(arguments);
  const std::string without = read_picture("out", "views.second.none");
  EXPECT_FALSE(exists("out/views.main.borders.png"));
  measure(arguments + "--border-page");
  EXPECT_TRUE(exists("out/views.main.borders.png"));
  EXPECT_FALSE(without.empty());
  EXPECT_EQ(read_picture("out", "views.second.none"), without);
}

TEST_F(Command, BorderPage_OfAReversedMap_IsTheSame) {
  const std::string arguments =
      " --grids --size 160x90 --map-size 128 --scene edge --filters none --no-truth --border-page";
  draw("--out usual" + arguments);
  draw("--out reversed --reversed-depth" + arguments);
  const Outcome outcome = succeed("diff usual/edge.borders.png reversed/edge.borders.png --metric rmse --json");
  EXPECT_LT(json::parse(outcome.out)["rmse"], 0.01);
}

// What a run says of how far it is.

/// One line: "16/40 · 35 s, 20 s left · cubes · 64 · times".
struct Line {
  int done = 0;
  std::string text;
};

class ProgressOfARun : public ProgramTest {
 protected:
  std::vector<Line> draw(const std::string& options) const {
    std::vector<Line> lines;
    std::istringstream text(succeed(small("--every-step --gl software " + options)).err);
    for (std::string line; std::getline(text, line);)
      if (int done = 0, all = 0, end = 0;
          std::sscanf(line.c_str(), "%d/%d · %*d %n", &done, &all, &end) == 2 && end > 0)
        lines.push_back({done, line});
    return lines;
  }
};

TEST_F(ProgressOfARun, NamesEveryStep_AndCountsCells) {
  for (const char* options : {"--fresh --filters none,vsm", "--fresh --filters none,vsm --no-truth"}) {
    const std::vector<Line> lines = draw(options);
    ASSERT_FALSE(lines.empty());
    EXPECT_EQ(lines.front().done, 0);
    EXPECT_THAT(lines.back().text, AllOf(StartsWith("2/2 · "), EndsWith(" · done")));
    EXPECT_TRUE(std::ranges::is_sorted(lines, {}, &Line::done));
    for (const char* step : {"· none", "· vsm", "times", "phases", "pictures", "writing the report"}) {
      const auto is_of_step = [&](const Line& line) { return line.text.find(step) != std::string::npos; };
      EXPECT_TRUE(std::ranges::any_of(lines, is_of_step)) << step;
    }
    const auto names_truth = [](const Line& line) { return line.text.find("truth") != std::string::npos; };
    EXPECT_EQ(std::ranges::any_of(lines, names_truth), std::string(options).find("--no-truth") == std::string::npos);
  }
}

TEST_F(ProgressOfARun, StartsAnewWithWhatIsLeft) {
  draw("--filters none --pad-texels 4");
  EXPECT_EQ(draw("--filters none,vsm --pad-texels 4").front().done, 1);
}

TEST_F(ProgressOfARun, SaysHowLongItTookAndTheRest) {
  const std::vector<Line> lines =
      draw("--scene cubes --scene stack --filters none,vsm --no-truth --rounds 150 --size 960x540");
  const auto second = std::ranges::find(lines, 2, &Line::done);
  ASSERT_NE(second, lines.end());
  int taken_s = 0, left_s = 0;
  ASSERT_EQ(std::sscanf(second->text.c_str(), "2/4 · %d s, %d s left · stack", &taken_s, &left_s), 2) << second->text;
  EXPECT_EQ(left_s, taken_s) << "one half is done";
}

/// Standard output and standard error of a run are what a build server's log shows.
TEST_F(ProgressOfARun, InALog_TakesTwelveLinesAtMost_AndTheSummaryStandsThereOnce) {
  const Outcome outcome = succeed(small("--gl software --scene cubes --scene stack --map-size 64,128 --no-truth"));
  const std::string log = outcome.err + outcome.out;
  EXPECT_LE(std::ranges::count(log, '\n'), 12) << log;
  EXPECT_THAT(outcome.err, HasSubstr("32 cells\n"));
  EXPECT_GE(log.find("16/32 · "), log.find("32 cells\n")) << "it says how far it is meanwhile";
  EXPECT_NE(log.find("16/32 · "), log.npos);
  EXPECT_THAT(outcome.err, ContainsRegex("32/32 · [0-9]+ s · done\n$"));
  EXPECT_EQ(outcome.err.find(" done\n"), outcome.err.rfind(" done\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("^The cheapest is [^\n]+; its error was not measured[.]\n"));
  EXPECT_THAT(outcome.out, HasSubstr("report: out/index.html\n"));
}

TEST_F(ProgressOfARun, OfFiltersForTeaching_EndsWithoutAnAnswer) {
  EXPECT_THAT(succeed(small("--gl software --filters teach4x4")).out, StartsWith("report: out/index.html\n"));
}

TEST_F(ProgressOfARun, InALog_WarningsStay_HoweverManyThereAre) {
  std::string scenes;
  for (int i = 0; i < 12; ++i)
    scenes +=
        " --scene " + write("below" + std::to_string(i) + ".toml", read_source("data/scenes/cubes.toml")).string();
  const Outcome outcome =
      succeed(small("--gl software --filters none --size 32x18 --map-size 32 --no-truth --light 0,-20" + scenes));
  for (int i = 0; i < 12; ++i) EXPECT_THAT(outcome.err, HasSubstr("warning: below" + std::to_string(i) + ": "));
  EXPECT_THAT(outcome.err, ContainsRegex("12/12 · [0-9]+ s · done"));
}

}  // namespace
}  // namespace shadowbench::test
