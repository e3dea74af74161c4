// The traced scene is the drawn scene: as many triangles, the same bounds, and rays along the light hit what the depth
// map holds, texel by texel.

#include <cmath>

#include "harness/measure/occluders.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kMapTexels = 256;

class Geometry : public ::testing::TestWithParam<std::string> {};

TEST_P(Geometry, HasTheSameTrianglesAndBounds) {
  const scene::Scene scene = load_builtin(GetParam());
  const truth::Occluders occluders(measure::list_occluders(scene));
  std::int64_t casting = 0;
  scene::Bounds bounds;
  for (const scene::Mesh& mesh : scene.meshes) {
    if (!mesh.casts_shadow) continue;
    casting += static_cast<std::int64_t>(mesh.indices.size() / 3);
    for (const std::uint32_t i : mesh.indices) bounds.add(mesh.vertices[i].position_ws);
  }
  EXPECT_GT(casting, 0);
  EXPECT_EQ(occluders.triangle_count() + occluders.degenerate_count(), casting);
  EXPECT_EQ(occluders.bounds().min, bounds.min);
  EXPECT_EQ(occluders.bounds().max, bounds.max);
}

/// Depth along the light through a point of the map, in [0,1]; infinity where nothing is hit.
class DepthRays {
 public:
  DepthRays(const truth::Occluders& occluders, const scene::LightFrustum& frustum)
      : occluders_(occluders), world_from_clip_(glm::inverse(frustum.clip_from_light * frustum.light_from_world)) {}

  double at(double x, double y) const {
    const glm::dvec3 start = find_point(x, y, 0.0);
    truth::RayPacket packet;
    packet.set(0, glm::vec3(start), glm::vec3(find_point(x, y, 1.0) - start));
    const double hit = static_cast<double>(occluders_.find_nearest(packet)[0]);
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
  glm::dmat4 world_from_clip_;

  glm::dvec3 find_point(double x, double y, double depth) const {
    const glm::dvec4 point =
        world_from_clip_ * glm::dvec4(2.0 * x / kMapTexels - 1.0, 2.0 * y / kMapTexels - 1.0, depth, 1.0);
    return glm::dvec3(point) / point.w;
  }
};

TEST_P(Geometry, RaysHitWhatTheDepthMapSees) {
  constexpr int kSize = kMapTexels;
  const scene::Scene scene = load_builtin(GetParam());
  Bench bench(shared_context(), scene, kSize, 64, 36);
  const truth::Occluders occluders(measure::list_occluders(scene));
  int seen = 0, different = 0;
  for (const scene::LightFrustum& layer : bench.layers()) {
    const filters::DepthMap map = bench.map().read(layer.layer);
    const DepthRays rays(occluders, layer);
    for (int i = 0; i < kSize * kSize; ++i) {
      const double depth = map.curve.linear(static_cast<double>(map.stored[static_cast<std::size_t>(i)]));
      seen += depth < 1.0 ? 1 : 0;
      // Steep faces gain this depth within a hundredth of a texel; rasterisers snap vertices to fractions of one.
      if (!rays.matches_nearby(i % kSize + 0.5, i / kSize + 0.5, depth, 5e-5)) ++different;
    }
  }
  std::printf("%s: %d of %zu x %d texels see a caster, %d differ\n", GetParam().c_str(), seen, bench.layers().size(),
              kSize * kSize, different);
  EXPECT_GT(seen, 5000);
  EXPECT_EQ(different, 0);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, Geometry, ::testing::ValuesIn(scenes_of_all_maps()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace shadowbench::test
