// Lights where something is divided by nothing: in a caster, at a receiver, and with receivers in a spot's own plane.

#include <fmt/format.h>

#include "harness/measure/view_receivers.h"
#include "harness/render/shade_pass.h"
#include "harness/scene/load.h"
#include "harness/scene/scene.h"
#include "tests/harness/render/contract_fixture.h"
#include "tests/harness/scene/test_files.h"

namespace shadowbench::test {
namespace {

/// A floor, a box on it and a wall in the plane x = 0.
scene::Scene load_room(const std::string& light) {
  const scene::TestFolder folder;
  return scene::load_scene(folder.write("room.toml", "title = \"room\"\n[light]\n" + light + R"(
[camera]
position = [3, 2.5, 4]
target = [0, 0.3, 0]
[[object]]
shape = "plane"
size = [6, 6]
[[object]]
shape = "box"
size = [0.4, 0.4, 0.4]
center = [0.6, 0.2, 0]
[[object]]
shape = "plane"
size = [2, 6]
center = [0, 1, 0]
rotation_deg = [0, 0, 90]
)"));
}

struct DegeneratePlace {
  std::string name;
  std::string light;
};

const std::vector<DegeneratePlace>& degenerate_places() {
  static const std::vector<DegeneratePlace> places = [] {
    std::vector<DegeneratePlace> all;
    const std::vector<std::pair<std::string, std::string>> positions = {{"InACaster", "[0.6, 0.2, 0]"},
                                                                        {"OnTheFloor", "[0.3, 0, 0.2]"},
                                                                        {"AHairOverTheFloor", "[0.3, 1e-6, 0.2]"},
                                                                        {"OnTheWall", "[0, 0.5, 0.5]"},
                                                                        {"OnACastersCorner", "[0.4, 0.4, 0.2]"}};
    for (const auto& [name, position] : positions) {
      all.push_back({"Point" + name, "type = \"point\"\nposition = " + position});
      all.push_back({"Spot" + name, "type = \"spot\"\ntarget = [2, -1, 0.2]\nposition = " + position});
    }
    // w = 0 on the whole floor, and on the whole wall.
    all.push_back({"SpotInTheFloorsPlane", "type = \"spot\"\nposition = [0.3, 0, 0.2]\ntarget = [0.3, 2, 0.2]"});
    all.push_back({"SpotInTheWallsPlane", "type = \"spot\"\nposition = [0, 0.5, 0]\ntarget = [2, 0.5, 0]"});
    all.push_back({"RectangleInTheWallsPlane",
                   "type = \"spot\"\nsize = [0.3, 0.1]\nposition = [0, 0.5, 0]\ntarget = [2, 0.5, 0]\ncone_deg = 170"});
    return all;
  }();
  return places;
}

/// Draws all that a scene has under its light, and the truth.
void expect_numbers(const scene::Scene& scene) {
  Bench bench(shared_context(), scene, 128, 96, 54);
  const auto is_share = [](float v) { return v >= -1e-3f && v <= 1.001f; };
  for (const char* id : {"none", "tent3x3", "vsm", "pcss"}) {
    const std::vector<float> image = bench.draw(request_of(id));
    EXPECT_TRUE(std::ranges::all_of(image, is_share)) << id;
    images::Image visibility(96, 54, 1);
    visibility.texels = image;
    const images::Image picture =
        render::shade(bench.shaders(), bench.gbuffer(), render::upload_image(visibility), scene, scene.cameras.front());
    EXPECT_TRUE(std::ranges::all_of(picture.texels, [](float v) { return std::isfinite(v) && v >= 0.0f; })) << id;
  }
  const auto receivers = measure::read_view_receivers(bench.gbuffer(), scene.light).image;
  const truth::Occluders occluders(scene::list_occluders(scene));
  const truth::AreaLight light = scene::make_area_light(scene.light);
  const truth::TracedVisibility truth = truth::trace_area(occluders, receivers, light, {.max_points = 64});
  EXPECT_TRUE(std::ranges::all_of(truth.visibility, is_share));
  EXPECT_TRUE(std::ranges::all_of(truth.standard_error, [](float v) { return std::isfinite(v); }));
  EXPECT_TRUE(std::ranges::all_of(truth::trace_hard(occluders, receivers, light), is_share));
}

class DegenerateLight : public ::testing::TestWithParam<DegeneratePlace> {};

TEST_P(DegenerateLight, GivesNumbers_InEveryImage) { expect_numbers(load_room(GetParam().light)); }

INSTANTIATE_TEST_SUITE_P(Everywhere, DegenerateLight, ::testing::ValuesIn(degenerate_places()),
                         [](const auto& each) { return each.param.name; });

/// On the floor, the box and the wall, to the last bit.
TEST(DegenerateLight, AtAReceiversVeryPlace_GivesNumbers) {
  const scene::Scene lit = load_room("direction = [-1, -1, -1]");
  Bench bench(shared_context(), lit, 128, 96, 54);
  const std::vector<filters::Receiver> receivers = bench.receivers(request_of("none"));
  ASSERT_GT(receivers.size(), 1000u);
  for (std::size_t i = 0; i < receivers.size(); i += receivers.size() / 7) {
    const glm::vec3 place = receivers[i].position_ws, ahead = place + receivers[i].normal_ws;
    scene::Scene scene = lit;
    scene.light.kind = scene::PointLight{place};
    expect_numbers(scene);
    scene.light.kind = scene::Spot{place, ahead};
    expect_numbers(scene);
  }
}

}  // namespace
}  // namespace shadowbench::test
