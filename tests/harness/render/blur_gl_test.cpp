// The prefilter against the same sums in single precision, term by term, and what it reads outside the map.

#include "filters/kernel.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kBlurredSide = 96;

/// Blurs one axis of a square image of one channel: every product and every sum rounded to float, in the kernel's
/// order. Texels nearer to the edge than the radius stay 0.
std::vector<float> blur(const std::vector<float>& from, int radius, int step_x, int step_y) {
  const std::vector<float> weights = filters::gaussian_weights(radius);
  std::vector<float> to(from.size(), 0.0f);
  for (int y = step_y * radius; y < kBlurredSide - step_y * radius; ++y) {
    for (int x = step_x * radius; x < kBlurredSide - step_x * radius; ++x) {
      float sum = 0.0f;
      for (int i = -radius; i <= radius; ++i)
        sum += weights[static_cast<std::size_t>(i + radius)] *
               from[static_cast<std::size_t>((y + i * step_y) * kBlurredSide + x + i * step_x)];
      to[static_cast<std::size_t>(y * kBlurredSide + x)] = sum;
    }
  }
  return to;
}

class Blur : public ::testing::TestWithParam<int> {};

TEST_P(Blur, IsTheSumOfItsTermsToTheBit) {
  const int radius = GetParam();
  const scene::Scene scene = load_builtin("fence");
  Bench bench(shared_context(), scene, kBlurredSide, 64, 36);
  const auto request = catalogue().parse_requests("esm:radius=" + std::to_string(radius)).front();
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  const std::vector<float> blurred = passes.encoded_map()->read().values;
  const std::vector<float> encoded = passes.encoded_map()->read_before_blur(bench.map()).values;
  const std::vector<float> expected = blur(blur(encoded, radius, 1, 0), radius, 0, 1);
  for (int y = radius; y < kBlurredSide - radius; ++y)
    for (int x = radius; x < kBlurredSide - radius; ++x) {
      const auto i = static_cast<std::size_t>(y * kBlurredSide + x);
      ASSERT_EQ(blurred[i], expected[i]) << "radius " << radius << ", texel " << x << ", " << y;
    }
}

INSTANTIATE_TEST_SUITE_P(Radii, Blur, ::testing::Range(1, 17));

}  // namespace
}  // namespace shadowbench::test
