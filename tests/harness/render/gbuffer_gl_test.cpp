// Receivers are points of the triangles that the pixels show, so that no ray meets the surface that it leaves.

#include <glm/gtc/constants.hpp>

#include "harness/measure/view_receivers.h"
#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"
#include "tests/harness/render/bench_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

constexpr float kHalfSide = 0.7f;  ///< metres, of a square's or a box's side

/// Shows scenes, and visits the receivers.
class Viewer {
 public:
  Viewer(int width, int height) : gbuffer_(width, height) {}

  /// Calls visit(position, normal, pixel) for each receiver; the pixel's rows count from the top.
  template <class Visit>
  void see(const scene::Scene& scene, const scene::Camera& camera, Visit visit) {
    gbuffer_.draw(shaders_, render::Geometry(scene), scene, camera);
    const truth::ReceiverImage image = measure::read_view_receivers(gbuffer_, scene.light).image;
    for (std::size_t i = 0; i < image.points.size(); ++i) {
      const int at = static_cast<int>(i);
      const truth::ReceiverPoint& point = image.points[i];
      if (point.counts) visit(point.position_ws, point.normal_ws, glm::ivec2(at % image.width, at / image.width));
    }
  }

 private:
  gl::Context& context_ = shared_context();
  render::ShaderLibrary shaders_{options::find_resources().shaders};
  render::GBuffer gbuffer_;
};

/// Two squares that meet at a right angle along the x axis: a floor on the side of +z, and a wall that faces it.
scene::Scene make_valley() {
  scene::Mesh floor = scene::make_plane(glm::vec2(2.0f * kHalfSide), 16), wall = floor;
  for (scene::Vertex& v : floor.vertices) v.position_ws.z += kHalfSide;
  for (scene::Vertex& v : wall.vertices)
    v.position_ws = {v.position_ws.x, kHalfSide - v.position_ws.z, v.position_ws.y};
  return scene::make_scene_of({floor, wall});
}

/// Shows a scene to cameras in many places, each of which carries the light.
template <class Visit>
void look_around(scene::Scene scene, float first_angle, float last_angle, Visit visit) {
  constexpr int kViews = 150;
  Viewer viewer(240, 135);
  for (int view = 0; view < kViews; ++view) {
    const float share = static_cast<float>(view) / kViews, angle = glm::mix(first_angle, last_angle, share);
    const glm::vec3 position(4.0f * std::sin(angle), 0.5f + share, 4.0f * std::cos(angle));
    const scene::Camera camera = scene::make_camera(position, -position);
    scene.light.kind = scene::Sun{.direction_ws = camera.forward_ws};
    viewer.see(scene, camera, visit);
  }
}

TEST(ReceiverPosition, SlatsSeenAtAGrazingAngle_LieInTheirPlane) {
  const scene::Scene scene = load_builtin("stack");
  constexpr double kTop = 2.49, kLargest = 3.5;
  int seen = 0;
  double farthest = 0.0;
  Viewer(960, 540).see(scene, scene.cameras.front(), [&](const glm::vec3& position, const glm::vec3& normal, auto) {
    const double height = static_cast<double>(position.y) - kTop;
    if (normal.y < 0.999f || std::abs(height) > 0.01) return;
    ++seen;
    farthest = std::max(farthest, std::abs(height));
  });
  EXPECT_GT(seen, 200);
  EXPECT_LE(farthest, 10.0 * 0x1p-24 * kLargest);  // 8 roundings of the position, and what its corners were rounded by
}

TEST(ReceiverPosition, EveryReceiver_LiesWhereItsPixelLooks) {
  const scene::Scene scene = load_builtin("stack");
  const glm::vec2 size(960.0f, 540.0f);
  const glm::dmat4 clip(render::clip_from_world(scene.cameras.front(), scene.bounds(), 960.0 / 540.0));
  double farthest = 0.0;
  Viewer(960, 540).see(scene, scene.cameras.front(), [&](const glm::vec3& position, auto, const glm::ivec2& pixel) {
    const glm::dvec4 place = clip * glm::dvec4(position, 1.0);
    const glm::dvec2 at = glm::dvec2(0.5 + 0.5 * place.x / place.w, 0.5 - 0.5 * place.y / place.w) * glm::dvec2(size);
    farthest = std::max(farthest, glm::distance(at, glm::dvec2(pixel) + 0.5));
  });
  EXPECT_LT(farthest, 1.0 / 64.0);
}

TEST(ReceiverPosition, SurfacesThatMeetInAValley_HaveNoPointBeyondEachOther) {
  int seen = 0, beyond = 0;
  look_around(make_valley(), -1.0f, 1.0f, [&](const glm::vec3& position, const glm::vec3& normal, auto) {
    ++seen;
    if (normal.y > 0.5f ? position.z <= 0.0f : position.y <= 0.0f) ++beyond;
  });
  EXPECT_GT(seen, 100000);
  EXPECT_EQ(beyond, 0);
}

/// They are seen where edges that meet were moved apart.
TEST(ReceiverPosition, BackFacesOfABox_AreSeenOutsideOfIt) {
  int seen = 0, inside = 0;
  const scene::Scene box = scene::make_scene_of({scene::make_box(glm::vec3(2.0f * kHalfSide), 16)});
  look_around(box, 0.0f, glm::two_pi<float>(), [&](const glm::vec3& position, const glm::vec3& normal, auto) {
    if (glm::dot(position, normal) > 0.0f) return;
    ++seen;
    const glm::vec3 size = glm::abs(position);
    if (std::max({size.x, size.y, size.z}) <= kHalfSide) ++inside;
  });
  EXPECT_GT(seen, 0);
  EXPECT_EQ(inside, 0);
}

/// A floor of some kilometres, a box before the camera, and two walls at its end of which the nearer is seen.
TEST(ReceiverPosition, WideScenes_ShowWhatIsNearAndWhatIsFar) {
  constexpr float kNear = 0.3f;
  for (const float size : {100.0f, 1e3f, 20e3f, 100e3f}) {
    const float far = 0.45f * size;
    const scene::Mesh wall = scene::make_box({0.1f * size, 0.1f * size, 1e-4f * size}, 1);
    const scene::Camera camera = scene::make_camera({0.0f, 1.5f, 0.0f}, {0.0f, 0.0f, -1.0f});
    const scene::Scene scene = scene::make_scene_of(
        {scene::make_plane(glm::vec2(size), 16),
         scene::move_mesh(scene::make_box(glm::vec3(0.1f), 1), {0.1, 1.5, -kNear}),
         scene::move_mesh(wall, {0.0, 0.0, -1.01f * far}), scene::move_mesh(wall, {0.0, 0.0, -far})},
        scene::Sun{.direction_ws = camera.forward_ws});
    int near = 0, at_wall = 0, behind_wall = 0;
    Viewer(240, 135).see(scene, camera, [&](const glm::vec3& position, const glm::vec3&, auto) {
      if (position.z > -2.0f * kNear) ++near;
      if (std::abs(position.z + far) < 1e-3f * size) ++at_wall;
      if (std::abs(position.z + 1.01f * far) < 1e-3f * size) ++behind_wall;
    });
    EXPECT_GT(near, 500) << size;
    EXPECT_GT(at_wall, 500) << size;
    EXPECT_EQ(behind_wall, 0) << size;
  }
}

TEST(ReceiverPosition, RaysOfTheTruth_NeverMeetThePlaneThatTheyLeave) {
  Viewer viewer(960, 540);
  for (const std::string& name : scenes_of_all_lights()) {
    SCOPED_TRACE(name);
    const scene::Scene scene = load_builtin(name);
    const truth::Occluders occluders(scene::list_occluders(scene));
    const truth::AreaLight light = scene::make_area_light(scene.light);
    int seen = 0, met = 0;
    viewer.see(scene, scene.cameras.front(), [&](const glm::vec3& position, const glm::vec3& normal, auto) {
      ++seen;
      const glm::vec3 origin = occluders.offset_origin(position, normal);
      const glm::vec3 way = light.centre_direction(glm::dvec3(origin));
      truth::RayPacket ray;
      ray.set(0, origin, way, light.reach());
      const truth::PacketHits hits = occluders.find_nearest(ray);
      const bool is_near = hits.distances[0] * glm::length(way) < 100.0f * glm::distance(origin, position);
      if (is_near && std::abs(glm::dot(glm::normalize(hits.normal(0)), normal)) > 0.9999f) ++met;
    });
    EXPECT_GT(seen, 100000);
    EXPECT_EQ(met, 0);
  }
}

TEST(GBufferWindow, HoldsThatPartOfTheWholePicture) {
  gl::Context& context = shared_context();
  render::ShaderLibrary shaders(options::find_resources().shaders);
  const scene::Scene scene = load_builtin("stack");
  const scene::Camera& camera = scene.cameras.front();
  const render::Geometry geometry(scene);
  constexpr int kWidth = 96, kHeight = 54, kX = 40, kY = 12, kPartWidth = 31, kPartHeight = 17;
  render::GBuffer whole(kWidth, kHeight), part(kPartWidth, kPartHeight);
  whole.draw(shaders, geometry, scene, camera);
  part.draw(shaders, geometry, scene, camera, {}, render::PictureWindow{{kX, kY}, {kWidth, kHeight}});
  const images::Image all = render::read_image(whole.position(), 4), own = render::read_image(part.position(), 4);
  int surfaces = 0;
  for (int y = 0; y < kPartHeight; ++y) {
    for (int x = 0; x < kPartWidth; ++x) {
      const float *a = own.at(x, y), *b = all.at(kX + x, kHeight - kY - kPartHeight + y);
      surfaces += a[3] != 0.0f;
      for (int c = 0; c < 4; ++c) ASSERT_NEAR(a[c], b[c], 1e-4f) << x << ", " << y;
    }
  }
  EXPECT_GT(surfaces, kPartWidth * kPartHeight / 2);
  context.require_no_gl_errors();
}

}  // namespace
}  // namespace shadowbench::test
