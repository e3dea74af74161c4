#include <gtest/gtest.h>

#include <cmath>

#include "filters/depth_map.h"
#include "tests/filters/perspective_depth.h"

namespace shadowbench::filters {
namespace {

constexpr DepthPlanes kPlanes{0.01, 1e4};

/// Every curve is exact at its ends, so that what was cleared is the far plane and nothing else is.
TEST(DepthCurve, InSinglePrecision_IsExactAtItsEnds_Rises_AndGoesBack) {
  for (const double ratio : {1.0, 1.3, 7.7, 1234.567, 1e5, 1e7}) {
    for (const bool reversed : {false, true}) {
      const DepthCurve curve{reversed, ratio};
      EXPECT_EQ(curve.linear(curve.far_plane()), 1.0f) << ratio << reversed;
      EXPECT_EQ(curve.linear(1.0f - curve.far_plane()), 0.0f) << ratio << reversed;
      EXPECT_NEAR(curve.store(1.0f), curve.far_plane(), 2e-7f) << ratio << reversed;
      EXPECT_EQ(curve.store(0.0f), 1.0f - curve.far_plane()) << ratio << reversed;
      for (const float z : {0.001f, 0.2f, 0.5f, 0.93f}) {
        EXPECT_TRUE(curve.is_lit(curve.store(z), curve.store(1.5f * z)));
        const double step = depth_step(static_cast<double>(z), curve, {});
        EXPECT_NEAR(static_cast<double>(curve.linear(curve.store(z))), static_cast<double>(z), 4.0 * step + 2e-7)
            << ratio << reversed << z;
      }
    }
  }
}

TEST(DepthCurve, BeforeTheNearPlane_IsLitByAllThatThereIs) {
  for (const bool reversed : {false, true}) {
    const DepthCurve curve{reversed, 1000.0};
    for (const float z : {-1e-4f, -0.001f, -5.0f}) EXPECT_TRUE(curve.is_lit(curve.store(z), curve.store(0.0f))) << z;
  }
}

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
      EXPECT_NEAR(distance_of_depth(depth_of_distance(d, kPlanes, reversed), kPlanes, reversed), d, 1e-9 * d)
          << reversed;
    }
  }
}

/// The step is the curve's inverse slope times the quantum.
TEST(DepthCurve, Step_IsWhatOneQuantumMovesTheDistance) {
  for (const double d : {0.5, 10.0, 100.0}) {
    for (const bool reversed : {false, true}) {
      const double depth = depth_of_distance(d, kPlanes, reversed);
      const double quantum = depth_quantum(depth, {24, false});
      const double moved = std::abs(distance_of_depth(depth + quantum, kPlanes, reversed) -
                                    distance_of_depth(depth - quantum, kPlanes, reversed));
      EXPECT_NEAR(distance_step(d, kPlanes, {24, false}, reversed), 0.5 * moved, 0.01 * moved) << d;
    }
  }
}

TEST(DepthCurve, Quantum_IsTheFormats) {
  EXPECT_EQ(depth_quantum(0.3, {16, false}), 1.0 / 65535.0);
  for (const float depth : {0.3f, 0.75f, 1e-4f})
    EXPECT_EQ(depth_quantum(static_cast<double>(depth), {}), static_cast<double>(std::nextafter(depth, 2.0f) - depth));
}

TEST(DepthCurve, ReversedFloat_IsRelativelyExactEverywhere_StandardIsNot) {
  for (const double d : {0.02, 1.0, 100.0, 5000.0})
    EXPECT_LE(distance_step(d, kPlanes, {}, true) / d, std::exp2(-22)) << d;
  EXPECT_GT(distance_step(5000.0, kPlanes, {}, false) / 5000.0, 0.01);
}

}  // namespace
}  // namespace shadowbench::filters
