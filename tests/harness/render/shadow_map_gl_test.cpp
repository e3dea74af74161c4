// Casters that one sees through in the depth map: how many of its texels hold them, and which.

// Depth maps of every format, drawn by the GL through a perspective projection: planes at known distances keep the
// precision that the format and the depth's curve allow.

// Several samples of depth a texel, of which the mean of what encode() makes is stored.

#include "filters/front_matter.h"
#include "harness/render/shadow_map.h"
#include "tests/filters/perspective_depth.h"
#include "tests/harness/render/bench_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::test {
namespace {

using render::BlendCasters;

constexpr int kMapSide = 256;  // texels

/// Panes of 2 x 2 m, one over the other by half a metre, above a floor of 4 x 4 m under a sun at the zenith.
scene::Scene make_panes(std::vector<float> alphas) {
  scene::Scene scene = scene::make_scene_of({scene::make_plane({4.0f, 4.0f}, 1)}, scene::kSunAtZenith,
                                            {scene::look_down({0.0f, 6.0f, 0.1f})});
  for (const float alpha : alphas) {
    scene.materials.push_back({.name = "pane", .base_color = {1, 1, 1, alpha}, .alpha_mode = scene::AlphaMode::kBlend});
    const double height = 0.5 * static_cast<double>(scene.meshes.size()) + 0.123;
    scene.meshes.push_back(scene::move_mesh(scene::make_plane({2.0f, 2.0f}, 4), {0.0, height, 0.0}));
    scene.meshes.back().material = static_cast<int>(scene.materials.size()) - 1;
  }
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
    Bench opaque(scene, 128, 16, 16);
    for (const BlendCasters casters : {BlendCasters::kHashed, BlendCasters::kDither}) {
      Bench other(scene, 128, 16, 16, {.blend_casters = casters});
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
      Bench bench(scene, 128, 16, 16, {.blend_casters = casters});
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
  }
  EXPECT_NEAR(in_map.front(), 0.25, 0.05);
  EXPECT_LT(in_map.back(), 0.01) << "a bar is a quarter of a texel";
}

TEST(BlendCasters, AreNamedWithTheMap) {
  EXPECT_EQ(render::describe_map({}), "d32f");
  EXPECT_EQ(render::describe_map({GL_DEPTH_COMPONENT16, {true, 30.5}, BlendCasters::kDither}),
            "d16 perspective 30.5 reversed dither");
}

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
  scene::Mesh wall;
  const float half = 1.5f * distance_m;
  for (const glm::vec2& corner :
       {glm::vec2(-half, -half), glm::vec2(half, -half), glm::vec2(half, half), glm::vec2(-half, half)})
    wall.vertices.push_back({{corner.x, corner.y, -distance_m}, {0.0f, 0.0f, 1.0f}, {}});
  wall.indices = {0, 1, 2, 0, 2, 3};
  return scene::make_scene_of({wall});
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
      for (const double d : spread_distances(planes)) {
        const double allowed = theoretical_error(d, planes, c);
        if (allowed > 0.1 * d) continue;  // the curve is not straight over one step
        EXPECT_LE(measure_error(shaders, map, planes, d), allowed)
            << render::describe_map(map.settings()) << " far/near " << ratio << " at " << d;
      }
    }
  }
}

TEST(DepthPrecision, FormatOfOtherBits_IsRefused) {
  EXPECT_NO_THROW(render::require_depth_bits(GL_DEPTH_COMPONENT16, 16));
  EXPECT_THAT(error_of([] { render::require_depth_bits(GL_DEPTH_COMPONENT24, 32); }),
              is_error(ErrorKind::kUsage, "d24 in 32 bits"));
}

TEST(DepthMapSize, EightThousand_IsDrawnWhole) {
  Bench bench(load_builtin("cubes"), 8192, 32, 18, {GL_DEPTH_COMPONENT16});
  EXPECT_EQ(bench.map().bytes(), std::int64_t{8192} * 8192 * 2);
  const filters::DepthMap map = bench.map().read();
  const auto filled = std::count_if(map.stored.begin(), map.stored.end(), [](float d) { return d < 1.0f; });
  EXPECT_GT(static_cast<double>(filled), 0.1 * 8192 * 8192);
}

constexpr int kSampledSide = 128, kFiner = 4;

filters::FilterRequest make_sampled(int samples, const std::string& encoded = "e.depth", const char* lines = "") {
  return filters::request_of_file(
      filters::write_filter(fmt::format("store = \"r32f\"\nsamples = {}\n{}", samples, lines),
                            "vec4 encode(EncodeInput e) { return vec4(" + encoded + "); }\n" +
                                "float visibility(Receiver r) { return fetch_map(r, vec2(0.0)).x; }\n"),
      "sampled.glsl");
}

std::vector<float> encode(Bench& bench, const filters::FilterRequest& request) {
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  std::vector<float> values = passes.encoded_map()->read();
  shared_context().require_no_gl_errors();
  return values;
}

/// The mean depth over each texel, from a map of 16 texels for one.
std::vector<float> mean_depth(Bench& bench, const scene::Scene& scene, const render::MapSettings& settings) {
  render::ShadowMap fine(kSampledSide * kFiner, settings);
  fine.draw(bench.shaders(), render::Geometry(scene), bench.frustum());
  const std::vector<float> stored = fine.read().stored;
  std::vector<float> mean(static_cast<std::size_t>(kSampledSide) * kSampledSide);
  for (int y = 0; y < kSampledSide * kFiner; ++y)
    for (int x = 0; x < kSampledSide * kFiner; ++x)
      mean[static_cast<std::size_t>(y / kFiner * kSampledSide + x / kFiner)] +=
          settings.curve.linear(stored[static_cast<std::size_t>(y * kSampledSide * kFiner + x)]) / (kFiner * kFiner);
  return mean;
}

double rms(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2.0);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

class DepthSamples : public ::testing::TestWithParam<render::MapSettings> {};

TEST_P(DepthSamples, HaveAMean_NearTheMeanOverTheTexel) {
  const scene::Scene scene = load_builtin("stack");
  Bench bench(scene, kSampledSide, 160, 90, GetParam());
  const std::vector<float> mean = mean_depth(bench, scene, GetParam());
  const double one = rms(encode(bench, make_sampled(1)), mean), four = rms(encode(bench, make_sampled(4)), mean);
  EXPECT_GT(one, 0.01);
  EXPECT_LT(four, 0.4 * one) << one;
}

INSTANTIATE_TEST_SUITE_P(Maps, DepthSamples,
                         ::testing::Values(render::MapSettings{},
                                           render::MapSettings{GL_DEPTH_COMPONENT32F, {true, 1.0}},
                                           render::MapSettings{GL_DEPTH_COMPONENT24, {false, 20.0}}));

/// The samples follow what is drawn into the map: its bias, another map's contents, and values from elsewhere.
TEST(DepthSamplesOfAMap, FollowTheMap) {
  Bench bench(load_builtin("stack"), kSampledSide, 160, 90);
  const std::vector<float> drawn = encode(bench, make_sampled(4));
  bench.redraw({.polygon_factor = 4.0});
  EXPECT_GT(rms(encode(bench, make_sampled(4)), drawn), 1e-3);
  bench.redraw({.midpoint = true});
  EXPECT_LT(rms(encode(bench, make_sampled(4)), encode(bench, make_sampled(1))), 1e-6);
  std::vector<float> ramp(static_cast<std::size_t>(kSampledSide) * kSampledSide);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<float>(i) / static_cast<float>(ramp.size());
  bench.map().upload(ramp);
  EXPECT_EQ(encode(bench, make_sampled(4)), ramp);
}

TEST(DepthSamplesOfAMap, OfLogarithms_GiveTheLogarithmOfTheMean) {
  Bench bench(load_builtin("stack"), kSampledSide, 160, 90);
  std::vector<float> expected = encode(bench, make_sampled(4, "exp(8.0 * e.depth)"));
  for (float& value : expected) value = std::log(value);
  EXPECT_LT(rms(encode(bench, make_sampled(4, "8.0 * e.depth", "combine = \"log\"\n")), expected), 1e-5);
}

TEST(DepthSamplesOfAMap, AreCounted) {
  Bench bench(load_builtin("stack"), kSampledSide, 160, 90);
  const filters::FilterRequest request = make_sampled(4);
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  const render::FilterCost cost = passes.measure_cost(bench.gbuffer(), bench.map());
  EXPECT_EQ(cost.passes, 4);
  EXPECT_EQ(cost.prefilter_texels, (4 + 1) * kSampledSide * kSampledSide);
}

TEST(DepthSamplesOfAMap, MoreThanTheGlGives_AreRefusedWithTheLine) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &most);
  if (most >= 16) GTEST_SKIP() << "this GL gives " << most << " samples";
  Bench bench(load_builtin("ball"), kSampledSide, 64, 36);
  EXPECT_THAT(error_of([&] { encode(bench, make_sampled(16)); }),
              is_error(ErrorKind::kFilter, "sampled.glsl:6: ",
                       fmt::format("samples = 16: this GL gives at most {} samples of depth a texel", most)));
}

}  // namespace
}  // namespace shadowbench::test
