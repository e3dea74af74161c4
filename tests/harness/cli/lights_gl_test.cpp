// Lights of several kinds, and cascades, as a user of the program meets them.

#include <set>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

class LayersRun : public ProgramTest {
 protected:
  json run_cells(const std::string& rest) const {
    const json cells = measure("--size 96x54 " + rest);
    expect_valid();
    return cells;
  }
};

TEST_F(LayersRun, UsersFilters_GetWhatBuiltInOnesGet) {
  copy_filter("tent3x3", "mine");
  const std::pair<const char*, int> maps[] = {{"--scene lantern", 6},
                                              {"--scene lantern --fit paraboloid", 2},
                                              {"--scene avenue --fit cascades:count=3,split=logarithmic", 3},
                                              {"--scene avenue --fit lispsm", 1},
                                              {"--scene avenue --fit logpsm", 1}};
  for (const auto& [scene, layers] : maps) {
    const json cells = run_cells(
        std::string(scene) + " --stability --filters none,tent3x3,mine,vsm:bleed_reduction=0 --filter-file mine.glsl");
    ASSERT_EQ(cells.size(), 4u) << scene;
    const auto find = [&](const char* filter) {
      return *std::ranges::find_if(cells, [&](const json& cell) { return cell["filter"] == filter; });
    };
    for (const char* group : {"error", "attribution", "artefact", "coverage", "excused"})
      EXPECT_EQ(find("mine")[group], find("tent3x3")[group]) << scene << " " << group;
    for (const json& cell : cells) {
      EXPECT_EQ(cell["status"], "ok") << cell["message"];
      EXPECT_LT(cell["attribution"]["numeric"]["rms"], 2e-3) << "the model follows the receivers to their layers";
      const int bytes = cell["filter"] == "vsm" ? 8 : 4;
      EXPECT_EQ(cell["cost"]["map_bytes"], layers * 64 * 64 * bytes);
    }
    EXPECT_EQ(find("none")["cost"]["passes"], 2 * layers);
    EXPECT_EQ(find("vsm")["stability"]["bound_exact_violations"], 0) << scene;
  }
}

/// Its process names what it draws by its parameters, too.
TEST_F(LayersRun, UsersFilter_WithParametersInAnyOrder_IsScored) {
  copy_filter("poisson", "mine");
  const json cells = run_cells("--scene cubes --filters mine:taps=4,bail=agree --filter-file mine.glsl");
  EXPECT_TRUE(cells[0]["error"]["rmse"].is_number()) << cells[0]["absent"];
}

TEST_F(LayersRun, CascadesShareTheErrorOfTheirCell_AndEndWhereTheyAreAskedTo) {
  const json cells = run_cells("--scene avenue --filters none,tent3x3 --phases 1 --fit cascades:splits=40,far=200");
  for (const json& cell : cells) {
    double shares = 0.0, squares = 0.0, worst = 0.0;
    std::vector<double> ends;
    for (const json& cascade : cell["cascades"]) {
      const double rmse = cascade["rmse"].get<double>();
      ends.push_back(cascade["end_m"]);
      shares += cascade["share"].get<double>();
      squares += cascade["share"].get<double>() * rmse * rmse;
      worst = std::max(worst, rmse);
      EXPECT_GT(cascade["texels_per_pixel"], 0.0);
    }
    EXPECT_THAT(ends, ElementsAre(40.0, 200.0));
    EXPECT_NEAR(shares, 1.0, 1e-12);
    EXPECT_NEAR(std::sqrt(squares), cell["error"]["rmse"].get<double>(), 1e-9);
    EXPECT_EQ(cell["error"]["rmse_cascade"], worst);
  }
  EXPECT_THAT(read("out/index.html"), HasSubstr("<td class=\"n\">0.2000</td>"));
  EXPECT_EQ(run("advise out --max-rmse-cascade 0").exit_code, 1);
  succeed("advise out --max-rmse-cascade 1 --max-seam 1");
  const json others = run_cells("--fresh --scene avenue --filters none --fit tight --fit cascades:splits=0.1");
  EXPECT_TRUE(others[0]["error"]["rmse_cascade"].is_null());
  EXPECT_THAT(others[1]["warnings"].dump(), HasSubstr("cascade 1, which ends at 0.1 m, has no receiver"));
}

TEST_F(LayersRun, FitsAreAnAxis) {
  const json cells = run_cells(
      "--grids --no-attribution --phases 1 --scene avenue --filters none --fit tight --fit view --fit cascades "
      "--equal-bytes");
  std::set<std::string> fits, keys;
  for (const json& cell : cells) {
    fits.insert(cell["fit"]);
    keys.insert(cell["key"]);
    EXPECT_EQ(cell["cost"]["map_bytes"], 4 * 64 * 64);
    EXPECT_EQ(cell["map_size"], cell["fit"].get<std::string>().starts_with("cascades") ? 32 : 64);
    EXPECT_TRUE(exists("out/" + cell["images"]["depth_map"].get<std::string>()));
  }
  EXPECT_THAT(fits, ElementsAre("cascades:count=4,split=0.5,blend=0.1,depths=all", "tight", "view"));
  EXPECT_EQ(keys.size(), 3u);
}

TEST_F(LayersRun, EachOfSeveralLights_IsMeasuredByItself_UsersFiltersToo) {
  copy_filter("pcf2x2", "mine");
  const std::string filters = " --no-attribution --filters pcf2x2,mine --filter-file mine.glsl";
  const json cells = run_cells("--scene three_lights" + filters);
  ASSERT_EQ(cells.size(), 6u);
  std::set<double> errors;
  for (std::size_t i = 0; i < cells.size(); i += 2) {
    EXPECT_EQ(cells[i]["scene"], cells[i + 1]["scene"]);
    EXPECT_EQ(cells[i]["error"], cells[i + 1]["error"]) << cells[i]["scene"];
    errors.insert(cells[i]["error"]["rmse"].get<double>());
  }
  EXPECT_EQ(errors.size(), 3u) << "each light has its own truth";
  const json one = run_cells("--fresh --scene three_lights --light-name bulb" + filters);
  ASSERT_EQ(one.size(), 2u);
  EXPECT_EQ(one[0]["scene"], "three_lights.bulb");
  EXPECT_EQ(one[0]["error"], cells[4]["error"]);
  const Outcome unknown = run(small("--scene three_lights --light-name moon --filters none"));
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("no scene has a light 'moon'"));
}

TEST_F(LayersRun, AllLightsAtOnce_AreDrawnWhereAllAreMeasured) {
  const std::string settings =
      "--grids --no-attribution --phases 1 --size 96x54 --map-size 128 --scene three_lights --filters none";
  EXPECT_EQ(measure(settings + " --light-name bulb")[0]["images"]["all_lights"], nullptr);
  for (const json& cell : measure(settings))
    EXPECT_EQ(cell["images"]["all_lights"], "three_lights.all_lights.grid.png");
  EXPECT_TRUE(exists("out/three_lights.all_lights.grid.png"));
  EXPECT_THAT(read("out/index.html"), HasSubstr("three_lights.all_lights.grid.png"));
}

TEST_F(LayersRun, ALampInsideACaster_IsWarnedOf) {
  std::string scene = read_source("data/scenes/teaching/lantern.toml");
  const std::string place = "position = [0.1, 1.3, 0.05]";
  ASSERT_NE(scene.find(place), std::string::npos);
  scene.replace(scene.find(place), place.size(), "position = [-1.5, 0.35, 1.2]");
  write("inside.toml", scene);
  run_cells("--filters none --scene inside.toml");
  EXPECT_THAT(read_results()["warnings"].dump(), HasSubstr("the light reaches no surface in view"));
}

/// A sun, a spot and a lamp that stands inside a building, without a camera: the city block where SHADOWBENCH_SCENES
/// names the folder of real models, else a floor with a box.
std::string write_geometry() {
  if (const char* folder = std::getenv("SHADOWBENCH_SCENES"))
    return "model = \"" + std::string(folder) + "/kaykit_city_block/kaykit_city_block.gltf\"\n";
  return "[[object]]\nshape = \"plane\"\nsize = [32, 32]\n"
         "[[object]]\nshape = \"box\"\nsize = [1, 3, 1]\ncenter = [0.5, 1.5, 0.5]\n";
}

constexpr const char* kLights =
    "[[light]]\nname = \"sun\"\nazimuth_deg = 60\nelevation_deg = 35\n"
    "[[light]]\nname = \"spot\"\ntype = \"spot\"\nposition = [3, 5, 3]\ntarget = [0, 0, 0]\nradius = 0.1\n"
    "[[light]]\nname = \"lamp\"\ntype = \"point\"\nradius = 0.08\n";

class SeveralLights : public ProgramTest {
 protected:
  Outcome draw(const std::string& lamp, const std::string& rest = "") const {
    write("city.toml", "title = \"city\"\n" + write_geometry() + kLights + lamp + "\n");
    return run(small("--scene city.toml --filters none,pcss --map-size 256 --size 160x90 --phases 2 --no-attribution " +
                     rest));
  }
};

TEST_F(SeveralLights, EachIsSeenFromItsOwnView_AndOneThatIsNotLitIsNamedAtOnce) {
  const Outcome drawn = draw("position = [0.5, 2.0, 0.5]", "--strict");
  EXPECT_EQ(drawn.exit_code, 1) << "a warning, and --strict";
  for (const char* light : {"sun", "spot"}) {
    EXPECT_THAT(drawn.err, HasSubstr(std::string("city: camera for the light '") + light + "' from azimuth"));
    EXPECT_THAT(drawn.err, Not(HasSubstr(std::string("city.") + light + ": the light reaches no surface")));
  }
  EXPECT_THAT(drawn.err, HasSubstr("city.lamp: the light reaches no surface in view"));
  for (const json& cell : read_cells()) EXPECT_EQ("city." + cell["view"].get<std::string>(), cell["scene"]);
  EXPECT_THAT(read("out/index.html"), HasSubstr("2 of 3 lights judged; city.lamp not tested"));

  const Outcome advised = run("advise out --json");
  const json advice = json::parse(advised.out);
  EXPECT_EQ(advice["lights"], (json{{"judged", 2}, {"of", 3}}));
  const json left_out = {
      {"scene", "city.lamp"}, {"view", "lamp"}, {"tested", false}, {"why", "not tested: no receiver in view sees it"}};
  EXPECT_THAT(advice["left_out"], ElementsAre(left_out));
  EXPECT_THAT(run("advise out").out, HasSubstr("2 of 3 lights judged; city.lamp not tested"));
  EXPECT_EQ(run("advise out --scene city.lamp").exit_code, 1);
}

}  // namespace
}  // namespace shadowbench::test
