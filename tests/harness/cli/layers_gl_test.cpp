// Cascades and point lights, as a user of the program meets them.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kSmallLayers = "run --out out --size 96x54 --map-size 64 --rounds 1 --no-grids ";

class LayersRun : public ProgramTest {
 protected:
  json all() const { return json::parse(read_text(folder() / "out" / "results.json")); }

  json run_cells(const std::string& arguments) {
    const Outcome outcome = run(kSmallLayers + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string check = "/usr/bin/python3 -m jsonschema -i '" + (folder() / "out" / "results.json").string() +
                              "' '" + (folder() / "out" / "results.schema.json").string() + "'";
    EXPECT_EQ(std::system(check.c_str()), 0);
    return all()["cells"];
  }
};

TEST_F(LayersRun, UsersFilters_GetWhatBuiltInOnesGet) {
  write("mine.glsl", read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/filters/tent3x3.glsl"));
  const std::pair<const char*, int> maps[] = {{"--scene lantern", 6},
                                              {"--scene lantern --fit paraboloid", 2},
                                              {"--scene avenue --fit cascades:count=3,split=logarithmic", 3},
                                              {"--scene avenue --fit lispsm", 1},
                                              {"--scene avenue --fit logpsm", 1}};
  for (const auto& [scene, layers] : maps) {
    const json cells =
        run_cells(std::string(scene) + " --stability --filters none,tent3x3,mine,vsm:bleed_reduction=0 --filter-file " +
                  (folder() / "mine.glsl").string());
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
  write("mine.glsl", read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/filters/poisson.glsl"));
  const json cells =
      run_cells("--scene cubes --filters mine:taps=4,bail=agree --filter-file " + (folder() / "mine.glsl").string());
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
    EXPECT_THAT(ends, testing::ElementsAre(40.0, 200.0));
    EXPECT_NEAR(shares, 1.0, 1e-12);
    EXPECT_NEAR(std::sqrt(squares), cell["error"]["rmse"].get<double>(), 1e-9);
    EXPECT_EQ(cell["error"]["rmse_cascade"], worst);
  }
  EXPECT_THAT(read_text(folder() / "out" / "index.html"),
              HasSubstr("directional_shadow_max_distance 200, splits 0.2000"));
  EXPECT_EQ(run("advise out --max-rmse-cascade 0").exit_code, 1);
  EXPECT_EQ(run("advise out --max-rmse-cascade 1 --max-seam 1").exit_code, 0);
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
    EXPECT_TRUE(std::filesystem::exists(folder() / "out" / cell["images"]["depth_map"].get<std::string>()));
  }
  EXPECT_THAT(fits, testing::ElementsAre("cascades:count=4,split=0.5,blend=0.1,depths=all", "tight", "view"));
  EXPECT_EQ(keys.size(), 3u);
}

TEST_F(LayersRun, EachOfSeveralLights_IsMeasuredByItself_UsersFiltersToo) {
  write("mine.glsl", read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/filters/pcf2x2.glsl"));
  const std::string filters =
      " --no-attribution --filters pcf2x2,mine --filter-file " + (folder() / "mine.glsl").string();
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
  const Outcome unknown = run(std::string(kSmallLayers) + "--scene three_lights --light-name moon --filters none");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("no scene has a light 'moon'"));
}

TEST_F(LayersRun, AllLightsAtOnce_AreDrawnWhereAllAreMeasured) {
  const std::string settings =
      "run --grids --no-attribution --phases 1 --out out --size 96x54 --map-size 128 --rounds 1 --scene three_lights "
      "--filters none";
  ASSERT_EQ(run(settings + " --light-name bulb").exit_code, 0);
  EXPECT_EQ(all()["cells"][0]["images"]["all_lights"], nullptr);
  ASSERT_EQ(run(settings).exit_code, 0) << "two lights more";
  for (const json& cell : all()["cells"]) EXPECT_EQ(cell["images"]["all_lights"], "three_lights.all_lights.grid.png");
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "three_lights.all_lights.grid.png"));
  EXPECT_THAT(read_text(folder() / "out" / "index.html"), HasSubstr("three_lights.all_lights.grid.png"));
}

TEST_F(LayersRun, ALampInsideACaster_IsWarnedOf) {
  std::string scene = read_text(std::string(SHADOWBENCH_SOURCE_DIR) + "/data/scenes/teaching/lantern.toml");
  const std::string place = "position = [0.1, 1.3, 0.05]";
  ASSERT_NE(scene.find(place), std::string::npos);
  scene.replace(scene.find(place), place.size(), "position = [-1.5, 0.35, 1.2]");
  const auto file = write("inside.toml", scene);
  run_cells("--filters none --scene " + file.string());
  EXPECT_THAT(all()["warnings"].dump(), HasSubstr("the light reaches no surface in view"));
}

}  // namespace
}  // namespace shadowbench::test
