// The same scene at another size, far from the origin, and turned so that its light goes along every axis.

// The camera moves, and the visibility of places in the world stays what it was, whichever filter asks: for every kind
// of light, and for bars as thin as texels.

// Casters that move take their shadows with them, and light and camera that stay change nothing: on every built-in
// scene.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <tuple>

#include "harness/measure/view_receivers.h"
#include "harness/scene/load.h"
#include "harness/scene/mesh_tools.h"
#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"
#include "tests/harness/render/contract_fixture.h"
#include "tests/harness/scene/test_files.h"

namespace shadowbench::test {
namespace {

constexpr int kPlacedWidth = 160, kPlacedHeight = 120;
constexpr float kOffVisibly = 0.1f;         // a pixel's visibility
constexpr double kLeastOfRounding = 0.125;  // of a limit that is a bound on rounding: there it may be met already
constexpr double kShareOff = 0.01;          // so many pixels may be off by that
const glm::dvec3 kWay{0.8, 0.36, 0.48};     // unit length

using Pictures = std::map<std::string, std::vector<float>>;

Pictures draw_placed(const scene::Scene& scene) {
  Bench bench(shared_context(), scene, 256, kPlacedWidth, kPlacedHeight);
  Pictures pictures;
  for (const char* id : {"none", "box3x3", "poisson", "vsm", "esm", "pcss"}) pictures[id] = bench.draw(request_of(id));
  return pictures;
}

/// The share of the pixels that are off. What is not finite is.
double find_share_off(const std::vector<float>& seen, const std::vector<float>& expected) {
  int off = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) off += std::abs(seen[i] - expected[i]) <= kOffVisibly ? 0 : 1;
  return static_cast<double>(off) / static_cast<double>(seen.size());
}

void expect_same(const Pictures& seen, const Pictures& expected) {
  for (const auto& [id, picture] : expected) {
    EXPECT_GT(std::ranges::count_if(picture, [](float v) { return v < 0.9f; }), 500) << id << " shows no shadow";
    EXPECT_LE(find_share_off(seen.at(id), picture), kShareOff) << id;
  }
}

template <class Place>
scene::Scene place(scene::Scene scene, const Place& place_point) {
  for (scene::Mesh& mesh : scene.meshes)
    for (scene::Vertex& v : mesh.vertices) v.position_ws = glm::vec3(place_point(glm::dvec3(v.position_ws)));
  for (scene::Camera& c : scene.cameras) c.position_ws = glm::vec3(place_point(glm::dvec3(c.position_ws)));
  return scene::validate(std::move(scene), "placed");
}

double find_size(const scene::Scene& scene) {
  const scene::Bounds bounds = scene.bounds();
  return glm::length(glm::dvec3(bounds.max) - glm::dvec3(bounds.min));
}

/// Moves a scene by so many of its sizes.
scene::Scene move_away(const scene::Scene& scene, double sizes) {
  const glm::dvec3 way = kWay * (sizes * find_size(scene));
  return place(scene, [&](const glm::dvec3& p) { return p + way; });
}

/// At how many sizes from the origin the step of a coordinate is what the constant bias, and the plane's bias over the
/// half texel that the nearest texel's centre is away at most, tolerate. Nearer, every filter draws what it should:
/// none tolerates less than a comparison. Beyond half a texel shadows move by whole texels.
double find_farthest(const scene::Scene& scene) {
  Bench bench(shared_context(), scene, 256, kPlacedWidth, kPlacedHeight);
  const scene::LightFrustum& frustum = bench.frustum();
  const double facing = std::abs(static_cast<double>(
                   glm::dot(scene.meshes.front().vertices.front().normal_ws, frustum.direction_ws))),
               tangent = std::sqrt(std::max(1.0 - facing * facing, 0.0)) / facing,
               constant_m = bench.light(request_of("none")).front().bias.constant_depth * frustum.depth_range_ws;
  const double slack_m = std::min(constant_m + 0.5 * frustum.texel_size_ws * tangent, 0.5 * frustum.texel_size_ws);
  return slack_m / (0x1p-23 * kWay.x * find_size(scene));
}

/// A floor under a slab whose edges no texel grid follows, and a wall that casts no shadow; the light goes straight
/// down unless it leans. All of it is turned.
scene::Scene make_turned_slab(const glm::dmat3& turn, const glm::dvec3& light = {0.0, -1.0, 0.0}) {
  const glm::dmat4 world(turn), none(1.0);
  const glm::dmat4 slab = glm::rotate(glm::translate(none, glm::dvec3(0.2, 1.0, -0.1)), glm::radians(20.0),
                                      glm::dvec3(0.0, 1.0, 0.0)),
                   wall = glm::rotate(glm::translate(none, glm::dvec3(-2.0, 0.6, 0.0)), glm::radians(-90.0),
                                      glm::dvec3(0.0, 0.0, 1.0));
  scene::Scene scene;
  scene.name = "turned slab";
  scene.materials.emplace_back();
  scene.meshes = {scene::transform_mesh(scene::make_plane({4.0f, 4.0f}, 8), world),
                  scene::transform_mesh(scene::make_plane({1.5f, 1.0f}, 4), world * slab),
                  scene::transform_mesh(scene::make_plane({1.2f, 4.0f}, 4), world * wall)};
  scene.meshes.back().casts_shadow = false;
  scene.light.kind = scene::Sun{glm::vec3(turn * glm::normalize(light))};
  const glm::dvec3 eye(2.6, 3.6, 3.4), forward = glm::normalize(glm::dvec3(-0.2, 0.3, 0.0) - eye);
  scene::Camera camera;
  camera.position_ws = glm::vec3(turn * eye);
  camera.forward_ws = glm::vec3(turn * forward);
  camera.up_ws = glm::vec3(turn * glm::dvec3(0.0, 1.0, 0.0));
  scene.cameras.push_back(camera);
  return scene::validate(scene, scene.name);
}

/// No length in the chain is absolute, and floats round alike at every size.
TEST(Placement, SceneOfAnySize_LooksTheSame) {
  const scene::Scene cubes = load_builtin("cubes");
  const Pictures expected = draw_placed(cubes);
  for (const double factor : {1e-6, 0.3, 7.0, 1e6}) {
    SCOPED_TRACE(factor);
    expect_same(draw_placed(place(cubes, [&](const glm::dvec3& p) { return factor * p; })), expected);
  }
}

TEST(Placement, SceneFarFromTheOrigin_LooksTheSame_AsFarAsTheBiasToleratesItsCoordinates) {
  const glm::dmat4 turned =
      glm::rotate(glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1.0, 0.0, 0.0)), 0.5, glm::dvec3(0.0, 0.0, 1.0));
  scene::Scene floor = make_turned_slab(glm::dmat3(turned));
  floor.meshes.pop_back();  // light that grazes the wall is lost by any step
  for (const auto& [scene, nearly] : {std::pair(load_builtin("cubes"), kLeastOfRounding), std::pair(floor, 0.9)}) {
    SCOPED_TRACE(scene.name);
    const Pictures expected = draw_placed(scene);
    const double farthest = find_farthest(scene);
    expect_same(draw_placed(move_away(scene, nearly * farthest)), expected);
    const Pictures farther = draw_placed(move_away(scene, 8.0 * farthest));
    EXPECT_GT(find_share_off(farther.at("none"), expected.at("none")), kShareOff) << "theory ends too early";
  }
}

/// A fence on a floor, whose file has it so far along x and z.
scene::Scene load_fence_at(double distance) {
  const auto at = [&](double x, double y, double z) {
    return fmt::format("[{:.12g}, {}, {:.12g}]\n", distance + x, y, distance + z);
  };
  const scene::TestFolder folder;
  const std::string text =
      "title = \"fence\"\n[camera]\nvertical_fov_deg = 35\nposition = " + at(3.0, 2.5, 4.0) +
      "target = " + at(0.0, 0.5, 0.0) + "[light]\nazimuth_deg = 72\nelevation_deg = 38\n" +
      "[[object]]\nshape = \"plane\"\nsize = [8, 8]\ncenter = " + at(0.0, 0.0, 0.0) +
      "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nrotation_deg = [0, 30, 0]\ncenter = " + at(0.0, 0.5, 0.0) +
      "[[object]]\nshape = \"bars\"\ncount = 7\nbar_width = 0.08\n" +
      "spacing = 0.2\nlength = 1\ncenter = " + at(1.2, 0.5, 0.6);
  return scene::load(folder.write("fence.toml", text).string(), {});
}

/// The last pixels that differ are those where a silhouette or an edge of a shadow runs through a sample within some
/// roundings of a coordinate.
TEST(Placement, SceneOfAFileFarFromTheOrigin_LooksTheSame) {
  constexpr double kShareOfEdges = 6e-4;  // twice the most that was seen, 6 of 19 200 pixels
  const Pictures expected = draw_placed(load_fence_at(0.0));
  for (const double distance : {20.0, 100.0, 200.0, 500.0, 10e3, 1e6}) {
    SCOPED_TRACE(distance);
    const Pictures seen = draw_placed(load_fence_at(distance));
    for (const auto& [id, picture] : expected) EXPECT_LE(find_share_off(seen.at(id), picture), kShareOfEdges) << id;
  }
}

/// Compares what filters draw of a scene with what is traced at the same places, but for surfaces that light grazes:
/// there it must be a share of light, and no more is known.
void expect_traced_shadow(const scene::Scene& scene, const std::vector<std::string>& filters) {
  Bench bench(shared_context(), scene, 1024, kPlacedWidth, kPlacedHeight);
  const measure::ViewReceivers receivers = measure::read_view_receivers(bench.gbuffer(), scene.light);
  const images::Image traced = receivers.to_image(truth::trace_hard(
      truth::Occluders(scene::list_occluders(scene)), receivers.image, scene::make_area_light(scene.light)));
  const glm::vec3 to_light = scene::to_light(scene.light, {});
  for (const std::string& filter : filters) {
    const std::vector<float> drawn = bench.draw(request_of(filter));
    EXPECT_TRUE(std::ranges::all_of(drawn, [](float v) { return v >= 0.0f && v <= 1.0f; })) << filter;
    std::vector<float> seen, expected;
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      const int x = static_cast<int>(i) % kPlacedWidth, y = kPlacedHeight - 1 - static_cast<int>(i) / kPlacedWidth;
      const std::size_t at = static_cast<std::size_t>(y * kPlacedWidth + x);  // rows of images begin at the top
      if (std::abs(glm::dot(receivers.image.points[at].normal_ws, to_light)) < 0.02f) continue;
      seen.push_back(drawn[i]);
      expected.push_back(traced.texels[at]);
    }
    EXPECT_GT(std::ranges::count(expected, 0.0f), 500) << filter;
    EXPECT_LE(find_share_off(seen, expected), kShareOff) << filter;
  }
}

/// Exactly along an axis, and beside it, towards where the light's own axes may switch and between; one plane is at
/// right angles to the light, one parallel.
TEST(Placement, LightAlongEveryAxis_AndBesideIt_CastsTheShadowThatIsTraced) {
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const glm::dmat3 turns[] = {{x, y, z}, {-x, -y, z}, {-y, x, z}, {y, -x, z}, {x, z, -y}, {x, -z, y}};
  const std::pair<double, double> leans[] = {{0.0, 0.0},   {1e-9, 0.0},  {1e-9, 0.9}, {1e-4, 1.6},
                                             {0.17, 0.25}, {0.17, 1.57}, {0.17, 4.1}};
  for (const glm::dmat3& turn : turns) {
    for (const auto& [lean, to] : leans) {
      const glm::dvec3 light(lean * std::cos(to), -1.0, lean * std::sin(to));
      SCOPED_TRACE(fmt::format("along {}, {}, {}, {} off towards {}", -turn[1].x, -turn[1].y, -turn[1].z, lean, to));
      expect_traced_shadow(make_turned_slab(turn, light), {"none", "tent3x3", "vsm:radius=1"});
    }
  }
}

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

using filters::Receiver;

constexpr int kMovedMapSize = 512;
constexpr int kMovedWidth = 320, kMovedHeight = 180;
constexpr glm::dvec2 kStepTexels{
    4.0, 3.0};  // whole texels of the map: the texel grid lies on the moved casters as on the others
constexpr glm::dvec2 kStepOfLevels{16.0, -16.0};  // the same for mip levels up to texels of 16
constexpr double kRoom = 1.5;  // before and behind the planes that fit the scene, metres: for what moves

/// Coordinates that have moved are rounded otherwise: a silhouette that runs near a texel's centre may take one texel
/// more or less. Measured: 3 of 38 845 receivers change at most.
constexpr float kVisible = 0.02f;
constexpr float kMovedShaded = 0.9f;  // wide kernels leave much light behind thin casters
constexpr double kMovedShare = 0.001, kMovedShareOfSteps = 0.004;

/// Gives the mesh on which the others stand: flat, level, and the largest such.
std::size_t find_floor(const scene::Scene& scene) {
  std::size_t floor = 0;
  float largest = 0.0f;
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    scene::Bounds bounds;
    for (const scene::Vertex& v : scene.meshes[i].vertices) bounds.add(v.position_ws);
    const glm::vec3 size = bounds.max - bounds.min;
    if (size.y == 0.0f && size.x * size.z > largest) {
      floor = i;
      largest = size.x * size.z;
    }
  }
  EXPECT_GT(largest, 0.0f) << "the scene has no level floor";
  return floor;
}

/// Gives the scene a map that no longer follows what is in it.
void freeze_frustum(scene::Scene& scene) {
  const scene::LightFrustum fit = scene::fit_light(scene, scene::FitMode::kTight, kMovedMapSize, 12.0);
  const double half = 0.5 * fit.depth_range_ws;
  const glm::dvec3 center(glm::inverse(fit.light_from_world) * glm::dvec4(0.0, 0.0, -half, 1.0));
  scene.light.map_window =
      scene::MapWindow{center, fit.width_ws, scene::MapWindow::Planes{-half - kRoom, half + kRoom}};
}

glm::dvec2 step_of(const filters::FilterSpec& spec) {
  const auto has_levels = [](const filters::PassSpec& pass) { return pass.steps == filters::PassSteps::kLevels; };
  return std::ranges::any_of(spec.passes, has_levels) ? kStepOfLevels : kStepTexels;
}

/// Gives a way along the floor that is `step_texels` in the map.
glm::vec3 choose_way(const scene::LightFrustum& frustum, glm::dvec2 step_texels) {
  const glm::dmat3 world_from_light = glm::transpose(glm::dmat3(frustum.light_from_world));
  const glm::dvec3 across =
      frustum.texel_size_ws * (step_texels.x * world_from_light[0] + step_texels.y * world_from_light[1]);
  const glm::dvec3 light(frustum.direction_ws);
  return glm::vec3(across - light * (across.y / light.y));
}

/// Moves everything but the floor.
scene::Scene move_casters(scene::Scene scene, const glm::vec3& way) {
  const std::size_t floor = find_floor(scene);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    if (i == floor) continue;
    for (scene::Vertex& v : scene.meshes[i].vertices) v.position_ws += way;
  }
  return scene;
}

/// A drawing with its receivers by pixel.
struct Picture {
  std::vector<float> visibility;
  std::vector<std::optional<Receiver>> receivers;
};

Picture draw(const scene::Scene& scene, const filters::FilterRequest& request) {
  Bench bench(shared_context(), scene, kMovedMapSize, kMovedWidth, kMovedHeight);
  Picture picture{bench.draw(request),
                  std::vector<std::optional<Receiver>>(static_cast<std::size_t>(kMovedWidth * kMovedHeight))};
  for (const Receiver& r : bench.receivers(request)) picture.receivers[bench.index(r)] = r;
  return picture;
}

struct Change {
  int compared = 0;
  int changed = 0;
  int shaded = 0;
};

/// Compares the pixels whose receivers are the same but for a way.
Change compare(const Picture& before, const Picture& after, const glm::vec3& way, float visible) {
  Change change;
  for (std::size_t i = 0; i < before.receivers.size(); ++i) {
    const auto &a = before.receivers[i], &b = after.receivers[i];
    if (!a || !b || glm::distance(a->position_ws + way, b->position_ws) > 1e-3f * a->texel_size_ws) continue;
    ++change.compared;
    change.changed += std::abs(before.visibility[i] - after.visibility[i]) > visible ? 1 : 0;
    change.shaded += before.visibility[i] < kMovedShaded ? 1 : 0;
  }
  return change;
}

class MovedCaster : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  scene::Scene scene_ = [] {
    scene::Scene scene = load_builtin(std::get<0>(GetParam()));
    freeze_frustum(scene);
    return scene;
  }();
  filters::FilterRequest request_ = request_of(std::get<1>(GetParam()));
  glm::vec3 way_ =
      choose_way(scene::fit_light(scene_, scene::FitMode::kTight, kMovedMapSize, 6.0), step_of(request_.spec));
};

/// A camera that goes along sees the same picture on the floor, which stays, as on what moved.
TEST_P(MovedCaster, TakesItsShadowWithIt) {
  scene::Scene moved = move_casters(scene_, way_);
  moved.cameras.front().position_ws += way_;
  const Change change = compare(draw(scene_, request_), draw(moved, request_), way_, kVisible);
  std::printf("%d receivers, %d shaded, %d changed\n", change.compared, change.shaded, change.changed);
  EXPECT_GT(change.compared, 10000);
  EXPECT_GT(change.shaded, change.compared / 100);
  EXPECT_LE(change.changed, (rounds_to_steps(request_.spec) ? kMovedShareOfSteps : kMovedShare) * change.compared);
}

/// A camera that stays sees shadows leave places that stay, and reach others.
TEST_P(MovedCaster, LeavesNoShadowBehind) {
  const Picture before = draw(scene_, request_), after = draw(move_casters(scene_, way_), request_);
  const Change change = compare(before, after, glm::vec3(0.0f), 1.0f - kMovedShaded);
  std::printf("%d of %d changed\n", change.changed, change.compared);
  EXPECT_GT(change.compared, 5000);
  EXPECT_GT(change.changed, change.compared / 100);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, MovedCaster,
                         ::testing::Combine(::testing::ValuesIn(builtin_scenes()), ::testing::ValuesIn(filter_ids())),
                         [](const auto& each) { return std::get<0>(each.param) + "_" + std::get<1>(each.param); });

}  // namespace
}  // namespace shadowbench::test
