// Depth maps of every format, drawn by the GL through a perspective projection: planes at known distances keep the
// precision that the format and the depth's curve allow.

#include <cmath>

#include "filters/depth_map.h"
#include "harness/scene/mesh_tools.h"
#include "tests/filters/perspective_depth.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kSize = 16;

/// Looks along -z, so that light space is world space; a right angle wide.
scene::LightFrustum make_perspective(const filters::DepthPlanes& planes) {
  const double n = planes.near_m, f = planes.far_m;
  scene::LightFrustum frustum;
  frustum.clip_from_light = glm::dmat4(0.0);
  frustum.clip_from_light[0][0] = frustum.clip_from_light[1][1] = 1.0;
  frustum.clip_from_light[2][2] = -f / (f - n);
  frustum.clip_from_light[3][2] = -n * f / (f - n);
  frustum.clip_from_light[2][3] = -1.0;
  frustum.clip_from_world = glm::mat4(frustum.clip_from_light);
  return frustum;
}

/// A wall across the view at a distance.
scene::Scene make_wall(float distance_m) {
  scene::Scene scene;
  scene::Mesh wall;
  const float half = 1.5f * distance_m;
  for (const glm::vec2& corner :
       {glm::vec2(-half, -half), glm::vec2(half, -half), glm::vec2(half, half), glm::vec2(-half, half)})
    wall.vertices.push_back({{corner.x, corner.y, -distance_m}, {0.0f, 0.0f, 1.0f}, {}});
  wall.indices = {0, 1, 2, 0, 2, 3};
  scene.meshes.push_back(wall);
  scene.materials.emplace_back();
  return scene;
}

/// The largest |distance read from the map less the wall's| over the map.
double measure_error(render::ShaderLibrary& shaders, render::ShadowMap& map, const filters::DepthPlanes& planes,
                     double distance_m) {
  const auto distance = static_cast<float>(distance_m);
  const scene::Scene scene = make_wall(distance);
  map.draw(shaders, render::Geometry(scene), make_perspective(planes));
  double worst = 0.0;
  for (const float stored : map.texture().read_floats(1)) {
    const double seen = filters::distance_of_depth(static_cast<double>(stored), planes, map.settings().curve.reversed);
    worst = std::max(worst, std::abs(seen - static_cast<double>(distance)));
  }
  return worst;
}

struct Case {
  GLenum format;
  filters::DepthFormat description;
  bool reversed;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {GL_DEPTH_COMPONENT16, {16, false}, false}, {GL_DEPTH_COMPONENT16, {16, false}, true},
      {GL_DEPTH_COMPONENT24, {24, false}, false}, {GL_DEPTH_COMPONENT24, {24, false}, true},
      {GL_DEPTH_COMPONENT32F, {}, false},         {GL_DEPTH_COMPONENT32F, {}, true}};
  return all;
}

/// Distances from twice the near plane to half the far plane, evenly in logarithms.
std::vector<double> spread_distances(const filters::DepthPlanes& planes) {
  std::vector<double> distances;
  constexpr int kCount = 24;
  for (int i = 0; i < kCount; ++i) {
    distances.push_back(2.0 * planes.near_m *
                        std::pow(0.25 * planes.far_m / planes.near_m, static_cast<double>(i) / (kCount - 1)));
  }
  return distances;
}

/// The format's own step, and what single precision makes of clip z and its division before it is stored: the sum
/// a d + b of a projection has the error of its larger term.
double theoretical_error(double d, const filters::DepthPlanes& planes, const Case& c) {
  const double n = planes.near_m, f = planes.far_m;
  const double ulp = std::exp2(-23);
  const double term = c.reversed ? n * f / (f - n) : f * d / (f - n);  // of clip z
  const double slope = d * d * (f - n) / (n * f);                      // of distance over depth
  return filters::distance_step(d, planes, c.description, c.reversed) +
         slope * 2.0 * ulp * (term / d + filters::depth_of_distance(d, planes, c.reversed));
}

TEST(DepthPrecision, EveryFormat_KeepsWhatTheoryAllows) {
  shared_context();
  render::ShaderLibrary shaders(options::find_resources().shaders);
  for (const double ratio : {1e1, 1e2, 1e4, 1e6}) {
    const filters::DepthPlanes planes{0.01, 0.01 * ratio};
    for (const Case& c : cases()) {
      render::ShadowMap map(kSize, {c.format, {c.reversed}});
      double worst = 0.0;
      for (const double d : spread_distances(planes)) {
        const double allowed = theoretical_error(d, planes, c);
        if (allowed > 0.1 * d) continue;  // the curve is not straight over one step
        const double error = measure_error(shaders, map, planes, d);
        EXPECT_LE(error, allowed) << render::describe_map(map.settings()) << " far/near " << ratio << " at " << d;
        worst = std::max(worst, error / d);
      }
      std::printf("far/near %g %s: largest relative error %.2g\n", ratio, render::describe_map(map.settings()).c_str(),
                  worst);
    }
  }
}

/// What reversed depth is for: from end to end, at far/near 10^6, the error is rounding's alone.
TEST(DepthPrecision, ReversedFloatAtAMillion_IsExactToRounding_TheOthersAreNot) {
  shared_context();
  render::ShaderLibrary shaders(options::find_resources().shaders);
  const filters::DepthPlanes planes{0.01, 1e4};
  for (const Case& c : cases()) {
    render::ShadowMap map(kSize, {c.format, {c.reversed}});
    double worst = 0.0;
    for (const double d : spread_distances(planes)) worst = std::max(worst, measure_error(shaders, map, planes, d) / d);
    const std::string name = render::describe_map(map.settings());
    std::printf("%s: %.3g\n", name.c_str(), worst);
    if (c.reversed && c.description.is_float)
      EXPECT_LE(worst, std::exp2(-22)) << name;
    else
      EXPECT_GT(worst, 1e-3) << name;
  }
}

TEST(DepthPrecision, FormatOfOtherBits_IsRefused) {
  EXPECT_NO_THROW(render::require_depth_bits(GL_DEPTH_COMPONENT16, 16));
  try {
    render::require_depth_bits(GL_DEPTH_COMPONENT24, 32);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    EXPECT_NE(std::string(error.what()).find("d24 in 32 bits"), std::string::npos) << error.what();
  }
}

TEST(DepthMapSize, EightThousand_IsDrawnWhole) {
  const scene::Scene scene = load_builtin("cubes");
  Bench bench(shared_context(), scene, 8192, 32, 18, {GL_DEPTH_COMPONENT16});
  EXPECT_EQ(bench.map().bytes(), std::int64_t{8192} * 8192 * 2);
  const filters::DepthMap map = bench.map().read();
  const auto filled = std::count_if(map.stored.begin(), map.stored.end(), [](float d) { return d < 1.0f; });
  EXPECT_GT(static_cast<double>(filled), 0.1 * 8192 * 8192);
}

}  // namespace
}  // namespace shadowbench::test
