#include "harness/measure/stability_meter.h"

#include <gmock/gmock.h>

#include <cmath>

#include "filters/front_matter.h"
#include "filters/store_format.h"

namespace shadowbench::measure {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A filter whose names no code knows: it stores exp(2 k z) and its square, over depths up to `deepest`.
filters::FilterRequest make_request(double k, const std::string& store, const std::string& combine = "linear") {
  filters::FilterRequest request;
  request.spec = filters::parse_filter(
      "/*+++\ntitle = \"t\"\nsource = \"s\"\nkind = \"bound\"\nstore = [\"rg32f\", \"rg16f\", \"rg16\"]\ncombine = "
      "[\"linear\", \"log\"]\n"
      "moments = true\nexponent = \"k\"\nvariance_floor = \"least\"\nradius_texels = 0\n"
      "[param.k]\ndefault = 1.0\nmin = 0.5\nmax = 30.0\ntext = \"x\"\n[param.least]\ndefault = 1e-5\nmin = 0.0\nmax = "
      "1e-3\ntext = \"x\"\n+++*/\n"
      "vec4 encode(EncodeInput e) { return vec4(0); }\nfloat visibility(Receiver r) { return 1.0; }\n",
      "odd.glsl");
  request.values = filters::default_values(request.spec);
  request.values["k"] = k;
  request.values["store"] = store;
  request.values["combine"] = combine;
  return request;
}

/// What that filter's map would hold.
MapTrial make_map(double deepest, int* trials = nullptr) {
  return [=](const filters::ParamValues& values) {
    if (trials) ++*trials;
    const std::string store = filters::text_or(values, "store", "");
    const double exponent = 2.0 * 2.0 * filters::number(values, "k") * deepest;
    const bool logs = filters::combines_logs(values);
    const float stored = filters::round_to_store(static_cast<float>(logs ? exponent : std::exp(exponent)),
                                                 filters::store_precision(store));
    metrics::TexelHealth health{100, std::isinf(stored) ? 25 : 0, 0, std::nullopt, 0, 0.0};
    if (!std::isinf(stored)) health.largest = static_cast<double>(stored);
    return health;
  };
}

TEST(SafeExponent, IsTheTheoreticalLimit_WhateverTheExponentIsMadeOf) {
  for (const double deepest : {1.0, 0.8, 0.37}) {
    // Numbers up to 65520 round to 65504.
    const double theory = std::log(65520.0) / (4.0 * deepest);
    const auto safe = find_safe_exponent(make_request(20.0, "rg16f"), make_map(deepest));
    ASSERT_TRUE(safe);
    EXPECT_LE(*safe, theory);
    EXPECT_GT(*safe, 0.998 * theory) << deepest;
  }
  EXPECT_NEAR(*find_safe_exponent(make_request(20.0, "rg32f"), make_map(1.0)), 88.72 / 4.0, 0.02);
}

TEST(SafeExponent, OfASoundMap_IsTheSame) {
  EXPECT_EQ(find_safe_exponent(make_request(2.0, "rg16f"), make_map(1.0)),
            find_safe_exponent(make_request(20.0, "rg16f"), make_map(1.0)));
}

TEST(SafeExponent, StaysInItsRange) {
  EXPECT_EQ(find_safe_exponent(make_request(20.0, "rg32f"), make_map(0.1)), 30.0);
  EXPECT_FALSE(find_safe_exponent(make_request(20.0, "rg16f"), make_map(100.0)))
      << "even the smallest exponent overflows";
}

TEST(SafeExponent, OfLogarithms_IsNone) {
  EXPECT_FALSE(find_safe_exponent(make_request(20.0, "rg16f", "log"), make_map(1.0)));
}

TEST(Limits, Overflow_NamesTheLimitAndWhatKeepsIt) {
  const filters::FilterRequest request = make_request(20.0, "rg16f");
  const MapTrial map = make_map(1.0);
  const auto warnings = list_exceeded_limits("hall: odd", request, map(request.values), map);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0],
              AllOf(HasSubstr("hall: odd: 25 of its map's 100 texels (25 %) overflowed"),
                    HasSubstr("rg16f holds numbers up to 65504, which is e^11.09"), HasSubstr("choose k <= 2.77"),
                    HasSubstr("store=rg32f or combine=log"), Not(HasSubstr("rg16 "))));
}

/// At k = 25 the 32-bit store overflows too: what was tried and failed is not recommended.
TEST(Limits, RemediesThatFail_AreNotNamed) {
  const filters::FilterRequest request = make_request(25.0, "rg16f");
  const MapTrial map = make_map(1.0);
  const auto warnings = list_exceeded_limits("hall: odd", request, map(request.values), map);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], AllOf(Not(HasSubstr("rg32f")), HasSubstr("combine=log")));
}

TEST(Limits, SoundMap_HasNone_AndNothingIsTried) {
  int trials = 0;
  const filters::FilterRequest request = make_request(2.0, "rg16f");
  EXPECT_THAT(list_exceeded_limits("hall: odd", request, make_map(1.0)(request.values), make_map(1.0, &trials)),
              IsEmpty());
  EXPECT_EQ(trials, 0);
}

TEST(Limits, VarianceBeyondItsFloor_NamesTheFloorThatIsNeeded) {
  const auto map = [](const filters::ParamValues& values) {
    const bool half = filters::text_or(values, "store", "") == "rg16f";
    return metrics::TexelHealth{100, 0, 0, 1.0, 30, half ? -4.321e-4 : -1e-7};
  };
  const filters::FilterRequest request = make_request(2.0, "rg16f");
  const auto warnings = list_exceeded_limits("hall: odd", request, map(request.values), map);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], AllOf(HasSubstr("variance of 30 of its map's 100 texels below 0, down to -0.00043"),
                                 HasSubstr("least=1e-05"), HasSubstr("choose least >= 0.00044 or store=rg32f")));
  const filters::FilterRequest single = make_request(2.0, "rg32f");
  EXPECT_THAT(list_exceeded_limits("hall: odd", single, map(single.values), map), IsEmpty());
}

}  // namespace
}  // namespace shadowbench::measure
