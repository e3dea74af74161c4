// Casters that one sees through in the depth map: how many of its texels hold them, and which.

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "harness/render/shadow_map.h"
#include "harness/scene/mesh_tools.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

using render::BlendCasters;

constexpr int kMapSide = 256;  // texels

/// Panes of 2 x 2 m, one over the other by half a metre, above a floor of 4 x 4 m under a sun at the zenith.
scene::Scene make_panes(std::vector<float> alphas) {
  scene::Scene scene;
  scene.name = "panes";
  scene.materials.push_back({.name = "floor"});
  scene.meshes.push_back(scene::make_plane({4.0f, 4.0f}, 1));
  for (const float alpha : alphas) {
    scene.materials.push_back({.name = "pane", .base_color = {1, 1, 1, alpha}, .alpha_mode = scene::AlphaMode::kBlend});
    scene.meshes.push_back(scene::make_plane({2.0f, 2.0f}, 4));
    const float height = 0.5f * static_cast<float>(scene.meshes.size() - 1) + 0.123f;
    for (scene::Vertex& vertex : scene.meshes.back().vertices) vertex.position_ws.y = height;
    scene.meshes.back().material = static_cast<int>(scene.materials.size()) - 1;
  }
  scene.light.kind = scene::Sun{{0.0f, -1.0f, 0.0f}};
  scene.cameras = {look_down({0.0f, 6.0f, 0.1f})};
  return scene;
}

/// For each texel in the middle of the panes, whether a map that is moved by so many texels holds one of them there.
std::vector<bool> find_held(const scene::Scene& scene, BlendCasters casters, const glm::dvec2& shift = {}) {
  gl::Context& context = shared_context();
  const auto fit = [&](const glm::dvec2& texels) {
    return scene::fit_layers(scene, {.map_size = kMapSide, .pad_texels = 9.0, .shift_texels = texels}).front();
  };
  const scene::LightFrustum still = fit({}), moved = fit(shift);
  render::ShaderLibrary shaders(options::find_resources().shaders);
  render::ShadowMap shadow_map(kMapSide, {.blend_casters = casters});
  shadow_map.draw(shaders, render::Geometry(scene), moved);
  context.require_no_gl_errors();
  const filters::DepthMap map = shadow_map.read();
  const glm::dmat4 place_of(moved.uv_depth_from_world), world_of = glm::inverse(glm::dmat4(still.uv_depth_from_world));
  const double floor = (place_of * glm::dvec4(0.0, 0.0, 0.0, 1.0)).z, slack = 0.01 / moved.depth_range_ws;
  const int reach = static_cast<int>(0.9 / still.texel_size_ws);
  std::vector<bool> held;
  for (int y = kMapSide / 2 - reach; y < kMapSide / 2 + reach; ++y) {
    for (int x = kMapSide / 2 - reach; x < kMapSide / 2 + reach; ++x) {
      const glm::dvec4 uv = place_of * world_of * glm::dvec4((x + 0.5) / kMapSide, (y + 0.5) / kMapSide, 0.5, 1.0);
      const auto column = static_cast<std::size_t>(uv.x * kMapSide), row = static_cast<std::size_t>(uv.y * kMapSide);
      held.push_back(static_cast<double>(map.stored[row * kMapSide + column]) < floor - slack);
    }
  }
  return held;
}

double share_of(const std::vector<bool>& held) {
  return static_cast<double>(std::ranges::count(held, true)) / static_cast<double>(held.size());
}

TEST(BlendCasters, CoverTheirAlphaOfTheMapsTexels) {
  for (const float alpha : {0.0f, 0.05f, 0.3f, 0.5f, 0.9f, 1.0f}) {
    const scene::Scene scene = make_panes({alpha});
    EXPECT_EQ(share_of(find_held(scene, BlendCasters::kOpaque)), 1.0) << "as without the option";
    EXPECT_NEAR(share_of(find_held(scene, BlendCasters::kDither)), alpha, 1.0 / 64.0) << alpha;
    const std::vector<bool> hashed = find_held(scene, BlendCasters::kHashed);
    // Cells may be four texels large.
    const double a = static_cast<double>(alpha),
                 deviation = std::sqrt(4.0 * a * (1.0 - a) / static_cast<double>(hashed.size()));
    EXPECT_NEAR(share_of(hashed), a, 4.0 * deviation) << alpha;
  }
}

TEST(BlendCasters, OfTwoSheets_HashesDiffer_AndTheMatrixIsTheSame) {
  const scene::Scene two = make_panes({0.3f, 0.3f});
  EXPECT_NEAR(share_of(find_held(two, BlendCasters::kHashed)), 0.51, 0.02);
  EXPECT_EQ(find_held(two, BlendCasters::kDither), find_held(make_panes({0.3f}), BlendCasters::kDither))
      << "the second sheet hides behind the first";
}

TEST(BlendCasters, TheMatrixRepeatsEveryEightTexels_AndHalfOfItIsAChequerboard) {
  const std::vector<bool> held = find_held(make_panes({0.5f}), BlendCasters::kDither);
  const auto side = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(held.size()))));
  for (std::size_t i = 0; i + 8 * side + 8 < held.size(); ++i) {
    ASSERT_EQ(held[i], held[i + 8 * side]);
    if (i % side + 8 < side) ASSERT_EQ(held[i], held[i + 8]);
    if (i % side + 1 < side) ASSERT_NE(held[i], held[i + 1]);
    ASSERT_NE(held[i], held[i + side]);
  }
}

TEST(BlendCasters, HashesStayOnTheSurface_WhereTheMatrixMovesWithTheMap) {
  const scene::Scene scene = make_panes({0.3f});
  const auto count_changed = [&](BlendCasters casters) {
    const std::vector<bool> here = find_held(scene, casters), there = find_held(scene, casters, {3.0, -2.0});
    int changed = 0;
    for (std::size_t i = 0; i < here.size(); ++i) changed += here[i] != there[i] ? 1 : 0;
    return changed / static_cast<double>(here.size());
  };
  EXPECT_LT(count_changed(BlendCasters::kHashed), 0.02) << "places at the border of two cells are rounded";
  EXPECT_GT(count_changed(BlendCasters::kDither), 0.2);
}

TEST(BlendCasters, LeaveOtherMaterialsAlone) {
  for (scene::Scene scene : {load_builtin("cubes"), load_builtin("fence")}) {
    for (scene::Material& material : scene.materials)
      material.base_color.a = 0.3f;  // which says nothing of what is opaque
    Bench opaque(shared_context(), scene, 128, 16, 16);
    for (const BlendCasters casters : {BlendCasters::kHashed, BlendCasters::kDither}) {
      Bench other(shared_context(), scene, 128, 16, 16, {.blend_casters = casters});
      EXPECT_EQ(opaque.map().read().stored, other.map().read().stored);
    }
  }
}

TEST(BlendCasters, AreDrawnIntoMapsOfEveryShape_ButHashesNotIntoALogarithmicOne) {
  for (const char* name :
       {"lamp", "lantern", "avenue", "avenue_by_lispsm", "lantern_by_paraboloid", "avenue_by_logpsm"}) {
    scene::Scene scene = load_builtin(name);
    for (scene::Material& material : scene.materials)
      material.base_color.a = 0.3f, material.alpha_mode = scene::AlphaMode::kBlend;
    const auto count_empty = [&](BlendCasters casters) {
      Bench bench(shared_context(), scene, 128, 16, 16, {.blend_casters = casters});
      shared_context().require_no_gl_errors();
      std::ptrdiff_t empty = 0;
      for (int layer = 0; layer < bench.map().layers(); ++layer)
        empty += std::ranges::count(bench.map().read(layer).stored, 1.0f);
      return empty;
    };
    const std::ptrdiff_t opaque = count_empty(BlendCasters::kOpaque);
    EXPECT_GT(count_empty(BlendCasters::kDither), opaque) << name;
    if (std::string(name).ends_with("logpsm"))
      EXPECT_THROW(count_empty(BlendCasters::kHashed), Error);
    else
      EXPECT_GT(count_empty(BlendCasters::kHashed), opaque) << name;
  }
}

/// So many bars that fill a quarter of a pane's texture, cut out at an alpha of one half.
scene::Scene make_bars(int count) {
  constexpr int side = 1024;
  scene::Scene scene = make_panes({1.0f});
  scene::Texture bars{"bars", side, 1, std::vector<std::uint8_t>(4 * static_cast<std::size_t>(side), 0)};
  for (int x = 0; x < side; ++x)
    bars.rgba[4 * static_cast<std::size_t>(x) + 3] = x % (side / count) < side / count / 4 ? 255 : 0;
  scene.textures.push_back(std::move(bars));
  scene.materials[1].alpha_mode = scene::AlphaMode::kMask;
  scene.materials[1].base_color_texture = 0;
  for (scene::Vertex& vertex : scene.meshes[1].vertices)
    vertex.uv = {0.5f * (vertex.position_ws.x + 1.0f), 0.5f * (vertex.position_ws.z + 1.0f)};
  return scene;
}

// What the program does with MASK: rays read the texture itself, the map one of its smaller levels, whose alpha is a
// mean and falls below the cutoff.
TEST(MaskCasters, LoseTheirCoverageInAMapThatIsTooSmall_WhereRaysDoNot) {
  std::vector<double> in_map;
  for (const int count : {8, 32, 64, 128}) {
    const scene::Scene scene = make_bars(count);
    truth::ReceiverImage receivers{512, 1, {}};
    for (int i = 0; i < 512; ++i)
      receivers.points.push_back({{(static_cast<float>(i) + 0.5f) / 256.0f - 1.0f, 0.0f, 0.1f}, {0, 1, 0}, true});
    const std::vector<float> lit = truth::trace_hard(truth::Occluders(scene::list_occluders(scene)), receivers,
                                                     truth::AreaLight::make_sun({0.0, 1.0, 0.0}, 0.0));
    EXPECT_NEAR(static_cast<double>(std::ranges::count(lit, 0.0f)) / 512.0, 0.25, 0.02) << count;
    in_map.push_back(share_of(find_held(scene, BlendCasters::kOpaque)));
    std::printf("%d bars: %.3f of the map's texels\n", count, in_map.back());
  }
  EXPECT_NEAR(in_map.front(), 0.25, 0.05);
  EXPECT_LT(in_map.back(), 0.01) << "a bar is a quarter of a texel";
}

TEST(BlendCasters, AreNamedWithTheMap) {
  EXPECT_EQ(render::describe_map({}), "d32f");
  EXPECT_EQ(render::describe_map({GL_DEPTH_COMPONENT16, {true, 30.5}, BlendCasters::kDither}),
            "d16 perspective 30.5 reversed dither");
  for (const std::string& name : render::blend_caster_names())
    EXPECT_EQ(render::to_string(render::parse_blend_casters(name)), name);
}

}  // namespace
}  // namespace shadowbench::test
