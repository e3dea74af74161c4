// A scene with a sun, a spot and a lamp that stands inside a building, without a camera: from its file to the answer.
// It is the city block where SHADOWBENCH_SCENES names the folder of real models, else a floor with a box.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using json = nlohmann::json;

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
    return run(
        "run --out out --scene city.toml --filters none,pcss --map-size 256 --size 160x90 --phases 2 --rounds 2 "
        "--no-attribution " +
        rest);
  }
  json read_cells() const { return json::parse(read_text(folder() / "out" / "results.json"))["cells"]; }
};

TEST_F(SeveralLights, EachIsSeenFromItsOwnView_AndOneThatIsNotLitIsNamedAtOnce) {
  const Outcome drawn = draw("position = [0.5, 2.0, 0.5]", "--strict");
  EXPECT_EQ(drawn.exit_code, 1) << "a warning, and --strict";
  for (const char* light : {"sun", "spot"}) {
    EXPECT_THAT(drawn.err, HasSubstr(std::string("city: camera for the light '") + light + "' from azimuth"));
    EXPECT_THAT(drawn.err, Not(HasSubstr(std::string("city.") + light + ": the light reaches no surface")));
  }
  std::smatch place;
  ASSERT_TRUE(
      std::regex_search(drawn.err, place,
                        std::regex("city.lamp: the light reaches no surface in view, so that nothing is tested "
                                   "under it; it is enclosed; write into its \\[\\[light\\]\\] (position = .*)")))
      << drawn.err;
  for (const json& cell : read_cells()) EXPECT_EQ("city." + cell["view"].get<std::string>(), cell["scene"]);
  EXPECT_THAT(read_text(folder() / "out" / "index.html"), HasSubstr("2 of 3 lights judged; city.lamp not tested"));

  const Outcome advised = run("advise out --json");
  const json advice = json::parse(advised.out);
  EXPECT_EQ(advice["lights"], (json{{"judged", 2}, {"of", 3}}));
  const json left_out = {
      {"scene", "city.lamp"}, {"view", "lamp"}, {"tested", false}, {"why", "not tested: no receiver in view sees it"}};
  EXPECT_THAT(advice["left_out"], ElementsAre(left_out));
  EXPECT_THAT(run("advise out").out, HasSubstr("2 of 3 lights judged; city.lamp not tested"));
  EXPECT_EQ(run("advise out --scene city.lamp").exit_code, 1);

  const Outcome lifted = draw(place[1], "--light-name lamp");
  EXPECT_EQ(lifted.exit_code, 0) << lifted.err;
  EXPECT_THAT(lifted.err, Not(HasSubstr("reaches no surface")));
  for (const json& cell : read_cells()) EXPECT_GT(cell["truth"]["penumbra"], 50);
}

}  // namespace
}  // namespace shadowbench::test
