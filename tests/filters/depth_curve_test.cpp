#include "filters/depth_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace shadowbench::filters {
namespace {

constexpr DepthPlanes kPlanes{0.01, 1e4};

TEST(DepthCurve, EndsAtThePlanes) {
  EXPECT_NEAR(depth_of_distance(0.01, kPlanes, false), 0.0, 1e-15);
  EXPECT_NEAR(depth_of_distance(1e4, kPlanes, false), 1.0, 1e-15);
  EXPECT_NEAR(depth_of_distance(0.01, kPlanes, true), 1.0, 1e-15);
  EXPECT_NEAR(depth_of_distance(1e4, kPlanes, true), 0.0, 1e-15);
}

TEST(DepthCurve, ReversedIsOneLess_AndTheInverseGoesBack) {
  for (const double d : {0.02, 1.0, 37.0, 9000.0}) {
    EXPECT_NEAR(depth_of_distance(d, kPlanes, false) + depth_of_distance(d, kPlanes, true), 1.0, 1e-15);
    for (const bool reversed : {false, true}) {
      EXPECT_NEAR(distance_of_depth(depth_of_distance(d, kPlanes, reversed), kPlanes, reversed), d, 1e-9 * d) << reversed;
    }
  }
}

/// The step is the curve's inverse slope times the quantum.
TEST(DepthCurve, Step_IsWhatOneQuantumMovesTheDistance) {
  for (const double d : {0.5, 10.0, 100.0}) {
    for (const bool reversed : {false, true}) {
      const double depth = depth_of_distance(d, kPlanes, reversed);
      const double quantum = depth_quantum(depth, {24, false});
      const double moved = std::abs(distance_of_depth(depth + quantum, kPlanes, reversed) - distance_of_depth(depth - quantum, kPlanes, reversed));
      EXPECT_NEAR(distance_step(d, kPlanes, {24, false}, reversed), 0.5 * moved, 0.01 * moved) << d;
    }
  }
}

TEST(DepthCurve, Quantum_IsTheFormats) {
  EXPECT_EQ(depth_quantum(0.3, {16, false}), 1.0 / 65535.0);
  for (const float depth : {0.3f, 0.75f, 1e-4f}) {
    EXPECT_EQ(depth_quantum(static_cast<double>(depth), {}), static_cast<double>(std::nextafter(depth, 2.0f) - depth));
  }
}

TEST(DepthCurve, ReversedFloat_IsRelativelyExactEverywhere_StandardIsNot) {
  for (const double d : {0.02, 1.0, 100.0, 5000.0}) EXPECT_LE(distance_step(d, kPlanes, {}, true) / d, std::exp2(-22)) << d;
  EXPECT_GT(distance_step(5000.0, kPlanes, {}, false) / 5000.0, 0.01);
}

}  // namespace
}  // namespace shadowbench::filters
