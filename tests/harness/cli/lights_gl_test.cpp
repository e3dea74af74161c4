#include <numeric>

#include "report/images/picture_io.h"
#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

// Lights of several kinds, and cascades, as a user of the program meets them.

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
  expect_refusal(small("--scene three_lights --light-name moon --filters none"), 2, {"no scene has a light 'moon'"});
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
  for (const json& cell : read_cells())
    EXPECT_EQ("city." + cell["view"].get<std::string>(), cell["scene"].get<std::string>());
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

// What a run measures: phases and weights of the truth, kernels of equal width, minification, and errors found again.

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
[[object]]
shape = "plane"
size = [4, 4]
[[object]]
shape = "box"
size = [0.3, 0.6, 0.3]
center = [0.0, 0.3, 0.0]
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
  expect_refusal(small(start + "--truth-weight cosin"), 2, {"--truth-weight 'cosin'; known: area, cosine"});
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
