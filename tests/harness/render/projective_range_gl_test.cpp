// The lookup of a light that stands in the scene, with a map drawn through a perspective by hand: what is behind the
// light.

#include <glm/gtc/matrix_transform.hpp>

#include "harness/scene/mesh_tools.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

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
  scene::Camera camera;
  camera.position_ws = {0.0f, 12.0f, 0.0f};
  camera.forward_ws = {0.0f, -1.0f, 0.0f};
  camera.up_ws = {0.0f, 0.0f, -1.0f};
  camera.orthographic_height_m = 8.0f;
  scene.cameras.push_back(camera);
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

}  // namespace
}  // namespace shadowbench::test
