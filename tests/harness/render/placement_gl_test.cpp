// The same scene at another size, from a file far from the origin, and turned so that its light goes along every axis.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

#include "harness/measure/view_receivers.h"
#include "harness/scene/load.h"
#include "harness/scene/mesh_tools.h"
#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"
#include "tests/harness/render/contract_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

constexpr int kPlacedWidth = 160, kPlacedHeight = 120;
constexpr float kOffVisibly = 0.1f;  // a pixel's visibility
constexpr double kShareOff = 0.01;   // so many pixels may be off by that

using Pictures = std::map<std::string, std::vector<float>>;

Pictures draw_placed(const scene::Scene& scene) {
  Bench bench(shared_context(), scene, 256, kPlacedWidth, kPlacedHeight);
  Pictures pictures;
  for (const char* id : {"none", "box3x3", "poisson", "vsm", "esm", "pcss"}) pictures[id] = bench.draw(request_of(id));
  return pictures;
}

/// The share of the pixels that are off. What is not finite is.
double find_share_off(const std::vector<float>& seen, const std::vector<float>& expected) {
  int off = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) off += std::abs(seen[i] - expected[i]) <= kOffVisibly ? 0 : 1;
  return static_cast<double>(off) / static_cast<double>(seen.size());
}

void expect_same(const Pictures& seen, const Pictures& expected) {
  for (const auto& [id, picture] : expected) {
    EXPECT_GT(std::ranges::count_if(picture, [](float v) { return v < 0.9f; }), 500) << id << " shows no shadow";
    EXPECT_LE(find_share_off(seen.at(id), picture), kShareOff) << id;
  }
}

template <class Place>
scene::Scene place(scene::Scene scene, const Place& place_point) {
  for (scene::Mesh& mesh : scene.meshes)
    for (scene::Vertex& v : mesh.vertices) v.position_ws = glm::vec3(place_point(glm::dvec3(v.position_ws)));
  for (scene::Camera& c : scene.cameras) c.position_ws = glm::vec3(place_point(glm::dvec3(c.position_ws)));
  return scene::validate(std::move(scene), "placed");
}

/// A floor under a slab whose edges no texel grid follows, and a wall that casts no shadow; the light goes straight
/// down unless it leans. All of it is turned.
scene::Scene make_turned_slab(const glm::dmat3& turn, const glm::dvec3& light = {0.0, -1.0, 0.0}) {
  const glm::dmat4 world(turn), none(1.0);
  const glm::dmat4 slab = glm::rotate(glm::translate(none, glm::dvec3(0.2, 1.0, -0.1)), glm::radians(20.0),
                                      glm::dvec3(0.0, 1.0, 0.0)),
                   wall = glm::rotate(glm::translate(none, glm::dvec3(-2.0, 0.6, 0.0)), glm::radians(-90.0),
                                      glm::dvec3(0.0, 0.0, 1.0));
  scene::Scene scene;
  scene.name = "turned slab";
  scene.materials.emplace_back();
  scene.meshes = {scene::transform_mesh(scene::make_plane({4.0f, 4.0f}, 8), world),
                  scene::transform_mesh(scene::make_plane({1.5f, 1.0f}, 4), world * slab),
                  scene::transform_mesh(scene::make_plane({1.2f, 4.0f}, 4), world * wall)};
  scene.meshes.back().casts_shadow = false;
  scene.light.kind = scene::Sun{glm::vec3(turn * glm::normalize(light))};
  const glm::dvec3 eye(2.6, 3.6, 3.4), forward = glm::normalize(glm::dvec3(-0.2, 0.3, 0.0) - eye);
  scene::Camera camera;
  camera.position_ws = glm::vec3(turn * eye);
  camera.forward_ws = glm::vec3(turn * forward);
  camera.up_ws = glm::vec3(turn * glm::dvec3(0.0, 1.0, 0.0));
  scene.cameras.push_back(camera);
  return scene::validate(scene, scene.name);
}

/// No length in the chain is absolute, and floats round alike at every size.
TEST(Placement, SceneOfAnySize_LooksTheSame) {
  const scene::Scene cubes = load_builtin("cubes");
  const Pictures expected = draw_placed(cubes);
  for (const double factor : {1e-6, 0.3, 7.0, 1e6}) {
    SCOPED_TRACE(factor);
    expect_same(draw_placed(place(cubes, [&](const glm::dvec3& p) { return factor * p; })), expected);
  }
}

/// A fence on a floor, whose file has it so far along x and z.
scene::Scene load_fence_at(double distance) {
  const auto at = [&](double x, double y, double z) {
    return fmt::format("[{:.12g}, {}, {:.12g}]\n", distance + x, y, distance + z);
  };
  const TestFolder folder;
  const std::string text =
      "title = \"fence\"\n[camera]\nvertical_fov_deg = 35\nposition = " + at(3.0, 2.5, 4.0) +
      "target = " + at(0.0, 0.5, 0.0) + "[light]\nazimuth_deg = 72\nelevation_deg = 38\n" +
      "[[object]]\nshape = \"plane\"\nsize = [8, 8]\ncenter = " + at(0.0, 0.0, 0.0) +
      "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nrotation_deg = [0, 30, 0]\ncenter = " + at(0.0, 0.5, 0.0) +
      "[[object]]\nshape = \"bars\"\ncount = 7\nbar_width = 0.08\n" +
      "spacing = 0.2\nlength = 1\ncenter = " + at(1.2, 0.5, 0.6);
  return scene::load(folder.write("fence.toml", text).string(), {});
}

/// The last pixels that differ are those where a silhouette or an edge of a shadow runs through a sample within some
/// roundings of a coordinate.
TEST(Placement, SceneOfAFileFarFromTheOrigin_LooksTheSame) {
  constexpr double kShareOfEdges = 6e-4;  // twice the most that was seen, 6 of 19 200 pixels
  const Pictures expected = draw_placed(load_fence_at(0.0));
  for (const double distance : {20.0, 100.0, 200.0, 500.0, 10e3, 1e6}) {
    SCOPED_TRACE(distance);
    const Pictures seen = draw_placed(load_fence_at(distance));
    for (const auto& [id, picture] : expected) EXPECT_LE(find_share_off(seen.at(id), picture), kShareOfEdges) << id;
  }
}

/// Compares what filters draw of a scene with what is traced at the same places, but for surfaces that light grazes:
/// there it must be a share of light, and no more is known.
void expect_traced_shadow(const scene::Scene& scene, const std::vector<std::string>& filters) {
  Bench bench(shared_context(), scene, 1024, kPlacedWidth, kPlacedHeight);
  const measure::ViewReceivers receivers = measure::read_view_receivers(bench.gbuffer(), scene.light);
  const images::Image traced = receivers.to_image(truth::trace_hard(
      truth::Occluders(scene::list_occluders(scene)), receivers.image, scene::make_area_light(scene.light)));
  const glm::vec3 to_light = scene::to_light(scene.light, {});
  for (const std::string& filter : filters) {
    const std::vector<float> drawn = bench.draw(request_of(filter));
    EXPECT_TRUE(std::ranges::all_of(drawn, [](float v) { return v >= 0.0f && v <= 1.0f; })) << filter;
    std::vector<float> seen, expected;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const int x = static_cast<int>(i) % kPlacedWidth, y = kPlacedHeight - 1 - static_cast<int>(i) / kPlacedWidth;
      const std::size_t at = static_cast<std::size_t>(y * kPlacedWidth + x);  // rows of images begin at the top
      if (std::abs(glm::dot(receivers.image.points[at].normal_ws, to_light)) < 0.02f) continue;
      seen.push_back(drawn[i]);
      expected.push_back(traced.texels[at]);
    }
    EXPECT_GT(std::ranges::count(expected, 0.0f), 500) << filter;
    EXPECT_LE(find_share_off(seen, expected), kShareOff) << filter;
  }
}

/// Exactly along an axis, and beside it, towards where the light's own axes may switch and between; one plane is at
/// right angles to the light, one parallel.
TEST(Placement, LightAlongEveryAxis_AndBesideIt_CastsTheShadowThatIsTraced) {
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const glm::dmat3 turns[] = {{x, y, z}, {-x, -y, z}, {-y, x, z}, {y, -x, z}, {x, z, -y}, {x, -z, y}};
  const std::pair<double, double> leans[] = {{0.0, 0.0},   {1e-9, 0.0},  {1e-9, 0.9}, {1e-4, 1.6},
                                             {0.17, 0.25}, {0.17, 1.57}, {0.17, 4.1}};
  for (const glm::dmat3& turn : turns) {
    for (const auto& [lean, to] : leans) {
      const glm::dvec3 light(lean * std::cos(to), -1.0, lean * std::sin(to));
      SCOPED_TRACE(fmt::format("along {}, {}, {}, {} off towards {}", -turn[1].x, -turn[1].y, -turn[1].z, lean, to));
      expect_traced_shadow(make_turned_slab(turn, light), {"none", "tent3x3", "vsm:radius=1"});
    }
  }
}

}  // namespace
}  // namespace shadowbench::test
