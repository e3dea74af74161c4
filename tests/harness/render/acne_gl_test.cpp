// The default bias against rays that are traced here, in double and by brute force: no code in common with the GL.

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 135;

struct Triangle {
  glm::dvec3 corner, edge1, edge2;
};

std::vector<Triangle> casters_of(const scene::Scene& scene) {
  std::vector<Triangle> triangles;
  for (const scene::Mesh& mesh : scene.meshes) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
      const glm::dvec3 a(mesh.vertices[mesh.indices[i]].position_ws);
      triangles.push_back({a, glm::dvec3(mesh.vertices[mesh.indices[i + 1]].position_ws) - a,
                           glm::dvec3(mesh.vertices[mesh.indices[i + 2]].position_ws) - a});
    }
  }
  return triangles;
}

/// Moller and Trumbore 1997, Fast, Minimum Storage Ray/Triangle Intersection.
bool hits(const Triangle& t, const glm::dvec3& origin, const glm::dvec3& direction, double reach) {
  const glm::dvec3 p = glm::cross(direction, t.edge2);
  const double determinant = glm::dot(t.edge1, p);
  if (std::abs(determinant) < 1e-14) return false;
  const glm::dvec3 s = origin - t.corner;
  const double u = glm::dot(s, p) / determinant;
  if (u < 0.0 || u > 1.0) return false;
  const glm::dvec3 q = glm::cross(s, t.edge1);
  const double v = glm::dot(direction, q) / determinant;
  const double distance = glm::dot(t.edge2, q) / determinant;
  return v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance < reach;
}

/// Which receivers see the light's centre; 1 lit, 0 blocked, -1 no receiver.
std::vector<int> trace(Bench& bench, const scene::Scene& scene, const std::vector<filters::Receiver>& receivers) {
  const std::vector<Triangle> casters = casters_of(scene);
  std::vector<int> lit(static_cast<std::size_t>(kWidth * kHeight), -1);
  for (const filters::Receiver& r : receivers) {
    const glm::dvec3 origin = glm::dvec3(r.position_ws) + 1e-4 * glm::dvec3(r.normal_ws);
    const glm::dvec3 to_light = bench.frustum().to_light(origin);
    const auto& lamp = bench.frustum().perspective;
    const double reach = lamp ? glm::distance(lamp->beam.position_ws, origin) : std::numeric_limits<double>::infinity();
    const bool blocked = std::any_of(casters.begin(), casters.end(),
                                     [&](const Triangle& t) { return hits(t, origin, to_light, reach); });
    lit[bench.index(r)] = blocked ? 0 : 1;
  }
  return lit;
}

/// True where all pixels within `reach` agree with this one, so that no shadow's edge is near.
bool is_interior(const std::vector<int>& lit, int x, int y, int reach) {
  const auto at = [&](int px, int py) { return lit[static_cast<std::size_t>(py * kWidth + px)]; };
  if (x < reach || y < reach || x + reach >= kWidth || y + reach >= kHeight) return false;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx)
      if (at(x + dx, y + dy) != at(x, y)) return false;
  }
  return true;
}

struct Rates {
  double acne = 0.0;  ///< of the lit interior that is under 0.9
  double gap = 0.0;   ///< of the blocked interior that is over 0.5
  int lit = 0;
  int blocked = 0;
};

Rates compare(const std::vector<float>& image, const std::vector<int>& lit) {
  Rates rates;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const auto i = static_cast<std::size_t>(y * kWidth + x);
      if (lit[i] < 0 || !is_interior(lit, x, y, 3)) continue;
      (lit[i] == 1 ? rates.lit : rates.blocked) += 1;
      if (lit[i] == 1 && image[i] < 0.9f) rates.acne += 1.0;
      if (lit[i] == 0 && image[i] > 0.5f) rates.gap += 1.0;
    }
  }
  rates.acne /= std::max(rates.lit, 1);
  rates.gap /= std::max(rates.blocked, 1);
  return rates;
}

/// A scene drawn, and traced unless somebody has: what rays find does not depend on the map.
struct Traced {
  scene::Scene scene;
  Bench bench;
  std::vector<int> lit;

  explicit Traced(const std::string& name, const render::MapSettings& map = {}, const std::vector<int>& traced = {},
                  int map_size = 1024)
      : scene(load_builtin(name)),
        bench(shared_context(), scene, map_size, kWidth, kHeight, map),
        lit(traced.empty() ? trace(bench, scene, bench.receivers(catalogue().parse_requests("none").front()))
                           : traced) {}

  Rates measure(const std::string& filter, const render::BiasRule& rule) {
    return compare(bench.draw(catalogue().parse_requests(filter).front(), rule), lit);
  }
};

class DefaultBias : public ::testing::TestWithParam<std::string> {};

TEST_P(DefaultBias, LeavesNoVisibleAcne) {
  Traced traced(GetParam());
  for (const std::string& filter : filter_ids()) {
    const Rates rates = traced.measure(filter, {});
    std::printf("%s %s: acne %.5f of %d, gap %.5f of %d\n", GetParam().c_str(), filter.c_str(), rates.acne, rates.lit,
                rates.gap, rates.blocked);
    ASSERT_GT(rates.lit, 2000);
    // A paraboloid bends the planes of its casters: filters as wide as vssm see that.
    EXPECT_LE(rates.acne, fit_of(traced.scene) == scene::FitMode::kParaboloid ? 0.004 : 0.001) << filter;
    EXPECT_LE(rates.gap, 0.05) << filter;
  }
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, DefaultBias, ::testing::ValuesIn(scenes_of_all_maps()),
                         [](const auto& each) { return each.param; });

/// The default bias covers half a step of the coarsest format.
TEST(DefaultBias, LeavesNoVisibleAcne_InAnyFormat) {
  std::vector<int> lit;
  for (const GLenum format : {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT32F}) {
    for (const bool reversed : {false, true}) {
      Traced traced("ball", {format, {reversed}}, lit, 512);
      lit = traced.lit;
      for (const std::string& filter : filter_ids()) {
        const Rates rates = traced.measure(filter, {});
        std::printf("%s %s: acne %.5f of %d, gap %.5f\n", render::describe_map({format, {reversed}}).c_str(),
                    filter.c_str(), rates.acne, rates.lit, rates.gap);
        EXPECT_LE(rates.acne, 0.001) << filter;
        EXPECT_LE(rates.gap, 0.05) << filter;
      }
    }
  }
}

/// Perspective depth spends nearly all of a float on the first metres; stored reversed, the float gives them back.
TEST(PerspectiveDepth, AtAMillion_GivesAcneThatReversedFloatsDoNot) {
  const auto acne = [](const render::MapSettings& map) { return Traced("steps", map).measure("none", {}).acne; };
  EXPECT_GT(acne({GL_DEPTH_COMPONENT32F, {false, 1e6}}), 0.02);
  EXPECT_GT(acne({GL_DEPTH_COMPONENT24, {true, 1e6}}), 0.02) << "fixed-point steps are the same either way round";
  EXPECT_LE(acne({GL_DEPTH_COMPONENT32F, {true, 1e6}}), 0.001);
}

TEST(NoBias, GivesAcne) { EXPECT_GT(Traced("steps").measure("none", render::BiasRule::none()).acne, 0.05); }

}  // namespace
}  // namespace shadowbench::test
