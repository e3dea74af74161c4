// `shadowbench run` and `list`, as a user calls them.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using Command = ProgramTest;

nlohmann::json results(const std::filesystem::path& folder) {
  return nlohmann::json::parse(read_text(folder / "out" / "results.json"));
}

TEST_F(Command, ByDefault_AllScenesAndEightFilters_WriteAValidReport) {
  const Outcome outcome = run_as_it_stands("run --gpu none --out out --size 128x72 --map-size 128 --rounds 2");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json document = results(folder());
  EXPECT_EQ(document["cells"].size(), 40u);
  for (const auto& cell : document["cells"]) EXPECT_EQ(cell["nan"], 0);
  for (const char* scene : {"cubes", "stack", "fence", "ball", "steps"}) {
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / (std::string(scene) + ".grid.png")));
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / (std::string(scene) + ".exr")));
  }
  for (const char* file : {"timings.csv", "summary.md", "index.html", "results.schema.json"})
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / file)) << file;
  const std::string check = "/usr/bin/python3 -m jsonschema -i '" + (folder() / "out" / "results.json").string() +
                            "' '" + (folder() / "out" / "results.schema.json").string() + "'";
  EXPECT_EQ(std::system(check.c_str()), 0);
}

TEST_F(Command, UserFilter_GetsCellAndPictures) {
  const Outcome outcome =
      run("run --out out --size 64x36 --map-size 64 --rounds 2 --scene cubes --filters none,nine_compares:weight=0.5 "
          "--filter-file " +
          user_filter("nine_compares.glsl"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json document = results(folder());
  ASSERT_EQ(document["cells"].size(), 2u);
  const nlohmann::json& cell = document["cells"][1];
  EXPECT_EQ(cell["filter"], "nine_compares");
  EXPECT_EQ(cell["status"], "ok");
  EXPECT_EQ(cell["params"]["weight"], 0.5);
  EXPECT_EQ(cell["cost"]["fetches"], 9.0);
  EXPECT_EQ(document["filter_files"]["nine_compares"],
            std::string(SHADOWBENCH_SOURCE_DIR) + "/tests/user_filters/nine_compares.glsl");
  EXPECT_TRUE(cell["kernel"]["sigma_texels"].is_null());
  EXPECT_EQ(cell["absent"]["kernel.sigma_texels"],
            "the filter declares no kernel, and has no scalar model that knows it");
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / cell["images"]["picture"].get<std::string>()));
  for (const auto& entry : std::filesystem::directory_iterator(folder() / "out"))
    EXPECT_NE(entry.path().filename().string().rfind(".worker", 0), 0u) << entry.path();
}

TEST_F(Command, UserFilter_SeesTheSameMapAsTheOthers_AtEverySize) {
  // A user's copy of a built-in filter: same map, same pixels.
  write("copied.glsl", read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/filters/pcf2x2.glsl"));
  const Outcome outcome = run(
      "run --out out --size 64x36 --map-size 32,64 --rounds 1 --scene cubes --filters pcf2x2,vsm,copied --filter-file "
      "copied.glsl");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* stem : {"cubes.map32", "cubes.map64"}) {
    const std::string base = (folder() / "out" / "images" / stem).string();
    const std::string picture = read_text(base + ".copied.visibility.png");
    EXPECT_FALSE(picture.empty());
    EXPECT_EQ(picture, read_text(base + ".pcf2x2.visibility.png")) << stem;
  }
}

/// Said where it can do harm: the step is of the depths that are drawn, and reversed floats have none to speak of.
TEST_F(Command, PerspectiveDepthCoarserThanTheBias_IsWarnedOf) {
  const std::string common =
      "run --size 96x54 --map-size 64 --rounds 1 --scene cubes --no-truth --filters none --out out ";
  const auto warnings = [&](const std::string& more) {
    EXPECT_EQ(run(common + more).exit_code, 0);
    return results(folder())["warnings"].dump();
  };
  const std::string coarse = warnings("--perspective-depth 1e5");
  for (const char* part : {"d32f perspective 100000", "holds depth in steps", "--reversed-depth"})
    EXPECT_NE(coarse.find(part), std::string::npos) << coarse;
  EXPECT_EQ(warnings("--perspective-depth 1e5 --reversed-depth"), "[]");
  EXPECT_EQ(warnings(""), "[]");
}

/// The settings reach the worker: a copy of a built-in filter sees the same map, and its cell the same key's settings.
TEST_F(Command, MapAndLightSettings_AreRecordedAndReachUserFilters) {
  write("copied.glsl", read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/filters/pcf2x2.glsl"));
  const std::string common =
      "run --grids --size 96x54 --map-size 64 --rounds 1 --scene cubes --no-truth --filters none,pcf2x2,copied "
      "--filter-file copied.glsl ";
  ASSERT_EQ(run(common + "--out plain").exit_code, 0);
  const Outcome outcome =
      run(common +
          "--out out --map-format d16 --perspective-depth 30.5 --reversed-depth --fit view --snap on --light 60,30.5");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json document = results(folder());
  for (const auto& cell : document["cells"]) {
    EXPECT_EQ(cell["map_format"], "d16 perspective 30.5 reversed");
    EXPECT_EQ(cell["fit"], "view snapped");
    EXPECT_EQ(cell["light"], "60,30.5");
    EXPECT_EQ(cell["cost"]["map_bytes"], 64 * 64 * 2);
    EXPECT_GT(cell["coverage"]["texels_per_pixel"], 0.0);
    EXPECT_LT(cell["coverage"]["fewest_texels_per_pixel"], cell["coverage"]["texels_per_pixel"]);
    EXPECT_GT(cell["coverage"]["map_used"], 0.05);
    EXPECT_LE(cell["coverage"]["map_filled"], 1.0);
    for (const char* image : {"depth_map", "texel_density", "texel_grid"}) {
      EXPECT_TRUE(std::filesystem::exists(folder() / "out" / cell["images"][image].get<std::string>())) << image;
      EXPECT_NE(read_text(folder() / "out" / "index.html").find(cell["images"][image].get<std::string>()),
                std::string::npos)
          << image;
    }
  }
  const auto picture = [&](const char* out, const char* filter) {
    return read_text(folder() / out / "images" / (std::string("cubes.") + filter + ".visibility.png"));
  };
  EXPECT_EQ(picture("out", "copied"), picture("out", "pcf2x2"));
  EXPECT_NE(picture("out", "pcf2x2"), picture("plain", "pcf2x2"));
  const std::string check = "/usr/bin/python3 -m jsonschema -i '" + (folder() / "out" / "results.json").string() +
                            "' '" + (folder() / "out" / "results.schema.json").string() + "'";
  EXPECT_EQ(std::system(check.c_str()), 0);
}

TEST_F(Command, EndlessUserFilter_TimesOutAndTheRunGoesOn) {
  const Outcome outcome =
      run("run --grids --out out --size 320x180 --map-size 64 --rounds 2 --scene cubes --filters none,endless "
          "--cell-timeout 3 --filter-file " +
          user_filter("endless.glsl"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json document = results(folder());
  ASSERT_EQ(document["cells"].size(), 2u);
  EXPECT_EQ(document["cells"][0]["status"], "ok");
  EXPECT_EQ(document["cells"][1]["filter"], "endless");
  EXPECT_EQ(document["cells"][1]["status"], "timeout");
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "cubes.grid.png"));
}

TEST_F(Command, FilterWhoseLoopTheGlEnds_IsSuspect) {
  run("run --out out --size 160x90 --map-size 64 --rounds 1 --scene cubes --filters none,many_turns --filter-file " +
      user_filter("many_turns.glsl"));
  const nlohmann::json document = results(folder());
  EXPECT_EQ(document["cells"][0]["status"], "ok");
  // The llvmpipe of Mesa 22 ends loops, that of Mesa 25 does not.
  const bool are_ended = run("list gl --measure").out.find("ended by the GL after") != std::string::npos;
  EXPECT_EQ(document["cells"][1]["status"], are_ended ? "suspect" : "ok");
  EXPECT_THAT(document["cells"][1]["message"].get<std::string>(),
              testing::HasSubstr(are_ended ? "this GL ends it without a word" : ""));
}

TEST_F(Command, WhatAKilledRunLeft_IsRemovedByTheNext) {
  std::filesystem::create_directories(folder() / "out" / ".worker-99999999" / "cells");
  ASSERT_EQ(run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene cubes --filters none").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder() / "out" / ".worker-99999999"));
}

TEST_F(Command, SameSeed_SamePictures) {
  ASSERT_EQ(run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene ball --filters poisson").exit_code, 0);
  const std::string first = read_text(folder() / "out" / "images" / "ball.poisson.visibility.png");
  ASSERT_EQ(run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene ball --filters poisson").exit_code, 0);
  EXPECT_EQ(read_text(folder() / "out" / "images" / "ball.poisson.visibility.png"), first);
  ASSERT_EQ(
      run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene ball --filters poisson --seed 2").exit_code, 0);
  EXPECT_NE(read_text(folder() / "out" / "images" / "ball.poisson.visibility.png"), first);
}

TEST_F(Command, SeveralMapSizes_DoNotShareFiles) {
  ASSERT_EQ(
      run("run --grids --out out --size 64x36 --map-size 64,128 --rounds 1 --scene cubes --filters none").exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "cubes.map64.grid.png"));
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "cubes.map64.details.png"));
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "cubes.map128.grid.png"));
  EXPECT_EQ(results(folder())["cells"].size(), 2u);
}

TEST_F(Command, EveryCell_IsScoredAgainstTheTruth) {
  const Outcome outcome = run("run --out out --size 128x72 --rounds 1 --scene cubes --filters none,vsm:radius=20");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json document = results(folder());
  const nlohmann::json &none = document["cells"][0]["error"], &wide = document["cells"][1]["error"];
  EXPECT_GT(none["rmse"], 0.0);
  EXPECT_LT(none["rmse"], 0.1);
  EXPECT_GT(wide["rmse"], none["rmse"]) << "a blur of 41 texels is wider than the sun's penumbra";
  EXPECT_LE(document["cells"][0]["truth"]["se"], 0.005);
  EXPECT_LE(none["mae"], none["rmse"]);
  EXPECT_LE(none["rmse"], none["max"]);
  EXPECT_GT(none["flip"], 0.0);
  EXPECT_GT(wide["flip"], none["flip"]);
}

TEST_F(Command, ASecondRun_TakesItsTruthFromTheCache) {
  const std::string arguments =
      "run --out out --fresh --size 64x36 --map-size 64 --rounds 1 --scene cubes --filters none,pcf2x2";
  ASSERT_EQ(run(arguments).exit_code, 0);
  const nlohmann::json first = results(folder());
  EXPECT_EQ(first["work"]["truths_traced"], 3) << "the view, its surroundings, a kernel; the other is a point";
  EXPECT_EQ(first["work"]["truths_cached"], 0);
  ASSERT_EQ(run(arguments).exit_code, 0);
  const nlohmann::json second = results(folder());
  EXPECT_EQ(second["work"]["truths_traced"], 0);
  EXPECT_EQ(second["work"]["truths_cached"], 3);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(first["cells"][i]["error"], second["cells"][i]["error"]);
    EXPECT_EQ(first["cells"][i]["attribution"], second["cells"][i]["attribution"]);
  }
  ASSERT_EQ(run(arguments + " --no-cache").exit_code, 0);
  EXPECT_EQ(results(folder())["work"]["truths_traced"], 3);
}

TEST_F(Command, ACacheThatCannotBeWritten_IsWarnedOf_AndTheRunGoesOn) {
  write("taken", "a file");
  const Outcome outcome =
      run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene cubes --filters none --cache taken");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("--cache"), std::string::npos) << outcome.err;
  EXPECT_EQ(results(folder())["warnings"].size(), 1u);
}

TEST_F(Command, FrontCull_NamesTheOpenMeshes) {
  const Outcome outcome =
      run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene cubes --filters none --bias front-cull");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json warnings = results(folder())["warnings"];
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].get<std::string>().find("'floor' is open"), std::string::npos) << warnings[0];
}

TEST_F(Command, BiasAmounts_AreStatedInAllUnits) {
  ASSERT_EQ(
      run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene cubes --filters none --bias constant:texels=2")
          .exit_code,
      0);
  const nlohmann::json work = results(folder())["work"];
  EXPECT_GT(work["attribution_s"], 0.0);
  EXPECT_LT(work["attribution_s"], work["elapsed_s"]);
  const nlohmann::json cell = results(folder())["cells"][0];
  EXPECT_EQ(cell["bias"]["constant_texels"], 2.0);
  EXPECT_GT(cell["map_scale"]["texel_m"], 0.01);
  EXPECT_GT(cell["map_scale"]["depth_range_m"], 1.0);
  const std::string summary = read_text(folder() / "out" / "details.md");
  EXPECT_NE(summary.find("2 texels (depth 0.0"), std::string::npos) << summary;
}

TEST_F(Command, AUsersFilter_HasArtefactsButNoAttribution) {
  const Outcome outcome = run(
      "run --out out --size 128x72 --map-size 64 --rounds 1 --scene cubes --filters none,nine_compares --filter-file " +
      user_filter("nine_compares.glsl"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json cell = results(folder())["cells"][1];
  EXPECT_EQ(cell["filter"], "nine_compares");
  EXPECT_TRUE(cell["attribution"]["model"]["share"].is_null());
  EXPECT_EQ(cell["absent"]["attribution"], "the filter declares no kernel, and has no scalar model that knows it");
  EXPECT_FALSE(cell["artefact"]["acne"].is_null());
  EXPECT_FALSE(cell["error"]["rmse"].is_null());
}

TEST_F(Command, WithoutTruth_SaysSo) {
  ASSERT_EQ(
      run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene cubes --filters none --no-truth").exit_code, 0);
  const nlohmann::json document = results(folder());
  EXPECT_TRUE(document["cells"][0]["error"]["rmse"].is_null());
  EXPECT_EQ(document["cells"][0]["absent"]["error"], "the run was made with --no-truth");
}

TEST_F(Command, OverflowInTheMap_IsWarnedOf) {
  const Outcome outcome =
      run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene cubes --filters none,esm:c=2000");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* words :
       {"overflowed", "r32f holds numbers up to 3.40282e+38, which is e^88.72", "choose c <= 88.", "or combine=log"})
    EXPECT_NE(outcome.err.find(words), std::string::npos) << words << "\n" << outcome.err;
  // All of it is lit then, which makes the filter suspect too.
  EXPECT_EQ(results(folder())["warnings"].size(), 2u);
  EXPECT_EQ(results(folder())["cells"][1]["suspect_of"].size(), 1u);
}

TEST_F(Command, ExponentialVariance_In16Bits_OverflowsAtAnExponentOf10_AndIsCleanAt5) {
  const Outcome outcome =
      run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene steps --stability --no-attribution --filters "
          "none,teach_evsm:c=10,store=rg16f,teach_evsm:c=5.54,store=rg16f");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json cells = results(folder())["cells"];
  EXPECT_GT(cells[1]["stability"]["overflow_texels"], 1000);
  EXPECT_EQ(cells[2]["stability"]["overflow_texels"], 0);
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / cells[1]["images"]["stability"].get<std::string>()));
}

/// What the warning recommends, works; and it is of this very map.
TEST_F(Command, OverflowWarning_NamesWhatKeepsTheLimit) {
  const std::string common =
      "run --out out --size 64x36 --map-size 64 --rounds 1 --scene cubes --no-truth --filters none,esm:";
  const Outcome outcome = run(common + "c=20,store=r16f");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("choose c <= 11.0"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("store=r32f or combine=log"), std::string::npos) << outcome.err;
  for (const char* remedy : {"c=11.08,store=r16f", "c=20,store=r32f", "c=20,store=r16f,combine=log"}) {
    ASSERT_EQ(run(common + remedy).exit_code, 0);
    EXPECT_EQ(results(folder())["warnings"].size(), 0u) << remedy;
  }
}

TEST_F(Command, VarianceThatRoundingTakesBelowItsFloor_IsWarnedOf) {
  const std::string common =
      "run --out out --size 64x36 --map-size 256 --rounds 1 --scene cubes --no-truth --filters none,vsm:";
  const Outcome outcome = run(common + "store=rg16f");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* words : {"rounding in rg16f", "below 0", "choose min_variance >= 0.000", "store=rg32f"})
    EXPECT_NE(outcome.err.find(words), std::string::npos) << words << "\n" << outcome.err;
  ASSERT_EQ(run(common + "store=rg32f").exit_code, 0);
  EXPECT_EQ(results(folder())["warnings"].size(), 0u);
}

/// A user's file that says what its map holds gets what a built-in filter gets, but for what needs a model.
TEST_F(Command, Stability_IsCountedDrawnAndLinked) {
  const std::string vsm_text = read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/filters/vsm.glsl");
  write("changed.glsl", vsm_text + "const float unused = 0.0;\n");
  const Outcome outcome =
      run("run --stability --out out --size 96x54 --map-size 64 --rounds 1 --scene cubes --no-truth --filters "
          "none,vsm:bleed_reduction=0,esm:c=20,store=r16f,changed:bleed_reduction=0 --filter-file changed.glsl "
          "--width own");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json cells = results(folder())["cells"];
  ASSERT_EQ(cells.size(), 4u);
  const auto& none = cells[0]["stability"];
  EXPECT_TRUE(none["overflow_texels"].is_null());
  EXPECT_EQ(cells[0]["absent"]["stability.overflow_texels"], "the filter reads the depth map itself");
  EXPECT_TRUE(cells[0]["images"]["stability"].is_null());
  const auto& vsm = cells[1]["stability"];
  EXPECT_EQ(vsm["overflow_texels"], 0);
  EXPECT_GE(vsm["negative_variance_texels"], 0);
  EXPECT_GT(vsm["half_difference_max"], 0.0);
  EXPECT_EQ(vsm["bound_violations"], 0);
  EXPECT_GT(vsm["headroom"], 88.0);
  const auto& esm = cells[2]["stability"];
  EXPECT_GT(esm["overflow_texels"], 0);
  EXPECT_TRUE(esm["headroom"].is_null());
  EXPECT_NEAR(esm["safe_exponent"].get<double>(), 11.09, 0.02);
  EXPECT_TRUE(esm["lowest_variance"].is_null());
  const auto& user = cells[3]["stability"];
  for (const char* field : {"overflow_texels", "negative_variance_texels", "lowest_variance", "headroom",
                            "half_difference_max", "half_difference_rms"})
    EXPECT_EQ(user[field], vsm[field]) << field;
  EXPECT_EQ(cells[3]["absent"]["stability.bound_violations"], "the filter has no scalar model");
  const std::string page = read_text(folder() / "out" / "index.html"),
                    csv = read_text(folder() / "out" / "accuracy.csv");
  for (const int i : {1, 2, 3}) {
    const std::string image = cells[static_cast<std::size_t>(i)]["images"]["stability"];
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / image)) << image;
    EXPECT_NE(page.find(image), std::string::npos);
  }
  EXPECT_NE(page.find("an exponent of 11.0"), std::string::npos);
  EXPECT_NE(csv.find("negative_variance_texels"), std::string::npos);
}

TEST_F(Command, WithoutStability_SaysSo) {
  ASSERT_EQ(run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene cubes --filters vsm --no-truth").exit_code,
            0);
  const nlohmann::json cell = results(folder())["cells"][0];
  EXPECT_TRUE(cell["stability"]["overflow_texels"].is_null());
  EXPECT_EQ(cell["absent"]["stability"], "the run was made without --stability");
}

TEST_F(Command, MapOfOneTexel_Works) {
  const Outcome outcome = run("run --out out --size 64x36 --map-size 1 --rounds 1 --scene cubes");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json written = results(folder());
  for (const nlohmann::json& cell : written["cells"]) EXPECT_EQ(cell["nan"], 0);
  EXPECT_THAT(outcome.err, testing::HasSubstr("a map of 1 texels a side has no room for the"));
}

TEST_F(Command, ListFilters_ShowsWhatTheFrontMatterSays) {
  const Outcome outcome = run("list filters");
  EXPECT_EQ(outcome.exit_code, 0);
  for (const char* word : {"min_variance", "1e-05", "depth^2", "Donnelly", "per-pixel"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
  EXPECT_NE(outcome.out.find("medium 0.65 texels, up to 1.00"), std::string::npos);
  const nlohmann::json document = nlohmann::json::parse(run("list filters --json").out);
  EXPECT_GE(document.size(), 21u);
  for (const nlohmann::json& filter : document) {
    const bool has_kernel = filter["claims"].empty();  // where contacts harden, it differs from pixel to pixel
    EXPECT_EQ(filter["kernel"]["sigma_texels"].is_number(), has_kernel);
    EXPECT_EQ(filter["kernel"]["class"].is_string(), has_kernel) << filter["id"];
    EXPECT_EQ(filter["teaching"], filter["id"] == "box3x3" || filter["id"].get<std::string>().starts_with("teach"));
  }
}

TEST_F(Command, BorderSettings_ReachCellsPicturesAndUsersFilters) {
  // A user's copy of a built-in filter, in its own process, shows the same artefact.
  write("copied.glsl", read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/filters/pcf2x2.glsl"));
  const std::string arguments =
      "run --size 64x36 --map-size 64 --rounds 1 --scene edge --filters pcf2x2,copied --filter-file copied.glsl ";
  const std::vector<std::string> settings = {"--out out", "--out repeat --border repeat", "--out edge --border edge",
                                             "--out far --far-test off"};
  std::set<std::string> keys, pictures;
  for (const std::string& setting : settings) {
    const Outcome outcome = run(arguments + setting);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto out = folder() / setting.substr(6, setting.find(' ', 6) - 6);
    const nlohmann::json document = nlohmann::json::parse(read_text(out / "results.json"));
    for (const auto& cell : document["cells"]) keys.insert(cell["key"].get<std::string>());
    EXPECT_EQ(document["cells"][0]["receivers"], document["cells"][1]["receivers"]);
    const std::string picture = read_text(out / "images" / "edge.pcf2x2.visibility.png");
    EXPECT_EQ(picture, read_text(out / "images" / "edge.copied.visibility.png")) << setting;
    pictures.insert(picture);
  }
  EXPECT_EQ(keys.size(), 8u);
  EXPECT_EQ(pictures.size(), 4u);
  const nlohmann::json range =
      nlohmann::json::parse(read_text(folder() / "repeat" / "results.json"))["cells"][0]["range"];
  EXPECT_EQ(range, nlohmann::json::parse(R"({"border": "repeat", "far_test": true, "behind_test": true})"));
}

TEST_F(Command, BlendCasters_AreHeldAgainstTheirTransmittance) {
  const std::string arguments = "run --size 160x90 --map-size 512 --rounds 1 --scene panes --filters tent7x7 --out ";
  std::set<std::string> keys;
  std::map<std::string, double> rmse;
  for (const std::string name : {"opaque", "hashed", "dither"}) {
    const Outcome outcome = run(arguments + name + " --blend-casters " + name);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const nlohmann::json document = nlohmann::json::parse(read_text(folder() / name / "results.json"));
    const nlohmann::json& cell = document["cells"][0];
    keys.insert(cell["key"].get<std::string>());
    rmse[name] = cell["error"]["rmse"];
    EXPECT_EQ(cell["map_format"], name == "opaque" ? "d32f" : "d32f " + name);
    EXPECT_EQ(outcome.err.find("'pane', which blends") != std::string::npos, name == "opaque") << outcome.err;
  }
  EXPECT_EQ(keys.size(), 3u);
  EXPECT_LT(rmse["hashed"], 0.5 * rmse["opaque"]);
  EXPECT_LT(rmse["dither"], 0.5 * rmse["opaque"]);
}

TEST_F(Command, OnlyTheRightRule_LeavesNoErrorBeyondTheFarPlane) {
  const std::string arguments = "run --out out --size 128x72 --map-size 256 --rounds 1 --scene edge --filters none ";
  ASSERT_EQ(run(arguments).exit_code, 0);
  const double right = results(folder())["cells"][0]["error"]["rmse"];
  ASSERT_EQ(run(arguments + "--far-test off").exit_code, 0);
  EXPECT_GT(results(folder())["cells"][0]["error"]["rmse"], 3.0 * right);
}

TEST_F(Command, BehindTestOff_SaysThatItChangesNothing_ButUnderSpots) {
  const Outcome outcome =
      run("run --out out --size 64x36 --map-size 64 --rounds 1 --scene three_lights --filters none --behind-test off");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json document = results(folder());
  std::vector<std::string> scenes;
  for (const std::string warning : document["warnings"])
    if (warning.find("--behind-test off changes nothing") != std::string::npos)
      scenes.push_back(warning.substr(0, warning.find(':')));
  EXPECT_THAT(scenes, testing::ElementsAre("three_lights.sun", "three_lights.bulb"));
}

TEST_F(Command, BorderPage_IsDrawnWhereAskedFor_AndLeavesTheNextViewAsItWas) {
  std::string text = read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/data/scenes/teaching/edge.toml");
  text.replace(text.find("[camera]"), 8, "[[camera]]");
  write("views.toml", text + "[[camera]]\nname = \"second\"\nposition = [0, 12, 0.1]\ntarget = [0, 0, 0]\n");
  const std::string arguments =
      "run --grids --out out --size 64x36 --map-size 64 --rounds 1 --scene views.toml --filters none,vsm --border "
      "repeat ";
  const auto picture = [&] { return read_text(folder() / "out" / "images" / "views.second.none.visibility.png"); };
  ASSERT_EQ(run(arguments).exit_code, 0);
  const std::string without = picture();
  EXPECT_FALSE(std::filesystem::exists(folder() / "out" / "views.main.borders.png"));
  const Outcome outcome = run(arguments + "--border-page");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "views.main.borders.png"));
  EXPECT_FALSE(without.empty());
  EXPECT_EQ(picture(), without);
}

TEST_F(Command, BorderPage_OfAReversedMap_IsTheSame) {
  const std::string arguments =
      " --grids --size 160x90 --map-size 128 --rounds 1 --scene edge --filters none --no-truth --border-page";
  ASSERT_EQ(run("run --out usual" + arguments).exit_code, 0);
  ASSERT_EQ(run("run --out reversed --reversed-depth" + arguments).exit_code, 0);
  const Outcome outcome = run("diff usual/edge.borders.png reversed/edge.borders.png --metric rmse --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_LT(nlohmann::json::parse(outcome.out)["rmse"], 0.01);
}

TEST_F(Command, ListScenes_NamesTeachingScenesApart) {
  const std::string out = run("list scenes").out;
  const std::size_t heading = out.find("For teaching");
  ASSERT_NE(heading, std::string::npos);
  EXPECT_GT(out.find("\nedge "), heading);
  EXPECT_LT(out.find("\nsteps "), heading);
  for (const auto& scene : nlohmann::json::parse(run("list scenes --json").out))
    EXPECT_EQ(scene["teaching"],
              !std::set<std::string>({"ball", "cubes", "fence", "stack", "steps"}).count(scene["name"]));
}

TEST_F(Command, ListScenes_NamesAllFive) {
  const std::string out = run("list scenes").out;
  for (const char* name : {"cubes", "stack", "fence", "ball", "steps"}) EXPECT_NE(out.find(name), std::string::npos);
}

}  // namespace
}  // namespace shadowbench::test
