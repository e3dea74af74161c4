// What the GL computes of a receiver in a curved map is what the frustum says in double.

#include <cmath>

#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kShapeMap = 1024;

class CurvedMap : public ::testing::TestWithParam<std::string> {};

/// How a receiver's depth changes along its plane with one texel of u and of v, by steps on the plane.
glm::dvec2 step_on_plane(const scene::LightFrustum& frustum, const filters::Receiver& r) {
  const glm::dvec3 normal(r.normal_ws), position(r.position_ws);
  const glm::dvec3 side = glm::normalize(glm::cross(normal, glm::dvec3(0.6, 0.37, 0.71)));
  const double step = 1e-4 * static_cast<double>(r.texel_size_ws);
  glm::dmat2 texels;
  glm::dvec2 depths;
  for (int i = 0; i < 2; ++i) {
    const glm::dvec3 way = step * (i == 0 ? side : glm::cross(normal, side));
    const glm::dvec3 change = frustum.place(position + way, kShapeMap) - frustum.place(position - way, kShapeMap);
    texels[i] = glm::dvec2(change);
    depths[i] = change.z;
  }
  return depths * glm::inverse(texels);
}

TEST_P(CurvedMap, ReceiversLieWhereTheFrustumSays) {
  const scene::Scene scene = load_builtin(GetParam());
  Bench bench(shared_context(), scene, kShapeMap);
  double worst_texel = 0.0, worst_depth = 0.0, worst_size = 0.0, worst_plane = 0.0;
  int compared = 0, steep = 0;
  for (const filters::Receiver& r : bench.receivers(catalogue().parse_requests("none").front())) {
    if (r.layer_share == 0.0f) continue;
    const scene::LightFrustum& frustum = bench.layers()[static_cast<std::size_t>(r.layer)];
    const glm::dvec3 place = frustum.place(glm::dvec3(r.position_ws), kShapeMap);
    const double size = static_cast<double>(r.texel_size_ws), own = frustum.texel_size_at(glm::dvec3(r.position_ws));
    worst_texel = std::max(worst_texel, glm::distance(glm::dvec2(place), glm::dvec2(r.uv) * double{kShapeMap}));
    worst_depth = std::max(worst_depth, std::abs(place.z - static_cast<double>(r.depth_unbiased)));
    worst_size = std::max(worst_size, std::abs(size / own - 1.0));
    ++compared;
    if (r.n_dot_l < 0.05f) continue;  // rounding of the normal outweighs the slope
    const glm::dvec2 slope = step_on_plane(frustum, r);
    worst_plane = std::max(worst_plane, glm::distance(slope, glm::dvec2(r.depth_per_texel)) / glm::length(slope));
    ++steep;
  }
  std::printf("%s: %d receivers, %d with slopes; texels %.2g, depth %.2g, size %.2g, slope %.2g\n", GetParam().c_str(),
              compared, steep, worst_texel, worst_depth, worst_size, worst_plane);
  EXPECT_GT(steep, 10000);
  EXPECT_LT(worst_texel, 1e-3);
  EXPECT_LT(worst_depth, 1e-6);
  EXPECT_LT(worst_size, 1e-4);
  EXPECT_LT(worst_plane, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Shapes, CurvedMap,
                         ::testing::Values("avenue_by_focused", "avenue_by_lispsm", "avenue_by_psm", "avenue_by_tsm",
                                           "avenue_by_logpsm", "lantern_by_paraboloid"),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace shadowbench::test
