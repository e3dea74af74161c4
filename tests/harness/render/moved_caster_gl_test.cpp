// Casters that move take their shadows with them, and light and camera that stay change nothing: on every built-in
// scene.

#include <algorithm>
#include <cstdio>
#include <tuple>

#include "tests/harness/render/contract_fixture.h"

namespace shadowbench::test {
namespace {

using filters::Receiver;

constexpr int kMovedMapSize = 512;
constexpr int kMovedWidth = 320, kMovedHeight = 180;
constexpr glm::dvec2 kStepTexels{
    4.0, 3.0};  // whole texels of the map: the texel grid lies on the moved casters as on the others
constexpr glm::dvec2 kStepOfLevels{16.0, -16.0};  // the same for mip levels up to texels of 16
constexpr double kRoom = 1.5;  // before and behind the planes that fit the scene, metres: for what moves

/// Coordinates that have moved are rounded otherwise: a silhouette that runs near a texel's centre may take one texel
/// more or less. Measured: 3 of 38 845 receivers change at most.
constexpr float kVisible = 0.02f;
constexpr float kMovedShaded = 0.9f;  // wide kernels leave much light behind thin casters
constexpr double kMovedShare = 0.001, kMovedShareOfSteps = 0.004;

/// Gives the mesh on which the others stand: flat, level, and the largest such.
std::size_t find_floor(const scene::Scene& scene) {
  std::size_t floor = 0;
  float largest = 0.0f;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    scene::Bounds bounds;
    for (const scene::Vertex& v : scene.meshes[i].vertices) bounds.add(v.position_ws);
    const glm::vec3 size = bounds.max - bounds.min;
    if (size.y == 0.0f && size.x * size.z > largest) {
      floor = i;
      largest = size.x * size.z;
    }
  }
  EXPECT_GT(largest, 0.0f) << "the scene has no level floor";
  return floor;
}

/// Gives the scene a map that no longer follows what is in it.
void freeze_frustum(scene::Scene& scene) {
  const scene::LightFrustum fit = scene::fit_light(scene, scene::FitMode::kTight, kMovedMapSize, 12.0);
  const double half = 0.5 * fit.depth_range_ws;
  const glm::dvec3 center(glm::inverse(fit.light_from_world) * glm::dvec4(0.0, 0.0, -half, 1.0));
  scene.light.map_window =
      scene::MapWindow{center, fit.width_ws, scene::MapWindow::Planes{-half - kRoom, half + kRoom}};
}

glm::dvec2 step_of(const filters::FilterSpec& spec) {
  const auto has_levels = [](const filters::PassSpec& pass) { return pass.steps == filters::PassSteps::kLevels; };
  return std::ranges::any_of(spec.passes, has_levels) ? kStepOfLevels : kStepTexels;
}

/// Gives a way along the floor that is `step_texels` in the map.
glm::vec3 choose_way(const scene::LightFrustum& frustum, glm::dvec2 step_texels) {
  const glm::dmat3 world_from_light = glm::transpose(glm::dmat3(frustum.light_from_world));
  const glm::dvec3 across =
      frustum.texel_size_ws * (step_texels.x * world_from_light[0] + step_texels.y * world_from_light[1]);
  const glm::dvec3 light(frustum.direction_ws);
  return glm::vec3(across - light * (across.y / light.y));
}

/// Moves everything but the floor.
scene::Scene move_casters(scene::Scene scene, const glm::vec3& way) {
  const std::size_t floor = find_floor(scene);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    if (i == floor) continue;
    for (scene::Vertex& v : scene.meshes[i].vertices) v.position_ws += way;
  }
  return scene;
}

/// A drawing with its receivers by pixel.
struct Picture {
  std::vector<float> visibility;
  std::vector<std::optional<Receiver>> receivers;
};

Picture draw(const scene::Scene& scene, const filters::FilterRequest& request) {
  Bench bench(shared_context(), scene, kMovedMapSize, kMovedWidth, kMovedHeight);
  Picture picture{bench.draw(request),
                  std::vector<std::optional<Receiver>>(static_cast<std::size_t>(kMovedWidth * kMovedHeight))};
  for (const Receiver& r : bench.receivers(request)) picture.receivers[bench.index(r)] = r;
  return picture;
}

struct Change {
  int compared = 0;
  int changed = 0;
  int shaded = 0;
};

/// Compares the pixels whose receivers are the same but for a way.
Change compare(const Picture& before, const Picture& after, const glm::vec3& way, float visible) {
  Change change;
  for (std::size_t i = 0; i < before.receivers.size(); ++i) {
    const auto &a = before.receivers[i], &b = after.receivers[i];
    if (!a || !b || glm::distance(a->position_ws + way, b->position_ws) > 1e-3f * a->texel_size_ws) continue;
    ++change.compared;
    change.changed += std::abs(before.visibility[i] - after.visibility[i]) > visible ? 1 : 0;
    change.shaded += before.visibility[i] < kMovedShaded ? 1 : 0;
  }
  return change;
}

class MovedCaster : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  scene::Scene scene_ = [] {
    scene::Scene scene = load_builtin(std::get<0>(GetParam()));
    freeze_frustum(scene);
    return scene;
  }();
  filters::FilterRequest request_ = request_of(std::get<1>(GetParam()));
  glm::vec3 way_ =
      choose_way(scene::fit_light(scene_, scene::FitMode::kTight, kMovedMapSize, 6.0), step_of(request_.spec));
};

/// A camera that goes along sees the same picture on the floor, which stays, as on what moved.
TEST_P(MovedCaster, TakesItsShadowWithIt) {
  scene::Scene moved = move_casters(scene_, way_);
  moved.cameras.front().position_ws += way_;
  const Change change = compare(draw(scene_, request_), draw(moved, request_), way_, kVisible);
  std::printf("%d receivers, %d shaded, %d changed\n", change.compared, change.shaded, change.changed);
  EXPECT_GT(change.compared, 10000);
  EXPECT_GT(change.shaded, change.compared / 100);
  EXPECT_LE(change.changed, (rounds_to_steps(request_.spec) ? kMovedShareOfSteps : kMovedShare) * change.compared);
}

/// A camera that stays sees shadows leave places that stay, and reach others.
TEST_P(MovedCaster, LeavesNoShadowBehind) {
  const Picture before = draw(scene_, request_), after = draw(move_casters(scene_, way_), request_);
  const Change change = compare(before, after, glm::vec3(0.0f), 1.0f - kMovedShaded);
  std::printf("%d of %d changed\n", change.changed, change.compared);
  EXPECT_GT(change.compared, 5000);
  EXPECT_GT(change.changed, change.compared / 100);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, MovedCaster,
                         ::testing::Combine(::testing::ValuesIn(builtin_scenes()), ::testing::ValuesIn(filter_ids())),
                         [](const auto& each) { return std::get<0>(each.param) + "_" + std::get<1>(each.param); });

}  // namespace
}  // namespace shadowbench::test
