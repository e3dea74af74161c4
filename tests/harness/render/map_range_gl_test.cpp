// Each wrong way to treat what lies outside the map gives its own artefact on the scene made for it; the right way
// none.

// The lookup of a light that stands in the scene, with a map drawn through a perspective by hand: what is behind the
// light.

// What the GL computes of a receiver in a curved map is what the frustum says in double.

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "harness/scene/mesh_tools.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

using filters::Border;
using filters::RangeRule;
using filters::Receiver;

constexpr int kRangeMapSize = 256;
constexpr float kBeyondKernels = 12.0f / kRangeMapSize;  // no default kernel reaches this far from outside into the map

bool is_outside(const Receiver& r) {
  const glm::vec2 from_center = glm::abs(r.uv - 0.5f);
  return std::max(from_center.x, from_center.y) > 0.5f + kBeyondKernels;
}

bool is_beyond_far(const Receiver& r) { return r.depth_unbiased > 1.0f; }

/// The scene `edge` with every receiver known, those beyond the far plane too.
class EdgeScene {
 public:
  EdgeScene() : scene_(load_builtin("edge")), bench_(shared_context(), scene_, kRangeMapSize) {
    bench_.set_range({Border::kBorder, false, true});
    receivers_ = bench_.receivers(catalogue().parse_requests("none").front());
  }

  /// Gives the share of the receivers that `belongs` chooses which a filter makes darker than half lit.
  double dark(const std::string& filter, const RangeRule& rule, const std::function<bool(const Receiver&)>& belongs) {
    bench_.set_range(rule);
    const std::vector<float> image = bench_.draw(catalogue().parse_requests(filter).front());
    double dark = 0.0, all = 0.0;
    for (const Receiver& r : receivers_) {
      if (!belongs(r)) continue;
      all += 1.0;
      if (image[bench_.index(r)] < 0.5f) dark += 1.0;
    }
    EXPECT_GT(all, 200.0) << "the scene shows none of these receivers";
    return dark / all;
  }

  /// How far the darkest and the lightest of such receivers are from a visibility.
  double farthest_from(double visibility, const std::string& filter, const RangeRule& rule,
                       const std::function<bool(const Receiver&)>& belongs) {
    bench_.set_range(rule);
    const std::vector<float> image = bench_.draw(catalogue().parse_requests(filter).front());
    double farthest = 0.0;
    int count = 0;
    for (const Receiver& r : receivers_) count += belongs(r) ? 1 : 0;
    EXPECT_GT(count, 200) << "the scene shows none of these receivers";
    for (const Receiver& r : receivers_)
      if (belongs(r)) farthest = std::max(farthest, std::abs(visibility - static_cast<double>(image[bench_.index(r)])));
    return farthest;
  }

  Bench& bench() { return bench_; }
  std::size_t receivers() const { return receivers_.size(); }

 private:
  scene::Scene scene_;
  Bench bench_;
  std::vector<Receiver> receivers_;
};

bool is_outside_before_far(const Receiver& r) { return is_outside(r) && !is_beyond_far(r); }

/// On the terrace right of the beam, in line with it.
bool is_in_streak(const Receiver& r) {
  return is_outside_before_far(r) && std::abs(r.position_ws.z + 0.3f) < 0.1f && r.position_ws.x > 2.6f;
}

constexpr const char* kPassesHaveNoBorder = "a filter says itself what lies outside the maps of its own passes";

bool has_own_passes(const std::string& id) { return !catalogue().find(id).passes.empty(); }

class MapRange : public ::testing::TestWithParam<std::string> {};

TEST_P(MapRange, RightRule_LightsEverythingOutside) {
  EdgeScene edge;
  EXPECT_EQ(edge.dark(GetParam(), {}, is_outside), 0.0);
  EXPECT_EQ(edge.dark(GetParam(), {}, is_in_streak), 0.0);
  EXPECT_EQ(edge.dark(GetParam(), {}, is_beyond_far), 0.0);
  EXPECT_LT(edge.farthest_from(1.0, GetParam(), {}, is_outside), 1e-3);
}

TEST_P(MapRange, Repeat_TilesTheShadows) {
  if (has_own_passes(GetParam())) GTEST_SKIP() << kPassesHaveNoBorder;
  EdgeScene edge;
  const RangeRule repeat{Border::kRepeat, true, true};
  const auto inside = [](const Receiver& r) {
    return !is_beyond_far(r) && glm::all(glm::lessThan(glm::abs(r.uv - 0.5f), glm::vec2(0.45f)));
  };
  const double in_map = edge.dark(GetParam(), repeat, inside),
               tiled = edge.dark(GetParam(), repeat, is_outside_before_far);
  EXPECT_GT(in_map, 0.05);
  EXPECT_NEAR(tiled, in_map, 0.6 * in_map) << "as dark outside as inside, but for the views of the tiles";
}

TEST_P(MapRange, Edge_SmearsCastersAtTheEdgeAndNothingElse) {
  if (has_own_passes(GetParam())) GTEST_SKIP() << kPassesHaveNoBorder;
  EdgeScene edge;
  const RangeRule smeared{Border::kEdge, true, true};
  EXPECT_EQ(edge.dark(GetParam(), smeared, is_in_streak), 1.0);
  const double all = edge.dark(GetParam(), smeared, is_outside_before_far);
  EXPECT_GT(all, 0.01);
  EXPECT_LT(all, 0.1);
}

TEST_P(MapRange, NoFarTest_DarkensEverythingBeyond) {
  EdgeScene edge;
  const RangeRule compared{Border::kBorder, false, true};
  EXPECT_GT(edge.dark(GetParam(), compared, is_beyond_far), 0.99);
  EXPECT_EQ(edge.dark(GetParam(), compared, is_outside_before_far), 0.0);
}

std::vector<float> full_of_casters(float depth) {
  return std::vector<float>(std::size_t{kRangeMapSize} * kRangeMapSize, depth);
}

/// What is read beyond an edge shows where casters stand everywhere.
TEST_P(MapRange, MapFullOfCasters_DarkensNothingOutside) {
  EdgeScene edge;
  edge.bench().map().upload(full_of_casters(0.02f));
  EXPECT_LT(edge.farthest_from(1.0, GetParam(), {}, is_outside), 1e-3);
}

/// Series repeat themselves where a receiver lies farther behind its caster than the map is deep.
TEST_P(MapRange, NoFarTest_DarkensWhatIsBehindACaster_HoweverDeep) {
  const scene::Scene scene = load_builtin("stack");
  Bench bench(shared_context(), scene, kRangeMapSize, 160, 90);
  const filters::FilterRequest request = catalogue().parse_requests(GetParam()).front();
  render::LightLayers light = bench.light(request);
  for (int column = 0; column < 4; ++column) light.front().frustum.uv_depth_from_world[column].z *= 1.6f;
  light.front().range.far_test = false;
  bench.map().upload(full_of_casters(0.02f));
  render::FilterPasses passes(bench.shaders(), request, bench.map(), light);
  render::ImageTarget target("visibility", GL_R32F, 160, 90);
  passes.prefilter(bench.map());
  passes.lookup(bench.gbuffer(), bench.map(), target);
  const std::vector<float> image = target.texture().read_floats(1);
  int deep = 0;
  for (const Receiver& r : render::read_receivers(bench.shaders(), bench.gbuffer(), light.front())) {
    const bool is_inside = glm::all(glm::lessThan(glm::abs(r.uv - 0.5f), glm::vec2(0.5f - kBeyondKernels)));
    if (!is_inside || r.depth < 1.005f) continue;
    ++deep;
    EXPECT_LT(image[bench.index(r)], 0.01f) << "at depth " << r.depth;
  }
  EXPECT_GT(deep, 1000);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, MapRange, ::testing::ValuesIn(filter_ids()),
                         [](const auto& each) { return each.param; });

TEST(MapRangeReceivers, LitByConvention_CountButAreNotAskedAbout) {
  EdgeScene edge;
  const auto request = catalogue().parse_requests("none").front();
  edge.bench().set_range({});
  const std::size_t asked = edge.bench().receivers(request).size();
  const auto counted =
      render::count_receivers(edge.bench().shaders(), edge.bench().gbuffer(), edge.bench().light(request));
  EXPECT_LT(asked, edge.receivers());
  EXPECT_EQ(static_cast<std::size_t>(counted), edge.receivers());
}

TEST(MapRangeVariants, RightRule_CompilesNothingMore) {
  const render::LightSetup right{};
  EXPECT_TRUE(render::range_defines(right).empty());
  render::LightSetup wrong{};
  wrong.range = {Border::kRepeat, false, false};
  EXPECT_EQ(render::range_defines(wrong).size(), 1u) << "an orthographic map has no behind";
}

using filters::Border;
using filters::RangeRule;

constexpr int kSide = 128;
constexpr double kLightHeight = 4.0;
constexpr double kDeckHeight = 6.0;

scene::Mesh moved(scene::Mesh mesh, const glm::dvec3& to) {
  return scene::transform_mesh(std::move(mesh), glm::translate(glm::dmat4(1.0), to));
}

/// A floor; over it, off the axis, a board; above the light a deck over the half x > 0. Seen from straight above.
scene::Scene make_projective_scene() {
  scene::Scene scene;
  scene.name = "projective";
  scene.materials.emplace_back();
  scene.meshes.push_back(moved(scene::make_plane({8.0f, 8.0f}, 8), {0.0, 0.0, 0.0}));
  scene.meshes.back().casts_shadow = false;
  scene.meshes.push_back(moved(scene::make_box({0.8f, 0.2f, 0.8f}, 1), {-0.8, 2.0, 0.4}));
  scene.meshes.push_back(moved(scene::make_plane({4.0f, 8.0f}, 4), {2.0, kDeckHeight, 0.0}));
  scene.light.kind = scene::Sun{{0.0f, -1.0f, 0.0f}};
  scene.cameras = {look_down({0.0f, 12.0f, 0.0f})};
  scene.cameras.front().orthographic_height_m = 8.0f;
  return scene;
}

/// A light over the origin that looks straight down through 90 degrees.
scene::LightFrustum make_frustum() {
  const glm::dmat4 view = glm::lookAt(glm::dvec3(0.0, kLightHeight, 0.0), glm::dvec3(0.0), glm::dvec3(0.0, 0.0, -1.0));
  const glm::dmat4 clip = glm::perspectiveRH_ZO(glm::radians(90.0), 1.0, 0.5, 8.0) * view;
  const glm::dmat4 uv_from_clip = glm::translate(glm::dmat4(1.0), glm::dvec3(0.5, 0.5, 0.0)) *
                                  glm::scale(glm::dmat4(1.0), glm::dvec3(0.5, 0.5, 1.0));
  scene::LightFrustum frustum;
  frustum.light_from_world = view;
  frustum.clip_from_world = glm::mat4(clip);
  frustum.uv_depth_from_world = glm::mat4(uv_from_clip * clip);
  frustum.texel_size_ws = 8.0 / 256.0;
  frustum.depth_range_ws = 7.5;
  frustum.direction_ws = {0.0f, -1.0f, 0.0f};
  frustum.projective = true;
  return frustum;
}

/// Draws that scene with a filter under a rule; rows bottom to top, so that row 0 is z = 4.
class ProjectiveRange : public ::testing::Test {
 protected:
  ProjectiveRange()
      : context_(shared_context()),
        scene_(make_projective_scene()),
        shaders_(options::find_resources().shaders),
        geometry_(scene_),
        map_(256),
        gbuffer_(kSide, kSide) {
    map_.draw(shaders_, geometry_, make_frustum());
    gbuffer_.draw(shaders_, geometry_, scene_, scene_.cameras.front());
  }

  std::vector<float> draw(const std::string& filter, const RangeRule& rule) {
    filters::Catalogue catalogue(options::find_resources().filters);
    catalogue.add_user_file(SHADOWBENCH_SOURCE_DIR "/tests/user_filters/clamped_reference.glsl");
    map_.set_border(rule.border);
    render::FilterPasses passes(shaders_, catalogue.parse_requests(filter).front(), map_, light(rule));
    render::ImageTarget target("visibility", GL_R32F, kSide, kSide);
    passes.lookup(gbuffer_, map_, target);
    context_.require_no_gl_errors();
    return target.texture().read_floats(1);
  }

  render::LightSetup light(const RangeRule& rule) const {
    return render::make_light_setup(make_frustum(), scene_.light, {.constant_depth = 1e-4}, 7, rule);
  }

  /// Visibility at a point of the picture, in metres.
  static float at(const std::vector<float>& image, double x, double z) {
    const auto column = static_cast<std::size_t>((x + 4.0) / 8.0 * kSide),
               row = static_cast<std::size_t>((4.0 - z) / 8.0 * kSide);
    return image[row * kSide + column];
  }

  static double dark_share_of_deck(const std::vector<float>& image) {
    double dark = 0.0;
    for (int y = 0; y < kSide; ++y)
      for (int x = kSide / 2; x < kSide; ++x) dark += image[static_cast<std::size_t>(y * kSide + x)] < 0.5f ? 1.0 : 0.0;
    return dark / (kSide * kSide / 2);
  }

  render::ShaderLibrary& shaders() { return shaders_; }
  render::GBuffer& gbuffer() { return gbuffer_; }

 private:
  gl::Context& context_;  ///< before everything that needs one
  scene::Scene scene_;
  render::ShaderLibrary shaders_;
  render::Geometry geometry_;
  render::ShadowMap map_;
  render::GBuffer gbuffer_;
};

TEST_F(ProjectiveRange, BeforeTheLight_TheShadowIsWhereTheRaysFall) {
  for (const bool tested : {true, false}) {
    const std::vector<float> image = draw("none", {Border::kBorder, tested, tested});
    // The board's shadow is twice as far from the axis as the board, and twice as large; the board hides a part of it.
    EXPECT_EQ(at(image, -2.2, 1.4), 0.0f);
    EXPECT_EQ(at(image, -0.8, 0.4), 1.0f) << "the board itself";
    EXPECT_EQ(at(image, -2.2, -1.4), 1.0f);
    EXPECT_EQ(at(image, -3.0, 3.0), 1.0f);
  }
}

TEST_F(ProjectiveRange, RightRule_LightsWhatIsBehind) {
  for (const char* filter : {"none", "clamped_reference"})
    EXPECT_EQ(dark_share_of_deck(draw(filter, {})), 0.0) << filter;
}

TEST_F(ProjectiveRange, EitherTestAlone_LightsWhatIsBehind) {
  // Depth divided by a negative w is always more than 1.
  EXPECT_EQ(dark_share_of_deck(draw("clamped_reference", {Border::kBorder, false, true})), 0.0);
  EXPECT_EQ(dark_share_of_deck(draw("clamped_reference", {Border::kBorder, true, false})), 0.0);
}

TEST_F(ProjectiveRange, NeitherTest_DarkensAllThatIsBehind) {
  EXPECT_EQ(dark_share_of_deck(draw("none", {Border::kBorder, false, false})), 1.0);
}

TEST_F(ProjectiveRange, NeitherTestAndAClampedReference_MirrorsTheMapThroughTheLight) {
  const std::vector<float> image = draw("clamped_reference", {Border::kBorder, false, false});
  // The board's top, 1.9 m below the light, at x = -1.2 .. -0.4, z = 0 .. 0.8; the deck, 2 m above, has it the other
  // way.
  const double scale = -(kDeckHeight - kLightHeight) / 1.9;
  EXPECT_EQ(at(image, -0.8 * scale, 0.4 * scale), 0.0f);
  EXPECT_EQ(at(image, -0.8 * scale, -0.4 * scale), 1.0f);
  EXPECT_NEAR(dark_share_of_deck(image), 0.64 * scale * scale / 32.0, 0.1 * 0.64 / 32.0) << "and nothing else is dark";
}

TEST_F(ProjectiveRange, Receivers_AreThoseThatTheMapReaches) {
  const auto count = [&](const RangeRule& rule) {
    return render::read_receivers(shaders(), gbuffer(), light(rule)).size();
  };
  EXPECT_EQ(count({}), static_cast<std::size_t>(kSide * kSide / 2));
  EXPECT_EQ(count({Border::kBorder, false, true}), static_cast<std::size_t>(kSide * kSide / 2));
  EXPECT_EQ(count({Border::kBorder, false, false}), static_cast<std::size_t>(kSide * kSide));
}

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
