#include "harness/render/bias.h"

#include "filters/front_matter.h"
#include "tests/test_files.h"

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
  EXPECT_NEAR(in_world(amount, make_frustum()), 0.06, 1e-15);
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
  EXPECT_THAT(error_of([&] { require_usable(rule, vsm); }), is_error(ErrorKind::kUsage, "'vsm'"));
}

TEST(Bias, Mistakes_AreNamed) {
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_THAT(error_of([&] { parse_bias({text}); }), is_error(ErrorKind::kUsage, words)) << text;
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

filters::Receiver make_receiver(float du, float dv, float n_dot_l) {
  filters::Receiver r;
  r.depth_per_texel = {du, dv};
  r.n_dot_l = n_dot_l;
  return r;
}

const BiasMode& find_mode(const std::string& name) {
  for (const BiasMode& mode : swept_modes())
    if (mode.name == name) return mode;
  throw std::runtime_error(name);
}

TEST(BiasTheory, Amounts_LiftThePlaneByItsGainUnderTheKernel) {
  const BiasTheory theory = make_theory(2.0, make_receiver(-0.03f, 0.04f, 0.5f));
  EXPECT_NEAR(theory.depth(), 0.14, 1e-7);
  EXPECT_NEAR(find_mode("constant").amount(theory), 0.14, 1e-7);
  EXPECT_NEAR(find_mode("slope").amount(theory), 0.28, 1e-7);
  EXPECT_NEAR(find_mode("plane").amount(theory), 2.0, 1e-12);
  EXPECT_NEAR(find_mode("normal-offset").amount(theory), 2.8, 1e-6);
  EXPECT_NEAR(find_mode("polygon-offset").amount(theory), 3.5, 1e-6);
}

TEST(BiasTheory, Rules_AreThoseOfTheCommandLine) {
  EXPECT_EQ(find_mode("constant").make_rule(0.25).constant.depth, 0.25);
  EXPECT_EQ(find_mode("polygon-offset").make_rule(3.0).map.polygon_factor, 3.0);
  EXPECT_TRUE(find_mode("midpoint").make_rule(9.0).map.midpoint);
}

TEST(BiasTheory, Percentile_IsOfWhatEachModeNeeds) {
  std::vector<filters::Receiver> receivers(16, make_receiver(0.1f, 0.1f, 0.9f));  // diagonal: the factor is 2
  receivers.push_back(make_receiver(0.5f, 0.0f, 0.5f));                           // steep along u: the factor is 1
  receivers.push_back(make_receiver(0.0f, 0.0f, 1.0f));
  EXPECT_NEAR(find_theory(find_mode("constant"), 1.0, receivers, 1.0).slope_per_texel, 0.5, 1e-7);
  EXPECT_NEAR(find_theory(find_mode("polygon-offset"), 1.0, receivers, 1.0).slope_per_texel, 0.2, 1e-7);
  EXPECT_NEAR(find_theory(find_mode("constant"), 1.0, receivers, 0.5).slope_per_texel, 0.2, 1e-7);
  EXPECT_EQ(find_theory(find_mode("slope"), 1.0, receivers, 0.0).n_dot_l, 1.0);  // needs nothing, not 0 / 0
}

}  // namespace
}  // namespace shadowbench::render
