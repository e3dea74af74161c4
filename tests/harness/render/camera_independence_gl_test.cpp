// The camera moves, and the visibility of places in the world stays what it was, whichever filter asks: for every kind
// of light, and for bars as thin as texels.

#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <tuple>

#include "tests/harness/render/contract_fixture.h"

namespace shadowbench::test {
namespace {

using filters::FilterRequest;
using filters::Receiver;

constexpr int kMapSize = 288;  // texels larger than pixels: few lit or dark places fall between the pixels of a view
constexpr int kViewWidth = 480, kViewHeight = 270;
constexpr std::uint32_t kSeeds = 24;
constexpr double kShaded = 0.9;     // wide kernels leave much light behind thin casters
constexpr double kTurn = 0.45;      // of the camera around the scene, rad
constexpr double kDistance = 1.08;  // as far from it as before

/// A place's visibility lies between its neighbours' in the other view, but for what it does within a pixel: curve, by
/// a part of what it changes by from pixel to pixel, or jump where a silhouette in the map is narrower than that.
/// Measured: 37 of 125 929 places are seen otherwise at most.
constexpr double kBetweenPixels = 0.02, kCurvature = 0.25;
constexpr double kLargestShare = 0.001, kHardeningShare = 0.005;

/// A random mean of 24 seeds is that many standard errors off in fewer places than kLargestShare allows (normal: 1e-4).
constexpr double kQuantile = 4.0;

scene::Camera move_around(const scene::Scene& scene) {
  const scene::Bounds bounds = scene.bounds();
  const glm::dvec3 center = 0.5 * (glm::dvec3(bounds.min) + glm::dvec3(bounds.max));
  const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), kTurn, glm::dvec3(0.0, 1.0, 0.0)));
  scene::Camera camera = scene.cameras.front();
  camera.position_ws = glm::vec3(center + kDistance * (turn * (glm::dvec3(camera.position_ws) - center)));
  camera.forward_ws = glm::vec3(turn * glm::dvec3(camera.forward_ws));
  camera.up_ws = glm::vec3(turn * glm::dvec3(camera.up_ws));
  return camera;
}

/// A receiver with what is seen of it.
struct Place {
  Receiver receiver;
  double visibility = 0.0;
  double standard_error = 0.0;  ///< 0 without chance
};

/// A view's places, by pixel; empty where there is no receiver.
class View {
 public:
  View(const scene::Scene& scene, const FilterRequest& request)
      : bench_(shared_context(), scene, kMapSize, kViewWidth, kViewHeight),
        clip_(render::clip_from_world(scene.cameras.front(), scene.bounds(),
                                      static_cast<double>(kViewWidth) / kViewHeight)),
        pixels_(static_cast<std::size_t>(kViewWidth * kViewHeight)) {
    const auto images = draw_seeds(bench_, request, is_stochastic(request) ? kSeeds : 1);
    for (const Receiver& r : bench_.receivers(request)) pixels_[bench_.index(r)] = average(r, images);
  }

  const std::vector<std::optional<Place>>& pixels() const { return pixels_; }
  const scene::LightFrustum& frustum() const { return bench_.frustum(); }

  /// Gives the places of the 3x3 pixels around a place, all of them on its surface; none where one is not.
  std::vector<const Place*> find_around(const Receiver& r) const {
    const glm::vec4 clip = clip_ * glm::vec4(r.position_ws, 1.0f);
    const glm::vec2 at = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(kViewWidth, kViewHeight);
    const glm::ivec2 pixel(glm::floor(at));
    std::vector<const Place*> found;
    for (int y = pixel.y - 1; y <= pixel.y + 1; ++y) {
      for (int x = pixel.x - 1; x <= pixel.x + 1; ++x) {
        if (x < 0 || y < 0 || x >= kViewWidth || y >= kViewHeight) return {};
        const auto& place = pixels_[static_cast<std::size_t>(y * kViewWidth + x)];
        if (!place || !is_same_surface(r, place->receiver)) return {};
        found.push_back(&*place);
      }
    }
    return found;
  }

 private:
  Bench bench_;
  glm::mat4 clip_;
  std::vector<std::optional<Place>> pixels_;

  Place average(const Receiver& r, const std::vector<std::vector<float>>& images) const {
    double sum = 0.0, squares = 0.0;
    for (const std::vector<float>& image : images) {
      const double v = static_cast<double>(image[bench_.index(r)]);
      sum += v;
      squares += v * v;
    }
    const double n = static_cast<double>(images.size());
    const double variance = n > 1.0 ? std::max(squares - sum * sum / n, 0.0) / (n - 1.0) : 0.0;
    return {r, sum / n, std::sqrt(variance / n)};
  }

  static bool is_same_surface(const Receiver& a, const Receiver& b) {
    const glm::vec3 way = b.position_ws - a.position_ws;
    return glm::dot(a.normal_ws, b.normal_ws) > 0.9999f &&
           std::abs(glm::dot(a.normal_ws, way)) < 0.1f * a.texel_size_ws && glm::length(way) < 4.0f * a.texel_size_ws;
  }
};

/// Says whether a place is darker or brighter than all of its neighbours in another view.
bool is_other(const Place& place, const std::vector<const Place*>& around) {
  double low = 1.0, high = 0.0, error = 0.0;
  for (const Place* each : around) {
    low = std::min(low, each->visibility);
    high = std::max(high, each->visibility);
    error = std::max(error, each->standard_error);
  }
  const double slack = kBetweenPixels + kCurvature * (high - low) + kQuantile * std::hypot(place.standard_error, error);
  return place.visibility < low - slack || place.visibility > high + slack;
}

double angle_between(const glm::vec3& a, const glm::vec3& b) {
  return std::acos(static_cast<double>(glm::dot(glm::normalize(a), glm::normalize(b))));
}

class CameraIndependence : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(CameraIndependence, OtherCamera_SeesTheSameVisibilityInTheWorld) {
  const auto& [scene_name, filter] = GetParam();
  const scene::Scene scene = load_builtin(scene_name);
  scene::Scene seen_from_aside = scene;
  seen_from_aside.cameras.front() = move_around(scene);
  for (const scene::Scene* each : {&scene, &std::as_const(seen_from_aside)}) {
    ASSERT_GT(angle_between(each->cameras.front().forward_ws, -scene::to_light(scene.light, {})), 0.35)
        << "the camera looks along the light";
  }
  const View first(scene, request_of(filter)), second(seen_from_aside, request_of(filter));
  ASSERT_EQ(first.frustum().uv_depth_from_world, second.frustum().uv_depth_from_world);
  int matched = 0, other = 0, shaded = 0;
  for (const std::optional<Place>& place : first.pixels()) {
    if (!place) continue;
    const std::vector<const Place*> around = second.find_around(place->receiver);
    if (around.empty()) continue;
    ++matched;
    other += is_other(*place, around) ? 1 : 0;
    shaded += place->visibility < kShaded ? 1 : 0;
  }
  std::printf("%s %s: %d places in both views, %d shaded, %d seen otherwise\n", scene_name.c_str(), filter.c_str(),
              matched, shaded, other);
  EXPECT_GT(matched, 5000);
  EXPECT_GT(shaded, matched / 100);
  // Where shadows harden at contacts, they are as sharp as the map, and pixels miss more: 251 of 85 681 were measured.
  const bool hardens = !request_of(filter).spec.claims.empty();
  EXPECT_LE(other, (hardens ? kHardeningShare : kLargestShare) * matched);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, CameraIndependence,
                         ::testing::Combine(::testing::Values("cubes", "fence", "lamp", "lantern"),
                                            ::testing::ValuesIn(filter_ids())),
                         [](const auto& each) { return std::get<0>(each.param) + "_" + std::get<1>(each.param); });

}  // namespace
}  // namespace shadowbench::test
