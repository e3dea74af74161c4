#include "harness/run/bias_rule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "filters/error.h"
#include "filters/front_matter.h"

namespace shadowbench::run {
namespace {

TEST(Bias, DefaultCoversTheKernelPlusOneTexel) {
  const auto spec = filters::load_filter(SHADOWBENCH_SOURCE_DIR "/filters/poisson.glsl");
  const render::Bias bias = resolve_bias(parse_bias({}), spec, {{"radius", 5.0}});
  EXPECT_DOUBLE_EQ(bias.slope_texels, 6.0);
  EXPECT_GT(bias.constant_depth, 0.0);
}

TEST(Bias, None_IsNothingAtAll) {
  const BiasRule rule = parse_bias({"none"});
  EXPECT_EQ(rule.constant_depth, 0.0);
  EXPECT_EQ(rule.slope_kernels, 0.0);
  EXPECT_EQ(rule.slope_texels, 0.0);
  EXPECT_EQ(rule.normal_offset_texels, 0.0);
}

TEST(Bias, SeveralModes_AddUp) {
  const BiasRule rule = parse_bias({"slope:texels=2,depth=0.001", "constant:depth=0.002", "normal-offset:texels=1.5"});
  EXPECT_DOUBLE_EQ(rule.slope_texels, 2.0);
  EXPECT_DOUBLE_EQ(rule.constant_depth, 0.003);
  EXPECT_DOUBLE_EQ(rule.normal_offset_texels, 1.5);
}

TEST(Bias, Mistakes_AreNamed) {
  const auto expect = [](const std::string& text, const std::string& words) {
    try {
      parse_bias({text});
      ADD_FAILURE() << "accepted: " << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      EXPECT_THAT(error.message(), ::testing::HasSubstr(words));
    }
  };
  expect("slpe:texels=1", "did you mean 'slope'");
  expect("slope:texel=1", "did you mean 'texels'");
  expect("slope:texels=-1", "'-1'");
  expect("slope:texels=nan", "'nan'");
  expect("slope:texels=1m", "'1m'");
  expect("slope", "no amount given");
}

}  // namespace
}  // namespace shadowbench::run
