#include "harness/render/bias/bias_rule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "filters/front_matter.h"

namespace shadowbench::render {
namespace {

/// A map whose texels are 2 cm wide and whose depth spans 10 m.
scene::LightFrustum make_frustum() {
  scene::LightFrustum frustum;
  frustum.texel_size_ws = 0.02;
  frustum.depth_range_ws = 10.0;
  return frustum;
}

render::Bias resolve(const std::vector<std::string>& texts) {
  const auto spec = filters::load_filter(SHADOWBENCH_SOURCE_DIR "/filters/poisson.glsl");
  return resolve_bias(parse_bias(texts), make_frustum(), spec, {{"radius", 5.0}});
}

TEST(Bias, DefaultCoversTheReachOfTheTaps) {
  const render::Bias bias = resolve({});
  EXPECT_DOUBLE_EQ(bias.plane_texels, 6.0);
  EXPECT_GT(bias.constant_depth, 0.0);
}

TEST(Bias, None_IsNothingAtAll) {
  const render::Bias bias = resolve({"none"});
  EXPECT_EQ(bias.constant_depth, 0.0);
  EXPECT_EQ(bias.slope_depth, 0.0);
  EXPECT_EQ(bias.plane_texels, 0.0);
  EXPECT_EQ(bias.normal_offset_texels, 0.0);
  EXPECT_FALSE(bias.receiver_plane);
  EXPECT_EQ(parse_bias({"none"}).map, render::MapBias());
}

TEST(Bias, Units_AddUpAlongTheLight) {
  // 2 texels are 4 cm, with 1 cm 5 cm: 0.005 of 10 m.
  EXPECT_NEAR(resolve({"constant:depth=0.001,texels=2,world=0.01"}).constant_depth, 0.006, 1e-15);
  EXPECT_NEAR(resolve({"slope:world=0.1"}).slope_depth, 0.01, 1e-15);
  EXPECT_NEAR(resolve({"normal-offset:texels=1,world=0.01"}).normal_offset_texels, 1.5, 1e-12);
  const BiasAmount amount{0.001, 2.0, 0.01};
  EXPECT_NEAR(amount.in_world(make_frustum()), 0.06, 1e-15);
}

TEST(Bias, SeveralModes_AddUp) {
  const BiasRule rule = parse_bias({"plane:texels=2,depth=0.001", "constant:depth=0.002", "normal-offset:texels=1.5"});
  EXPECT_DOUBLE_EQ(rule.plane_texels, 2.0);
  EXPECT_DOUBLE_EQ(rule.constant.depth, 0.003);
  EXPECT_DOUBLE_EQ(rule.normal_offset.texels, 1.5);
}

TEST(Bias, WhatTheMapHolds_IsSwitchedOn) {
  EXPECT_TRUE(parse_bias({"front-cull"}).map.cull_front);
  EXPECT_TRUE(parse_bias({"midpoint"}).map.midpoint);
  EXPECT_TRUE(parse_bias({"receiver-plane"}).receiver_plane);
  EXPECT_GT(parse_bias({"receiver-plane"}).constant.depth, 0.0) << "the slack that rounding needs";
  EXPECT_EQ(parse_bias({"receiver-plane:depth=0"}).constant.depth, 0.0);
  const render::MapBias map = parse_bias({"polygon-offset:factor=1.5,units=4"}).map;
  EXPECT_EQ(map.polygon_factor, 1.5);
  EXPECT_EQ(map.polygon_units, 4.0);
}

TEST(Bias, ReceiverPlane_IsRefusedForFiltersThatDoNotCompareTapByTap) {
  const BiasRule rule = parse_bias({"receiver-plane"});
  const auto vsm = filters::load_filter(SHADOWBENCH_SOURCE_DIR "/filters/vsm.glsl");
  EXPECT_NO_THROW(require_usable(rule, filters::load_filter(SHADOWBENCH_SOURCE_DIR "/filters/poisson.glsl")));
  EXPECT_NO_THROW(require_usable({}, vsm));
  try {
    require_usable(rule, vsm);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    EXPECT_THAT(error.message(), ::testing::HasSubstr("'vsm'"));
  }
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
  expect("slope:metres=1", "known: depth, texels, world");
  expect("none:depth=1", "takes none");
  expect("plane:kernels=inf", "'inf'");
  expect("slope:texels=-1", "'-1'");
  expect("slope:texels=nan", "'nan'");
  expect("slope:texels=1m", "'1m'");
  expect("slope", "no amount given");
}

}  // namespace
}  // namespace shadowbench::render
