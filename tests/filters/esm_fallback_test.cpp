// Exponential shadow maps where their assumption fails: texels under the kernel lie behind the receiver.

#include <gtest/gtest.h>

#include "filters/catalogue.h"
#include "filters/model.h"

namespace shadowbench::filters {
namespace {

/// Looks up a receiver at depth 0.5 in the middle of a map, of which the left half lies at one depth and the right half
/// at another.
double look_up_between(const std::string& text, float left, float right) {
  constexpr int kHalvesSide = 32;
  DepthMap map{kHalvesSide, {}};
  for (int i = 0; i < kHalvesSide * kHalvesSide; ++i)
    map.stored.push_back(i % kHalvesSide < kHalvesSide / 2 ? left : right);
  const FilterRequest request = Catalogue(SHADOWBENCH_SOURCE_DIR "/filters").parse_requests(text).front();
  const ModelInput input{request.spec, request.values, map, {}, 0};
  Receiver r;
  r.depth = r.depth_unbiased = 0.5f;
  return make_model("esm")->prepare(input, Precision::kDouble)->at(r).visibility;
}

TEST(EsmFallback, BetweenABlockerAndWhatLiesBehind_IsPercentageCloser) {
  for (const std::string combine : {"linear", "log"}) {
    const std::string esm = "esm:c=40,combine=" + combine;
    EXPECT_EQ(look_up_between(esm, 0.2f, 0.9f), 1.0) << combine;
    EXPECT_NEAR(look_up_between(esm + ",fallback=percentage-closer", 0.2f, 0.9f), 0.5, 1e-6) << combine;
  }
}

TEST(EsmFallback, WhereTheTestHolds_ChangesNothing) {
  for (const float left : {0.2f, 0.45f, 0.5f})
    EXPECT_EQ(look_up_between("esm:fallback=percentage-closer", left, 0.501f), look_up_between("esm", left, 0.501f));
}

}  // namespace
}  // namespace shadowbench::filters
