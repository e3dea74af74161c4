// Every bias mode on an empty plane, over angles and map sizes: at the amount that theory asks for there is no acne, at
// half of it there is.

#include <algorithm>
#include <cmath>
#include <tuple>

#include "harness/render/bias/bias_theory.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

/// A square floor, 10 m wide, seen from above, under a sun that is `tilt` degrees away from the zenith.
scene::Scene make_plane(double tilt_deg, double azimuth_deg) {
  scene::Scene scene;
  scene.name = "plane";
  scene.materials.emplace_back();
  scene::Mesh floor;
  constexpr int kCells = 8;
  const auto coordinate = [](int i) { return -5.0f + 10.0f * static_cast<float>(i) / static_cast<float>(kCells); };
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i)
      floor.vertices.push_back({{coordinate(i), 0.0f, coordinate(j)}, {0, 1, 0}, {0, 0}});
  for (std::uint32_t j = 0; j < kCells; ++j) {
    for (std::uint32_t i = 0; i < kCells; ++i) {
      const std::uint32_t a = j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1;
      floor.indices.insert(floor.indices.end(), {a, c, b, b, c, c + 1});
    }
  }
  scene.meshes = {floor};
  const double tilt = glm::radians(tilt_deg), azimuth = glm::radians(azimuth_deg);
  scene.light.kind = scene::Sun{glm::normalize(
      glm::vec3(-std::sin(tilt) * std::cos(azimuth), -std::cos(tilt), -std::sin(tilt) * std::sin(azimuth)))};
  scene::Camera camera = look_down({0.37f, 10.0f, 0.21f});
  camera.orthographic_height_m = 7.0f;
  scene.cameras = {camera};
  return scene;
}

/// Gives the rule of a mode at `factor` times the theoretical amount, also for planes that the light grazes.
render::BiasRule make_rule(const render::SweptMode& mode, const render::BiasTheory& theory, double factor) {
  render::BiasRule rule = mode.make_rule(factor * mode.amount(theory));
  rule.max_tangent = 1e4;
  return rule;
}

const render::SweptMode& find_mode(const std::string& name) {
  const auto& modes = render::swept_modes();
  return *std::find_if(modes.begin(), modes.end(), [&](const render::SweptMode& mode) { return mode.name == name; });
}

struct Sweep {
  Sweep(double tilt, double azimuth, int map_size)
      : scene(make_plane(tilt, azimuth)), bench(shared_context(), scene, map_size, 96, 96), size(map_size) {}

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
  const filters::FilterRequest request = catalogue().parse_requests(filter).front();
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
  for (const render::SweptMode& mode : render::swept_modes())
    if (!mode.key.empty() && mode.name != "receiver-plane") names.push_back(mode.name);
  return names;
}

std::string name_of_mode_and_filter(const testing::TestParamInfo<std::tuple<std::string, std::string>>& test) {
  std::string name = std::get<0>(test.param) + "_" + std::get<1>(test.param);
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Modes, PlaneSweep,
                         ::testing::Combine(::testing::ValuesIn(mode_names()),
                                            ::testing::Values("none", "pcf2x2", "tent3x3", "box3x3",
                                                              "poisson:taps=32,rotation=none")),
                         name_of_mode_and_filter);

class ReceiverPlane : public ::testing::TestWithParam<std::string> {};

/// Needs no amount but what rounding asks for, whatever the kernel: up to 15 texels.
TEST_P(ReceiverPlane, NeedsNoAmount_OnPlanes) {
  const filters::FilterRequest request = catalogue().parse_requests(GetParam()).front();
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
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace shadowbench::test
