// Several samples of depth a texel, of which the mean of what encode() makes is stored.

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "filters/front_matter.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kSampledSide = 128, kFiner = 4;

filters::FilterRequest make_sampled(int samples, const std::string& encoded = "e.depth", const char* lines = "") {
  filters::FilterRequest request;
  request.spec = filters::parse_filter(
      fmt::format("/*+++\ntitle = \"t\"\nsource = \"s\"\nkind = \"other\"\nstore = \"r32f\"\nsamples = {}\n{}+++*/\n"
                  "vec4 encode(EncodeInput e) {{ return vec4({}); }}\n"
                  "float visibility(Receiver r) {{ return fetch_map(r, vec2(0.0)).x; }}\n",
                  samples, lines, encoded),
      "sampled.glsl");
  for (const filters::ParamSpec& param : request.spec.params) request.values[param.name] = param.default_value;
  return request;
}

std::vector<float> encode(Bench& bench, const filters::FilterRequest& request) {
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  std::vector<float> values = passes.encoded_map()->read().values;
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
  Bench bench(shared_context(), scene, kSampledSide, 160, 90, GetParam());
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
  const scene::Scene scene = load_builtin("stack");
  Bench bench(shared_context(), scene, kSampledSide, 160, 90);
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
  const scene::Scene scene = load_builtin("stack");
  Bench bench(shared_context(), scene, kSampledSide, 160, 90);
  std::vector<float> expected = encode(bench, make_sampled(4, "exp(8.0 * e.depth)"));
  for (float& value : expected) value = std::log(value);
  EXPECT_LT(rms(encode(bench, make_sampled(4, "8.0 * e.depth", "combine = \"log\"\n")), expected), 1e-5);
}

TEST(DepthSamplesOfAMap, AreCounted) {
  const scene::Scene scene = load_builtin("stack");
  Bench bench(shared_context(), scene, kSampledSide, 160, 90);
  const filters::FilterRequest request = make_sampled(4);
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  const render::FilterCost cost = passes.measure_cost(bench.shaders(), bench.gbuffer(), bench.map());
  EXPECT_EQ(cost.passes, 4);
  EXPECT_EQ(cost.prefilter_texels, (4 + 1) * kSampledSide * kSampledSide);
}

TEST(DepthSamplesOfAMap, MoreThanTheGlGives_AreRefusedWithTheLine) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &most);
  if (most >= 16) GTEST_SKIP() << "this GL gives " << most << " samples";
  const scene::Scene scene = load_builtin("ball");
  Bench bench(shared_context(), scene, kSampledSide, 64, 36);
  try {
    encode(bench, make_sampled(16));
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFilter);
    EXPECT_EQ(error.where(), "sampled.glsl:6");
    EXPECT_EQ(error.message(), fmt::format("samples = 16: this GL gives at most {} samples of depth a texel", most));
  }
}

}  // namespace
}  // namespace shadowbench::test
