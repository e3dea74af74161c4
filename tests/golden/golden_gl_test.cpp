// Golden images: visibility of each filter on each built-in scene. They catch what no property names.
// To accept a change on purpose: run this test with SHADOWBENCH_ACCEPT_GOLDENS=1, look at the pictures, commit them.

#include <cmath>
#include <cstdlib>

#include "harness/render/image_target.h"
#include "report/picture_io.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

constexpr int kWidth = 256;
constexpr int kHeight = 144;
constexpr int kMapSize = 512;

struct Difference {
  double mean = 0.0;
  double share = 0.0;  ///< of pixels that differ by more than a hardware weight's step
};

/// Hardware weights have 8 bits, so 2x2 PCF may be off by 1/128; a pixel whose tap lies on a tie or a texel's border
/// may flip, and under 0.5 % of pixels do (model_agreement_gl_test.cpp counts them).
constexpr float kPixelTolerance = 1.0f / 128.0f;
constexpr double kShareTolerance = 0.005;
constexpr double kMeanTolerance = 1e-3;

Difference compare(const report::Image& a, const report::Image& b) {
  Difference difference;
  for (std::size_t i = 0; i < a.texels.size(); ++i) {
    const float d = std::abs(a.texels[i] - b.texels[i]);
    difference.mean += static_cast<double>(d);
    if (!(d <= kPixelTolerance)) difference.share += 1.0;
  }
  const double count = static_cast<double>(a.texels.size());
  return {difference.mean / count, difference.share / count};
}

bool agrees(const Difference& d) { return d.mean <= kMeanTolerance && d.share <= kShareTolerance; }

std::filesystem::path golden_path(const std::string& scene, const std::string& filter) {
  return std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / "tests" / "golden" / scene / (filter + ".exr");
}

report::Image draw(const std::string& scene_name, const std::string& filter) {
  const scene::Scene scene = load_builtin(scene_name);
  Bench bench(shared_context(), scene, kMapSize, kWidth, kHeight);
  const std::vector<float> rows = bench.draw(catalogue().parse_requests(filter).front());
  report::Image image(kWidth, kHeight, 1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) *image.at(x, kHeight - 1 - y) = rows[static_cast<std::size_t>(y * kWidth + x)];
  }
  return image;
}

class Golden : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(Golden, ImageIsUnchanged) {
  const auto& [scene, filter] = GetParam();
  const report::Image image = draw(scene, filter);
  const std::filesystem::path path = golden_path(scene, filter);
  if (std::getenv("SHADOWBENCH_ACCEPT_GOLDENS")) {
    report::write_exr(path, {{"visibility", {"Y"}, image, true}}, {});
    return;
  }
  const report::Image golden = report::read_exr(path).parts.front().image;
  ASSERT_EQ(golden.width, kWidth);
  ASSERT_EQ(golden.height, kHeight);
  const Difference d = compare(image, golden);
  EXPECT_TRUE(agrees(d)) << "mean difference " << d.mean << ", share of changed pixels " << d.share;
}

INSTANTIATE_TEST_SUITE_P(AllFilters, Golden,
                         ::testing::Combine(::testing::ValuesIn(builtin_scenes()), ::testing::ValuesIn(filter_ids())),
                         [](const auto& each) { return std::get<0>(each.param) + "_" + std::get<1>(each.param); });

class GoldenOfScene : public ::testing::TestWithParam<std::string> {};

TEST_P(GoldenOfScene, NoFilterPassesAsAnother) {
  const std::vector<std::string> ids = filter_ids();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Difference d = compare(report::read_exr(golden_path(GetParam(), ids[i])).parts.front().image,
                                   report::read_exr(golden_path(GetParam(), ids[j])).parts.front().image);
      EXPECT_FALSE(agrees(d)) << ids[i] << " and " << ids[j] << ": mean " << d.mean << ", share " << d.share;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, GoldenOfScene, ::testing::ValuesIn(builtin_scenes()),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace shadowbench::test
