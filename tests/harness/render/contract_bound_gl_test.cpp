// What filters of the kind `bound` promise: more light than percentage-closer filtering with their kernel, or as much.

#include <cstdio>

#include "filters/percentage_closer.h"
#include "tests/harness/render/analytic_floor.h"

namespace shadowbench::test {
namespace {

using filters::FilterRequest;
using filters::Kernel;
using filters::Reconstruction;

/// The largest error that single precision makes of a bound over the depths of these floors, where they keep their
/// defaults: it is what the filters' models are held to as well (model_agreement_gl_test.cpp).
constexpr double kRounding = 2e-3;

/// Gives the kernel that a filter averages with: its model names it; without one it is that of the prefilter that its
/// front matter asks for.
Kernel kernel_of(const FilterRequest& request) {
  if (const auto kernel = filters::find_kernel(request.spec, request.values)) return *kernel;
  const bool nearest = filters::text_or(request.values, "sample", "nearest") == "nearest";
  return Kernel::make_gaussian(filters::prefilter_radius_texels(request.spec, request.values),
                               nearest ? Reconstruction::kNearest : Reconstruction::kBilinear);
}

/// A corner, an edge below it that the corner's shadow crosses, and bars of one texel: up to three depths meet in a
/// kernel.
std::vector<Caster> make_layers() {
  constexpr float kFar = 1e4f;
  return {{glm::vec2(-kFar), {0.0f, 2.0f}, 24.0f},
          {{-kFar, -kFar}, {kFar, -1.0f}, 8.0f},
          {{2.0f, -kFar}, {3.0f, kFar}, 16.0f}};
}

class BoundContract : public ::testing::TestWithParam<std::string> {};

TEST_P(BoundContract, IsNeverDarkerThanPcfOfItsKernel_OnLayers) {
  FilterRequest request = request_of(GetParam());
  if (!request.spec.bound_at_zero.empty()) request.values[request.spec.bound_at_zero] = 0.0;
  AnalyticFloor floor(filters::radius_texels(request.spec, request.values), make_layers());
  const std::vector<float> image = floor.bench().draw(request);
  const filters::DepthMap map = floor.bench().map().read();
  const filters::PercentageCloser closer(kernel_of(request), map);
  int between = 0;
  double darkest = 0.0;
  for (const filters::Receiver& r : floor.bench().receivers(request)) {
    const double pcf = closer.at(r);
    darkest = std::min(darkest, static_cast<double>(image[floor.bench().index(r)]) - pcf);
    between += pcf > 0.01 && pcf < 0.99 ? 1 : 0;
  }
  std::printf("%s: darkest against PCF %.2g, %d receivers in penumbrae\n", GetParam().c_str(), darkest, between);
  EXPECT_GT(between, 500);
  EXPECT_GE(darkest, -kRounding);
}

INSTANTIATE_TEST_SUITE_P(AllFilters, BoundContract, ::testing::ValuesIn(ids_of({filters::FilterKind::kBound})),
                         name_of);

}  // namespace
}  // namespace shadowbench::test
