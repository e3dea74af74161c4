// What the bias modes put into the depth map: back faces, midpoints, offsets.

#include <cmath>

#include "harness/scene/mesh_tools.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

scene::Mesh make_quad(float half, float height) {
  scene::Mesh mesh;
  for (const glm::vec2 p :
       {glm::vec2(-half, -half), glm::vec2(half, -half), glm::vec2(-half, half), glm::vec2(half, half)})
    mesh.vertices.push_back({{p.x, height, p.y}, {0, 1, 0}, {0, 0}});
  mesh.indices = {0, 2, 1, 1, 2, 3};  // seen from above, anticlockwise
  return mesh;
}

/// A box from two quads and four sides, faces outwards.
scene::Mesh make_box(float half, float bottom, float top) {
  scene::Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        {{(i & 1) ? half : -half, (i & 2) ? top : bottom, (i & 4) ? half : -half}, {0, 1, 0}, {0, 0}});
  }
  mesh.indices = {2, 6, 3, 3, 6, 7, 0, 1, 4, 4, 1, 5, 0, 4, 2, 2, 4, 6,
                  1, 3, 5, 5, 3, 7, 0, 2, 1, 1, 2, 3, 4, 5, 6, 6, 5, 7};
  return mesh;
}

/// A box from 1 to 2 m above a floor, under a sun at the zenith.
scene::Scene make_scene() {
  scene::Scene scene;
  scene.materials.emplace_back();
  scene.meshes = {make_quad(4.0f, 0.0f), make_box(1.0f, 1.0f, 2.0f)};
  scene.light.kind = scene::Sun{{0.0f, -1.0f, 0.0f}};
  scene.cameras = {look_down({0.0f, 6.0f, 0.1f})};
  return scene;
}

/// Height above the floor of what the map holds in the middle (x = 0) or over bare floor (x = 3 m).
double height_in_map(Bench& bench, double x) {
  const filters::DepthMap map = bench.map().read();
  const scene::LightFrustum& frustum = bench.frustum();
  const glm::vec4 uv = frustum.uv_depth_from_world * glm::vec4(static_cast<float>(x), 0.0f, 0.3f, 1.0f);
  const auto column = static_cast<std::size_t>(uv.x * static_cast<float>(map.size)),
             row = static_cast<std::size_t>(uv.y * static_cast<float>(map.size));
  const double depth =
      static_cast<double>(map.curve.linear(map.stored[row * static_cast<std::size_t>(map.size) + column]));
  return (static_cast<double>(uv.z) - depth) * frustum.depth_range_ws;
}

TEST(MapBias, FrontCull_KeepsBackFaces_AndWhatMayNotBeCulled) {
  scene::Scene scene = make_scene();
  {
    Bench bench(shared_context(), scene, 128, 16, 16);
    EXPECT_NEAR(height_in_map(bench, 0.0), 2.0, 1e-4);
    bench.redraw({.cull_front = true});
    EXPECT_NEAR(height_in_map(bench, 0.0), 1.0, 1e-4);
    EXPECT_LT(height_in_map(bench, 3.0), -1e-4) << "an open floor vanishes";
  }
  scene.meshes[0].may_cull_front = false;
  Bench bench(shared_context(), scene, 128, 16, 16);
  bench.redraw({.cull_front = true});
  EXPECT_NEAR(height_in_map(bench, 0.0), 1.0, 1e-4);
  EXPECT_NEAR(height_in_map(bench, 3.0), 0.0, 1e-4);
}

TEST(MapBias, Midpoint_LiesBetweenFirstAndSecondSurface) {
  const scene::Scene scene = make_scene();
  for (const filters::DepthCurve& curve : {filters::DepthCurve{}, filters::DepthCurve{true},
                                           filters::DepthCurve{false, 20.0}, filters::DepthCurve{true, 20.0}}) {
    SCOPED_TRACE(render::describe_map({GL_DEPTH_COMPONENT32F, curve}));
    Bench bench(shared_context(), scene, 128, 16, 16, {GL_DEPTH_COMPONENT32F, curve});
    bench.redraw({.midpoint = true});
    EXPECT_NEAR(height_in_map(bench, 0.0), 1.5, 1e-4);
    // No second surface below the floor: half-way to depth 1.
    const scene::LightFrustum& frustum = bench.frustum();
    const double floor = static_cast<double>((frustum.uv_depth_from_world * glm::vec4(3.0f, 0.0f, 0.3f, 1.0f)).z);
    EXPECT_NEAR(height_in_map(bench, 3.0), -0.5 * (1.0 - floor) * frustum.depth_range_ws, 1e-4);
    bench.redraw({});
    EXPECT_NEAR(height_in_map(bench, 0.0), 2.0, 1e-4) << "the next map is an ordinary one";
  }
}

TEST(MapBias, PolygonOffset_MovesByFactorTimesSlope_AndUnitsOfTheFormat) {
  scene::Scene scene = make_scene();
  scene.light.kind = scene::Sun{glm::normalize(glm::vec3(-1.0f, -1.0f, 0.0f))};
  Bench bench(shared_context(), scene, 128, 16, 16);
  const double plain = height_in_map(bench, 3.0);
  const filters::Receiver r =
      bench.receivers(catalogue().parse_requests("none").front(), render::BiasRule::none()).front();
  const double slope =
      std::max(std::abs(static_cast<double>(r.depth_per_texel.x)), std::abs(static_cast<double>(r.depth_per_texel.y)));
  bench.redraw({.polygon_factor = 2.0});
  EXPECT_NEAR(plain - height_in_map(bench, 3.0), 2.0 * slope * bench.frustum().depth_range_ws,
              0.02 * slope * bench.frustum().depth_range_ws);
  // D32F: r is 2^(e - 23), e the exponent of the primitive's largest depth, which lies in [0.5, 1).
  bench.redraw({.polygon_units = 4096.0});
  EXPECT_NEAR(plain - height_in_map(bench, 3.0), 4096.0 * 0x1p-24 * bench.frustum().depth_range_ws,
              1e-5 * bench.frustum().depth_range_ws);
}

/// A wall on a floor, as thin as paper, under a sun that is `tilt` away from the zenith; seen from above.
scene::Scene make_wall(double tilt) {
  scene::Scene scene;
  scene.materials.emplace_back();
  scene::Mesh wall;
  for (const glm::vec2 p : {glm::vec2(-2, 0), glm::vec2(2, 0), glm::vec2(-2, 3), glm::vec2(2, 3)})
    wall.vertices.push_back({{0.0f, p.y, p.x}, {1, 0, 0}, {0, 0}});
  wall.indices = {0, 1, 2, 2, 1, 3};
  scene.meshes = {make_quad(4.0f, 0.0f), wall};
  scene.light.kind = scene::Sun{glm::vec3(-std::sin(tilt), -std::cos(tilt), 0.0)};
  scene::Camera camera;
  camera.position_ws = {-0.5f, 6.0f, 0.0f};
  camera.forward_ws = {0, -1, 0};
  camera.up_ws = {0, 0, -1};
  camera.orthographic_height_m = 1.1f;
  scene.cameras = {camera};
  return scene;
}

/// A depth bias b, along the light, lights a strip of b sin(tilt) behind a wall that stands on the floor.
TEST(ContactGap, IsTheBiasTimesTheSineOfTheTilt_WithinATexel) {
  for (const double tilt_deg : {20.0, 45.0, 70.0}) {
    const double tilt = glm::radians(tilt_deg);
    const scene::Scene scene = make_wall(tilt);
    Bench bench(shared_context(), scene, 1024, 960, 540);
    const filters::FilterRequest request = catalogue().parse_requests("none").front();
    for (const double bias_m : {0.1, 0.3, 0.6}) {
      render::BiasRule rule = render::BiasRule::none();
      rule.constant.world = bias_m;
      const std::vector<float> image = bench.draw(request, rule);
      double gap = 0.0;
      for (const filters::Receiver& r : bench.receivers(request, rule)) {
        const double behind = -static_cast<double>(r.position_ws.x);
        if (behind > 0.0 && behind < 1.0 && r.position_ws.y < 1e-3f && image[bench.index(r)] == 1.0f)
          gap = std::max(gap, behind);
      }
      const double texel_on_floor = bench.frustum().texel_size_ws / std::cos(tilt);
      EXPECT_NEAR(gap, bias_m * std::sin(tilt), texel_on_floor) << tilt_deg << " degrees, bias " << bias_m;
    }
  }
}

TEST(ClosedMesh, IsOneThatEnclosesAVolume) {
  EXPECT_TRUE(scene::is_closed(make_box(1.0f, 0.0f, 1.0f)));
  EXPECT_FALSE(scene::is_closed(make_quad(1.0f, 0.0f)));
  scene::Mesh torn = make_box(1.0f, 0.0f, 1.0f);
  torn.indices.resize(torn.indices.size() - 3);
  EXPECT_FALSE(scene::is_closed(torn));
  scene::Mesh turned = make_box(1.0f, 0.0f, 1.0f);
  std::swap(turned.indices[0], turned.indices[1]);
  EXPECT_FALSE(scene::is_closed(turned)) << "one face looks inwards";
  EXPECT_FALSE(scene::is_closed(scene::Mesh()));
}

TEST(ClosedMesh, BuiltInBoxesAndSpheresAre_PlanesAreNot) {
  for (const std::string& name : builtin_scenes()) {
    for (const scene::Mesh& mesh : load_builtin(name).meshes) {
      const bool is_plane = mesh.name == "floor" || mesh.name == "ground" || mesh.name == "paving";
      EXPECT_EQ(scene::is_closed(mesh), !is_plane) << name << " " << mesh.name;
    }
  }
}

}  // namespace
}  // namespace shadowbench::test
