#include "harness/scene/scene.h"
#include "tests/harness/render/bench_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

// The traced scene is the drawn scene: as many triangles, the same bounds, and rays along the light hit what the depth
// map holds, texel by texel.

constexpr int kMapTexels = 256;

class Geometry : public ::testing::TestWithParam<std::string> {};

TEST_P(Geometry, HasTheSameTrianglesAndBounds) {
  const scene::Scene scene = load_builtin(GetParam());
  const truth::Occluders occluders(scene::list_occluders(scene));
  std::int64_t casting = 0;
  scene::Bounds bounds;
  for (const scene::Mesh& mesh : scene.meshes) {
    if (!mesh.casts_shadow) continue;
    casting += static_cast<std::int64_t>(mesh.indices.size() / 3);
    for (const std::uint32_t i : mesh.indices) bounds.add(mesh.vertices[i].position_ws);
  }
  EXPECT_GT(casting, 0);
  EXPECT_EQ(occluders.triangle_count(), casting);
  EXPECT_EQ(occluders.bounds().min, bounds.min);
  EXPECT_EQ(occluders.bounds().max, bounds.max);
}

/// Of a projection, depth included.
glm::dvec3 find_by_plane(const scene::LightFrustum& frustum, const glm::dvec2& clip, double depth) {
  const glm::dmat4 world_from_clip = glm::inverse(frustum.clip_from_light * frustum.light_from_world);
  const glm::dvec4 point = world_from_clip * glm::dvec4(clip, depth, 1.0);
  return glm::dvec3(point) / point.w;
}

/// Of a projection of u and v alone: (u w, v w, depth, w) is a point for the w that makes it one.
glm::dvec3 find_by_warp(const scene::LightFrustum& frustum, const glm::dvec2& clip, double depth) {
  const glm::dmat4 world_from_map = glm::inverse(frustum.clip_from_light * frustum.light_from_world);
  const glm::dvec4 by_w = world_from_map * glm::dvec4(clip, 0.0, 1.0), by_depth = world_from_map[2] * depth;
  return glm::dvec3(by_w * ((1.0 - by_depth.w) / by_w.w) + by_depth);
}

/// Where v is known as w, any v of the projection will do: the point slides along it to where w is right.
glm::dvec3 find_by_logarithm(const scene::LightFrustum& frustum, const glm::dvec2& clip, double depth) {
  const auto w_of = [&](const glm::dvec3& p) {
    return (frustum.clip_from_light * frustum.light_from_world * glm::dvec4(p, 1.0)).w;
  };
  const double w = std::exp((0.5 + 0.5 * clip.y - frustum.log_curve.offset) / frustum.log_curve.scale);
  const glm::dvec3 a = find_by_warp(frustum, {clip.x, 0.0}, depth), b = find_by_warp(frustum, {clip.x, 0.5}, depth);
  return a + (b - a) * ((w - w_of(a)) / (w_of(b) - w_of(a)));
}

glm::dvec3 find_by_paraboloid(const scene::LightFrustum& frustum, const glm::dvec2& clip, double depth) {
  const glm::dvec2 q = (0.5 + 0.5 * clip - frustum.paraboloid.center) / frustum.paraboloid.radius;
  const glm::dvec3 seen = glm::dvec3(2.0 * q, glm::dot(q, q) - 1.0) / (1.0 + glm::dot(q, q));
  const glm::dvec3 way = glm::transpose(glm::dmat3(frustum.light_from_world)) * seen;
  const scene::PerspectiveMap& map = *frustum.perspective;
  return map.beam.position_ws + way * (map.near_m + depth * frustum.depth_range_ws);
}

/// Depth along the light through a point of the map, in [0,1]; infinity where nothing is hit.
class DepthRays {
 public:
  DepthRays(const truth::Occluders& occluders, const scene::LightFrustum& frustum)
      : occluders_(occluders), frustum_(frustum) {}

  double at(double x, double y) const {
    const glm::dvec3 start = find_point(x, y, 0.0);
    truth::RayPacket packet;
    packet.set(0, glm::vec3(start), glm::vec3(find_point(x, y, 1.0) - start));
    const double hit = static_cast<double>(occluders_.find_nearest(packet).distances[0]);
    return hit <= 1.0 ? hit : std::numeric_limits<double>::infinity();
  }

  /// Is anything within a hundredth of a texel as deep as this?
  bool matches_nearby(double x, double y, double depth, double tolerance) const {
    for (int i = 0; i < 9; ++i) {
      const double hit = at(x + 0.01 * (i % 3 - 1), y + 0.01 * (i / 3 - 1));
      if (std::isinf(hit) ? depth == 1.0 : std::abs(hit - depth) <= tolerance) return true;
    }
    return false;
  }

 private:
  const truth::Occluders& occluders_;
  const scene::LightFrustum& frustum_;

  glm::dvec3 find_point(double x, double y, double depth) const {
    const glm::dvec2 clip(2.0 * x / kMapTexels - 1.0, 2.0 * y / kMapTexels - 1.0);
    switch (frustum_.shape) {
      case scene::MapShape::kPlane: return find_by_plane(frustum_, clip, depth);
      case scene::MapShape::kWarped: return find_by_warp(frustum_, clip, depth);
      case scene::MapShape::kLogarithmic: return find_by_logarithm(frustum_, clip, depth);
      case scene::MapShape::kParaboloid: return find_by_paraboloid(frustum_, clip, depth);
    }
    return {};
  }
};

TEST_P(Geometry, RaysHitWhatTheDepthMapSees) {
  constexpr int kSize = kMapTexels;
  const scene::Scene scene = load_builtin(GetParam());
  Bench bench(scene, kSize, 64, 36);
  const truth::Occluders occluders(scene::list_occluders(scene));
  // Between the corners of a triangle a paraboloid's edges are straight and its depth is linear, where neither should
  // be.
  const bool is_exact = fit_of(scene) != scene::FitMode::kParaboloid;
  int seen = 0, different = 0;
  for (const scene::LightFrustum& layer : bench.layers()) {
    const filters::DepthMap map = bench.map().read(layer.layer);
    const DepthRays rays(occluders, layer);
    for (int i = 0; i < kSize * kSize; ++i) {
      const double depth = map.curve.linear(static_cast<double>(map.stored[static_cast<std::size_t>(i)]));
      seen += depth < 1.0 ? 1 : 0;
      // Steep faces gain this depth within a hundredth of a texel; rasterisers snap vertices to fractions of one.
      if (!rays.matches_nearby(i % kSize + 0.5, i / kSize + 0.5, depth, is_exact ? 5e-5 : 2e-3)) ++different;
    }
  }
  EXPECT_GT(seen, 5000);
  // A map through the camera's own perspective stretches one far texel beyond what single precision places.
  EXPECT_LE(different, !is_exact ? seen / 40 : fit_of(scene) == scene::FitMode::kPsm ? 2 : 0);
}

std::vector<std::string> list_fits() {
  std::vector<std::string> names = scenes_of_all_maps();
  names.insert(names.end(), {"avenue_by_focused", "avenue_by_psm", "avenue_by_tsm"});
  return names;
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, Geometry, ::testing::ValuesIn(list_fits()),
                         [](const auto& test) { return test.param; });

// The real models that SHADOWBENCH_SCENES names: they load, draw, and have both light and shadow.

std::vector<std::filesystem::path> real_scenes() {
  std::vector<std::filesystem::path> files;
  const char* folder = std::getenv("SHADOWBENCH_SCENES");
  if (!folder) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".gltf" || extension == ".glb" || extension == ".obj") files.push_back(entry.path());
  }
  return files;
}

TEST(RealScenes, LoadAndDraw_WithLightAndShadow) {
  const auto files = real_scenes();
  if (files.empty()) GTEST_SKIP() << "SHADOWBENCH_SCENES names no folder with models";
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename().string());
    const scene::Scene scene =
        scene::load(file.string(), {.scenes_folder = options::find_resources().scenes, .ground = true});
    Bench bench(scene, 512, 240, 135);
    const auto request = request_of("pcf2x2");
    const std::vector<float> image = bench.draw(request);
    const auto receivers = bench.receivers(request);
    double lit = 0.0;
    for (const auto& r : receivers) {
      ASSERT_TRUE(std::isfinite(image[bench.index(r)]));
      lit += static_cast<double>(image[bench.index(r)]);
    }
    EXPECT_GT(receivers.size(), 3000u);
    EXPECT_GT(lit, 0.05 * static_cast<double>(receivers.size()));
    EXPECT_LT(lit, 0.995 * static_cast<double>(receivers.size()));
  }
}

}  // namespace
}  // namespace shadowbench::test
