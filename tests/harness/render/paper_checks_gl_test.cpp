// What the papers say of the prefiltered maps, on the built-in scenes: their memory, and that a bound is never darker
// than percentage-closer filtering.

#include <algorithm>
#include <cmath>
#include <tuple>

#include "filters/model.h"
#include "filters/percentage_closer.h"
#include "tests/harness/render/bench_fixture.h"

namespace shadowbench::test {
namespace {

double mib_with_mips(const std::string& filter, int size) {
  const scene::Scene scene = load_builtin("cubes");
  Bench bench(shared_context(), scene, size, 16, 9);
  const filters::FilterRequest request = catalogue().parse_requests(filter).front();
  render::FilterPasses passes(bench.shaders(), request, bench.map(), bench.light(request));
  passes.prefilter(bench.map());
  const std::int64_t bytes_per_texel =
      passes.measure_cost(bench.shaders(), bench.gbuffer(), bench.map()).bytes_per_texel;
  std::int64_t bytes = 0;
  for (std::int64_t side = size; side > 0; side /= 2) bytes += side * side * bytes_per_texel;
  return static_cast<double>(bytes) / 1048576.0;
}

/// Annen et al. 2008, figure 1: a map of 2048^2 with mips takes 21.3 MiB as ESM and 42.7 MiB as VSM.
TEST(Memory, OfMapsWithMips_IsWhatAnnenEtAlState) {
  EXPECT_NEAR(mib_with_mips("esm", 2048), 21.3, 0.05);
  EXPECT_NEAR(mib_with_mips("vsm", 2048), 42.7, 0.05);
}

class Bound : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

/// Donnelly and Lauritzen 2006, eq. 5: Chebyshev's inequality bounds the lit share from above. So does the mean of
/// exponentials that ESM takes. What single precision can make of it is the model's propagated bound.
TEST_P(Bound, IsNeverDarkerThanPercentageCloserFiltering) {
  const auto& [scene_name, filter] = GetParam();
  const scene::Scene scene = load_builtin(scene_name);
  Bench bench(shared_context(), scene);
  const filters::FilterRequest request = catalogue().parse_requests(filter).front();
  const std::vector<float> image = bench.draw(request);
  const filters::DepthMap map = bench.map().read();
  static const gl::GlSurvey measured = gl::survey_gl(shared_context());
  const filters::GlAccuracy accuracy{measured.exp_ulp,
                                     static_cast<double>(std::min(measured.rg32f.bits, measured.r32f.bits))};
  const filters::ModelInput input{request.spec, request.values, map, accuracy, 7};
  const auto model = filters::make_model(request.spec);
  const auto tracked = model->prepare(input, filters::Precision::kTracked);
  const filters::PercentageCloser closer(*model->kernel(request.values), map);
  double darkest_exact = 0.0, darkest_gpu = 0.0;
  int darker = 0, between = 0;
  for (const filters::Receiver& r : bench.receivers(request)) {
    const double pcf = closer.at(r);
    const filters::ModelResult result = tracked->at(r);
    darkest_exact = std::min(darkest_exact, result.visibility - pcf);
    if (result.excused) continue;
    const double below = static_cast<double>(image[bench.index(r)]) - pcf;
    darkest_gpu = std::min(darkest_gpu, below);
    darker += below < -(result.bound + 1e-6) ? 1 : 0;
    between += pcf > 0.01 && pcf < 0.99 ? 1 : 0;
  }
  std::printf("%s %s: darkest against PCF %.2g in double, %.2g on the GPU, %d receivers in penumbrae\n",
              scene_name.c_str(), filter.c_str(), darkest_exact, darkest_gpu, between);
  EXPECT_GT(between, 500);
  // The prefilter's weights are single precision and sum to 1 within their rounding.
  EXPECT_GE(darkest_exact, -1e-6);
  EXPECT_EQ(darker, 0);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, Bound,
                         ::testing::Combine(::testing::ValuesIn(builtin_scenes()),
                                            ::testing::Values("vsm:bleed_reduction=0",
                                                              "vsm:bleed_reduction=0,slope_variance=0",
                                                              "vsm:bleed_reduction=0,min_variance=0",
                                                              "vsm:bleed_reduction=0,radius=9", "esm", "esm:c=20")),
                         [](const auto& each) {
                           std::string name = std::get<0>(each.param) + "_" + std::get<1>(each.param);
                           for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
                           return name;
                         });

}  // namespace
}  // namespace shadowbench::test
