// Another renderer's pictures as rows of a report.

#include "report/images/picture_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

constexpr const char* kScoredRun =
    "run --grids --all-parts --size 96x54 --map-size 128 --rounds 1 --phases 1 --scene cubes --filters "
    "none,pcf2x2,vsm";

class Score : public ProgramTest {
 protected:
  void make_run() const { draw_once(kScoredRun); }

  json find_row(const std::string& filter) const {
    for (const json& cell : read_cells())
      if (cell["filter"] == filter) return cell;
    return {};
  }
};

TEST_F(Score, OurOwnPicture_HasOurOwnErrors_AndTheTruthNone) {
  make_run();
  const Outcome outcome = succeed("score out --name 'a <b>copy</b>' --visibility 'out/cubes.exr#none.visibility'");
  EXPECT_THAT(outcome.out, HasSubstr("nearest filter       none, 0 apart"));
  const json row = find_row("a <b>copy</b>"), none = find_row("none");
  for (const char* name : {"rmse", "mae", "p95", "max", "mean", "flip"})
    EXPECT_EQ(row["error"][name], none["error"][name]) << name;
  for (const char* name : {"acne", "leak"}) EXPECT_EQ(row["artefact"][name], none["artefact"][name]) << name;
  EXPECT_EQ(row["external"]["nearest"], "none");
  EXPECT_EQ(row["external"]["peers"]["pcf2x2"], find_row("pcf2x2")["error"]["rmse"]);
  EXPECT_EQ(row["absent"]["time_ms"], "another renderer drew it");
  EXPECT_THAT(read("out/accuracy.csv"), HasSubstr("a <b>copy</b>"));
  EXPECT_EQ(read("out/index.html").find("<b>copy</b>"), std::string::npos);
  succeed("score out --name truth --visibility 'out/cubes.exr#truth.area'");
  EXPECT_EQ(find_row("truth")["error"]["rmse"], 0.0);
  // It is measured against the same truth, and no fit for advice.
  EXPECT_EQ(run("advise out").out.find("copy"), std::string::npos);
}

TEST_F(Score, ARowStays_WhenTheRunIsRepeated_AndIsReplacedByItsName) {
  make_run();
  succeed("score out --name other --visibility 'out/cubes.exr#vsm.visibility'");
  succeed(std::string(kScoredRun) + " --fresh --out out");
  EXPECT_EQ(find_row("other")["external"]["nearest"], "vsm");
  EXPECT_EQ(find_row("other")["images"]["grid"], nullptr);
  succeed("score out --name other --visibility 'out/cubes.exr#pcf2x2.visibility'");
  EXPECT_EQ(find_row("other")["external"]["nearest"], "pcf2x2");
  EXPECT_EQ(read_cells().size(), 4u);
}

TEST_F(Score, ARowOfAnotherLight_IsDropped_AndSaid) {
  make_run();
  succeed("score out --name other --visibility 'out/cubes.exr#vsm.visibility'");
  EXPECT_THAT(run(std::string(kScoredRun) + " --light 200,40 --out out").err,
              HasSubstr("other, cubes: this row of another renderer is dropped"));
  EXPECT_TRUE(find_row("other").is_null());
}

TEST_F(Score, ASceneThatHasChanged_IsNotScored) {
  write("my.toml", read_source("data/scenes/cubes.toml"));
  succeed("run --grids --out out --size 96x54 --map-size 128 --rounds 1 --phases 1 --scene my.toml --filters none");
  std::string text = read("my.toml");
  text.replace(text.find("elevation_deg"), 13, "elevation_deg = 20 #");
  write("my.toml", text);
  expect_refusal("score out --name x --visibility 'out/my.exr#none.visibility'", 3, {"no longer the report's"});
}

TEST_F(Score, RegressTellsThatItMoved) {
  make_run();
  const std::string score = "score out --name 'my engine' --visibility ";
  succeed(score + "'out/cubes.exr#pcf2x2.visibility'");
  succeed("regress out --baseline base --accept");
  succeed("regress out --baseline base");
  succeed(score + "'out/cubes.exr#vsm.visibility'");
  const Outcome moved = run("regress out --baseline base");
  EXPECT_EQ(moved.exit_code, 1);
  EXPECT_THAT(moved.out, HasSubstr("my engine"));
}

TEST_F(Score, AnExportedScene_HasTheSameTruth) {
  make_run();
  succeed("export cubes --strict --size 96x54 --map-size 128 --out scenes");
  const json scene = read_json("scenes/cubes/scene.json");
  EXPECT_EQ(scene["maps"][0]["layers"][0]["kind"], "orthographic");
  succeed(
      "run --grids --all-parts --out again --size 96x54 --map-size 128 --rounds 1 --phases 1 --scene "
      "scenes/cubes/cubes.glb --filters none,pcf2x2,vsm");
  const Outcome diff = run("diff --json out/cubes.exr#truth.area again/cubes.exr#truth.area");
  EXPECT_LT(json::parse(diff.out)["rmse"].get<double>(), 1e-5);
}

/// Of a scene without warnings --strict says nothing, see above.
TEST_F(Score, AnExportedSceneThatWarns_IsWritten_AndIsNotStrict) {
  write("table.obj", "mtllib absent.mtl\nv 0 1 0\nv 1 1 0\nv 1 1 1\nf 1 2 3\n");
  const Outcome exported = run("export table.obj --ground --strict --size 32x18 --map-size 64 --out scenes");
  EXPECT_EQ(exported.exit_code, 1) << exported.err;
  EXPECT_THAT(exported.err, HasSubstr("warning: table: the material library 'absent.mtl'"));
  EXPECT_THAT(exported.err, HasSubstr("--strict: the scene has 1 warning: table: the material library 'absent.mtl'"));
  EXPECT_TRUE(exists("scenes/table/table.glb"));
}

TEST_F(Score, ACommandDrawsTheScene) {
  make_run();
  write("draw.sh",
        "test -f \"$1\" && cp out/own.exr \"$2\"\nprintf '{\"engine\": \"sh\", \"ms\": 1.5, \"truth\": \"%s\"}' "
        "$(sed -n 's/.*\"truth\": \"\\([0-9a-f]*\\)\".*/\\1/p' \"$1\") > \"$(dirname \"$2\")/meta.json\"\n");
  const images::ExrFile file = images::read_exr(folder() / "out/cubes.exr");
  for (const images::Part& part : file.parts)
    if (part.name == "vsm.visibility")
      images::write_exr(folder() / "out/own.exr", {{"visibility", {"Y"}, part.image, false}}, {});
  succeed("score out --name mine --command 'sh draw.sh'");
  EXPECT_EQ(find_row("mine")["external"]["engine"], "sh");
  EXPECT_EQ(find_row("mine")["external"]["ms"], 1.5);
  EXPECT_EQ(find_row("mine")["external"]["nearest"], "vsm");
}

TEST_F(Score, AnExperimentNamesRenderers) {
  write("copy.sh", "cp own.exr \"$2\"\n");
  images::Image lit(96, 54, 1);
  std::ranges::fill(lit.texels, 1.0f);
  images::write_exr(folder() / "own.exr", {{"visibility", {"Y"}, lit, false}}, {});
  write("engines.toml", R"(
scene = "cubes"
filters = "none"
size = "96x54"
map_size = 128
rounds = 1
phases = 1
[[engine]]
name = "all lit"
command = "sh copy.sh"
)");
  expect_refusal("run engines.toml --out out", 2, {"--allow-commands"});
  EXPECT_THAT(read("stderr.txt"), HasSubstr("sh copy.sh")) << "what would be run";
  succeed("run engines.toml --allow-commands --out out");
  EXPECT_GT(find_row("all lit")["error"]["mean"].get<double>(), 0.0);
  EXPECT_THAT(run("run engines.toml --allow-commands --out out").err, HasSubstr("all lit"));
  write("typo.toml", "[[engine]]\nname = 'x'\ncomand = 'y'\n");
  EXPECT_THAT(run("run typo.toml --out typo").err, HasSubstr("comand"));
}

TEST_F(Score, WithItsOwnMap_ItsErrorIsTakenApart) {
  make_run();
  const images::ExrFile file = images::read_exr(folder() / "out/cubes.exr");
  std::istringstream rows(std::get<std::string>(file.metadata.at("shadowbench:map.layer0.uv_depth_from_world")));
  std::vector<double> columns(16);
  for (std::size_t i = 0; i < 16; ++i) rows >> columns[4 * (i % 4) + i / 4];
  write("meta.json", json{{"map_from_world", columns}}.dump());
  succeed(
      "score out --name mine --visibility 'out/cubes.exr#none.visibility' --meta meta.json --shadow-map "
      "'out/cubes.exr#depth_map'");
  const json own = find_row("mine")["attribution"], none = find_row("none")["attribution"];
  // One lookup in the map is what `none` is: nothing is left to its filter, and the map has its share.
  EXPECT_NEAR(own["estimator"]["rms"].get<double>(), 0.0, 0.01);
  EXPECT_NEAR(own["discretisation"]["share"].get<double>(), none["discretisation"]["share"].get<double>(), 0.02);
  EXPECT_NEAR(own["model"]["share"].get<double>(), none["model"]["share"].get<double>(), 0.02);
  expect_refusal(
      "score out --name mine --visibility 'out/cubes.exr#none.visibility' --shadow-map 'out/cubes.exr#depth_map'", 3,
      {"map_from_world"});
}

TEST_F(Score, AnOpenCasterWithoutItsShadow_IsNamed) {
  write("roof.toml", R"(
title = "A roof without an underside"
[camera]
position = [0, 3, 8]
target = [0, 0.5, 0]
vertical_fov_deg = 40
[light]
azimuth_deg = 0
elevation_deg = 80
angular_diameter_deg = 0.53
[[object]]
shape = "plane"
name = "floor"
size = [8, 8]
[[object]]
shape = "plane"
name = "roof"
size = [2, 2]
center = [0, 1, 0]
[[object]]
shape = "box"
name = "box"
size = [1, 1, 1]
center = [3, 0.5, 0]
)");
  const std::string run = "run --grids --size 96x54 --map-size 256 --rounds 1 --scene roof.toml --filters none --out ";
  succeed(run + "out");
  succeed(run + "culled --bias front-cull:depth=0");
  const std::string score = "score out --name its --visibility ";
  EXPECT_EQ(succeed(score + "'out/roof.exr#none.visibility'").err.find("shadow map holds"), std::string::npos);
  EXPECT_THAT(succeed(score + "'culled/roof.exr#none.visibility'").err, HasSubstr("shadow map holds back faces alone"));
}

TEST_F(Score, BadInput_IsOneSentence_AndLosesNothing) {
  make_run();
  write("typo.json", R"({"engin": "x"})");
  write("foreign.json", R"({"truth": "0123"})");
  write("list.json", "[1]");
  const std::string none = "--visibility 'out/cubes.exr#none.visibility' ";
  expect_refusals({
      {"score out --name x", 2, {"give what was drawn"}},
      {"score out --name none " + none, 2, {"is a filter of this run"}},
      {"score out --name x --scene cube " + none, 2, {"cubes (view main)"}},
      {"score out --name x --lit 'out/cubes.exr#none.picture'", 3, {"give lit and unlit"}},
      {"score out --name x --layers out/cubes.exr", 3, {"give lit and unlit"}},
      {"score out --name x --visibility no.exr", 3, {"there is no such file"}},
      {"score out --name x --meta typo.json " + none, 3, {"did you mean 'engine'"}},
      {"score out --name x --meta foreign.json " + none, 3, {"export this run's scene again"}},
      {"score out --name x --meta list.json " + none, 3, {"one object"}},
      {"score out --name x --command false", 3, {"exit code 1"}},
      {"score out --name x --command true", 3, {"wrote no picture.exr"}},
      {"score out --name x --command 'sleep 9 #' --cell-timeout 0.3", 3, {"was killed (--cell-timeout)"}},
      {"score out --name x --command true " + none, 2, {"leave out the files"}},
      {"score out --name x --command 'sleep 9 2>/dev/null #' --cell-timeout 0.3", 3, {"was killed (--cell-timeout)"}},
      {"score out --name x --command 'WORD=7 sh -c \"exit \\$WORD\" #'", 3, {"exit code 7"}},
      {"score out --name x --map-size 64 " + none, 2, {"no map of 64"}},
      {"score nowhere --name x " + none, 3, {"nowhere"}},
  });
}

}  // namespace
}  // namespace shadowbench::test
