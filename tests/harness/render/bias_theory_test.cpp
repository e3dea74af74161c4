#include "harness/render/bias/bias_theory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadowbench::render {
namespace {

filters::Receiver make_receiver(float du, float dv, float n_dot_l) {
  filters::Receiver r;
  r.depth_per_texel = {du, dv};
  r.n_dot_l = n_dot_l;
  return r;
}

const SweptMode& find_mode(const std::string& name) {
  for (const SweptMode& mode : swept_modes())
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
