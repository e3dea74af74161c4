// The default bias against traced rays.

// Every bias mode on an empty plane, over angles and map sizes: at the amount that theory asks for there is no acne, at
// half of it there is.

// What the bias modes put into the depth map: back faces, midpoints, offsets.

#include <tuple>

#include "harness/measure/view_receivers.h"
#include "harness/render/bias.h"
#include "reference/truth/visibility.h"
#include "tests/harness/render/bench_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

constexpr int kTracedWidth = 240;
constexpr int kTracedHeight = 135;

/// Which receivers see the light's centre; 1 lit, 0 blocked, -1 no receiver.
std::vector<int> trace(Bench& bench, const scene::Scene& scene, const std::vector<filters::Receiver>& receivers) {
  const measure::ViewReceivers view = measure::read_view_receivers(bench.gbuffer(), scene.light);
  const images::Image traced = view.to_image(truth::trace_hard(truth::Occluders(scene::list_occluders(scene)),
                                                               view.image, scene::make_area_light(scene.light)));
  std::vector<int> lit(static_cast<std::size_t>(kTracedWidth * kTracedHeight), -1);
  for (const filters::Receiver& r : receivers)
    lit[bench.index(r)] = traced.texels[measure::find_pixel(r, kTracedWidth, kTracedHeight)] > 0.5f ? 1 : 0;
  return lit;
}

/// True where all pixels within `reach` agree with this one, so that no shadow's edge is near.
bool is_interior(const std::vector<int>& lit, int x, int y, int reach) {
  const auto at = [&](int px, int py) { return lit[static_cast<std::size_t>(py * kTracedWidth + px)]; };
  if (x < reach || y < reach || x + reach >= kTracedWidth || y + reach >= kTracedHeight) return false;
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
  for (int y = 0; y < kTracedHeight; ++y) {
    for (int x = 0; x < kTracedWidth; ++x) {
      const auto i = static_cast<std::size_t>(y * kTracedWidth + x);
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

/// A scene drawn and traced.
struct Traced {
  scene::Scene scene;
  Bench bench;
  std::vector<int> lit;

  explicit Traced(const std::string& name, const render::MapSettings& map = {})
      : scene(load_builtin(name)),
        bench(scene, 1024, kTracedWidth, kTracedHeight, map),
        lit(trace(bench, scene, bench.receivers(request_of("none")))) {}

  Rates measure(const std::string& filter, const render::BiasRule& rule) {
    return compare(bench.draw(request_of(filter), rule), lit);
  }
};

class DefaultBias : public ::testing::TestWithParam<std::string> {};

TEST_P(DefaultBias, LeavesNoVisibleAcne) {
  Traced traced(GetParam());
  for (const std::string& filter : filter_ids()) {
    const Rates rates = traced.measure(filter, {});
    ASSERT_GT(rates.lit, 2000);
    // A paraboloid bends the planes of its casters: filters as wide as vssm see that.
    EXPECT_LE(rates.acne, fit_of(traced.scene) == scene::FitMode::kParaboloid ? 0.004 : 0.001) << filter;
    EXPECT_LE(rates.gap, 0.05) << filter;
  }
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, DefaultBias, ::testing::ValuesIn(scenes_of_all_maps()),
                         [](const auto& each) { return each.param; });

/// Perspective depth spends nearly all of a float on the first metres; stored reversed, the float gives them back.
TEST(PerspectiveDepth, AtAMillion_GivesAcneThatReversedFloatsDoNot) {
  const auto acne = [](const render::MapSettings& map) { return Traced("steps", map).measure("none", {}).acne; };
  EXPECT_GT(acne({GL_DEPTH_COMPONENT32F, {false, 1e6}}), 0.02);
  EXPECT_GT(acne({GL_DEPTH_COMPONENT24, {true, 1e6}}), 0.02) << "fixed-point steps are the same either way round";
  EXPECT_LE(acne({GL_DEPTH_COMPONENT32F, {true, 1e6}}), 0.001);
}

TEST(NoBias, GivesAcne) { EXPECT_GT(Traced("steps").measure("none", render::BiasRule::none()).acne, 0.05); }

/// A square floor, 10 m wide, seen from above, under a sun that is `tilt` degrees away from the zenith.
scene::Scene make_plane(double tilt_deg, double azimuth_deg) {
  const double tilt = glm::radians(tilt_deg), azimuth = glm::radians(azimuth_deg);
  const glm::vec3 along(-std::sin(tilt) * std::cos(azimuth), -std::cos(tilt), -std::sin(tilt) * std::sin(azimuth));
  return scene::make_scene_of({scene::make_plane({10.0f, 10.0f}, 8)}, scene::Sun{glm::normalize(along)},
                              {scene::look_down({0.37f, 10.0f, 0.21f}, 7.0f)});
}

/// Gives the rule of a mode at `factor` times the theoretical amount, also for planes that the light grazes.
render::BiasRule make_rule(const render::BiasMode& mode, const render::BiasTheory& theory, double factor) {
  render::BiasRule rule = mode.make_rule(factor * mode.amount(theory));
  rule.max_tangent = 1e4;
  return rule;
}

const render::BiasMode& find_mode(const std::string& name) {
  const auto modes = render::swept_modes();
  return *std::find_if(modes.begin(), modes.end(), [&](const render::BiasMode& mode) { return mode.name == name; });
}

struct Sweep {
  Sweep(double tilt, double azimuth, int map_size)
      : scene(make_plane(tilt, azimuth)), bench(scene, map_size, 96, 96), size(map_size) {}

  render::BiasTheory theory(const filters::FilterRequest& request) {
    return render::make_theory(filters::bias_reach_texels(request.spec, request.values),
                               bench.receivers(request, render::BiasRule::none()).front());
  }

  /// The share of receivers that are darker than all but one part in 500.
  double acne(const filters::FilterRequest& request, render::BiasRule rule) {
    bench.redraw(rule.map);
    const std::vector<float> image = bench.draw(request, rule);
    double dark = 0.0, count = 0.0;
    for (const filters::Receiver& r : bench.receivers(request, rule)) {
      count += 1.0;
      if (image[bench.index(r)] < 0.998f) dark += 1.0;
    }
    return dark / count;
  }

  scene::Scene scene;
  Bench bench;
  int size;
};

constexpr double kAngles[] = {1.0, 20.0, 60.0, 85.0, 89.0};
constexpr int kSizes[] = {64, 2048};

class PlaneSweep : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(PlaneSweep, NoAcneAtTheTheoreticalAmount_AcneAtHalfOfIt) {
  const auto& [mode, filter] = GetParam();
  const filters::FilterRequest request = request_of(filter);
  for (const double tilt : kAngles) {
    for (const double azimuth : {0.0, 45.0}) {
      for (const int size : kSizes) {
        Sweep sweep(tilt, azimuth, size);
        const render::BiasTheory theory = sweep.theory(request);
        // Rounding of depths and of rasterised vertices: a fiftieth of the amount, and some steps of single precision.
        render::BiasRule enough = make_rule(find_mode(mode), theory, 1.02),
                         half = make_rule(find_mode(mode), theory, 0.5);
        enough.constant.depth += 1e-6;
        SCOPED_TRACE(mode + " " + filter + " at " + std::to_string(tilt) + " towards " + std::to_string(azimuth) +
                     ", map " + std::to_string(size));
        EXPECT_EQ(sweep.acne(request, enough), 0.0);
        // Seen by the light, the floor must span some texels before anything can lie between two of them.
        if (10.0 * theory.n_dot_l <= 4.0 * sweep.bench.frustum().texel_size_ws) continue;
        EXPECT_GT(sweep.acne(request, half), 0.0);
      }
    }
  }
}

std::vector<std::string> mode_names() {
  std::vector<std::string> names;
  // Receiver-plane needs no amount but what rounding asks for.
  for (const render::BiasMode& mode : render::swept_modes())
    if (!mode.key.empty() && mode.name != "receiver-plane") names.push_back(mode.name);
  return names;
}

std::string name_of_mode_and_filter(const testing::TestParamInfo<std::tuple<std::string, std::string>>& test) {
  return make_test_name(std::get<0>(test.param) + "_" + std::get<1>(test.param));
}

INSTANTIATE_TEST_SUITE_P(Modes, PlaneSweep,
                         ::testing::Combine(::testing::ValuesIn(mode_names()),
                                            ::testing::Values("none", "pcf2x2", "tent3x3", "box3x3",
                                                              "poisson:taps=32,rotation=none")),
                         name_of_mode_and_filter);

class ReceiverPlane : public ::testing::TestWithParam<std::string> {};

/// Needs no amount but what rounding asks for, whatever the kernel: up to 15 texels.
TEST_P(ReceiverPlane, NeedsNoAmount_OnPlanes) {
  const filters::FilterRequest request = request_of(GetParam());
  render::BiasRule rule = render::BiasRule::none();
  rule.max_tangent = 1e4;
  rule.receiver_plane = true;
  rule.constant.depth = 2e-5;
  for (const double tilt : {0.0, 1.0, 20.0, 60.0, 85.0, 89.0}) {
    for (const double azimuth : {0.0, 45.0}) {
      for (const int size : kSizes) {
        Sweep sweep(tilt, azimuth, size);
        EXPECT_EQ(sweep.acne(request, rule), 0.0) << tilt << " towards " << azimuth << ", map " << size;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Filters, ReceiverPlane,
                         ::testing::Values("none", "pcf2x2", "tent3x3", "box3x3", "teach4x4", "box4x4",
                                           "poisson:radius=7", "poisson:radius=15,taps=32"),
                         [](const auto& test) { return make_test_name(test.param); });

const scene::Mesh kBox = scene::make_box({2.0f, 1.0f, 2.0f}, 1);

/// A box from 1 to 2 m above a floor, under a sun at the zenith.
scene::Scene make_scene(double lift = 0.0) {
  return scene::make_scene_of({scene::make_plane({8.0f, 8.0f}, 1), scene::move_mesh(kBox, {0.0, 1.5 + lift, 0.0})},
                              scene::kSunAtZenith, {scene::look_down({0.0f, 6.0f, 0.1f})});
}

/// A floor that faces the light has no slope: the constant part of the default bias alone, which covers half a step of
/// the coarsest format, keeps it lit.
TEST(DefaultBias, KeepsAFloorThatFacesTheLightLit_InAnyFormat) {
  render::BiasRule without_constant;
  without_constant.constant = {};
  int needed = 0;
  for (const GLenum format : {GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT32F}) {
    for (const bool reversed : {false, true}) {
      for (const double lift : {0.0, 0.17, 0.41, 0.83}) {  // of the box, which moves the planes of depth
        Bench bench(make_scene(lift), 128, 32, 32, {format, {reversed}});
        const auto is_dark = [&](const std::string& filter, const render::BiasRule& rule) {
          const filters::FilterRequest request = request_of(filter);
          const std::vector<float> image = bench.draw(request, rule);
          return std::ranges::any_of(bench.receivers(request, rule), [&](const filters::Receiver& r) {
            return std::abs(r.position_ws.x) > 2.0f && image[bench.index(r)] < 0.9f;
          });
        };
        for (const std::string& filter : filter_ids())
          EXPECT_FALSE(is_dark(filter, {})) << filter << " " << render::describe_map({format, {reversed}}) << lift;
        needed += is_dark("none", without_constant) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(needed, 0) << "no step was ever rounded up: the scenes show nothing";
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
    Bench bench(scene, 128, 16, 16);
    EXPECT_NEAR(height_in_map(bench, 0.0), 2.0, 1e-4);
    bench.redraw({.cull_front = true});
    EXPECT_NEAR(height_in_map(bench, 0.0), 1.0, 1e-4);
    EXPECT_LT(height_in_map(bench, 3.0), -1e-4) << "an open floor vanishes";
  }
  scene.meshes[0].may_cull_front = false;
  Bench bench(scene, 128, 16, 16);
  bench.redraw({.cull_front = true});
  EXPECT_NEAR(height_in_map(bench, 0.0), 1.0, 1e-4);
  EXPECT_NEAR(height_in_map(bench, 3.0), 0.0, 1e-4);
}

TEST(MapBias, Midpoint_LiesBetweenFirstAndSecondSurface) {
  const scene::Scene scene = make_scene();
  for (const filters::DepthCurve& curve : {filters::DepthCurve{}, filters::DepthCurve{true},
                                           filters::DepthCurve{false, 20.0}, filters::DepthCurve{true, 20.0}}) {
    SCOPED_TRACE(render::describe_map({GL_DEPTH_COMPONENT32F, curve}));
    Bench bench(scene, 128, 16, 16, {GL_DEPTH_COMPONENT32F, curve});
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
  Bench bench(scene, 128, 16, 16);
  const double plain = height_in_map(bench, 3.0);
  const filters::Receiver r = bench.receivers(request_of("none"), render::BiasRule::none()).front();
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

TEST(ClosedMesh, IsOneThatEnclosesAVolume) {
  EXPECT_TRUE(scene::is_closed(kBox));
  EXPECT_FALSE(scene::is_closed(scene::make_plane({2.0f, 2.0f}, 1)));
  scene::Mesh torn = kBox;
  torn.indices.resize(torn.indices.size() - 3);
  EXPECT_FALSE(scene::is_closed(torn));
  scene::Mesh turned = kBox;
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
