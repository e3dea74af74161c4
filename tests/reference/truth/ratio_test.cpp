// The share of the unshadowed light that arrives, against integrals of it on a grid.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "reference/truth/occluders.h"
#include "reference/truth/visibility.h"
#include "tests/reference/truth/shapes.h"

namespace shadowbench::truth {
namespace {

constexpr double kLampHeight = 3.0, kEdgeHeight = 2.0;

/// Whether a ray from a point of the floor passes the edge of the sheet, which is dark below x = 0.
bool passes(const glm::dvec3& from, const glm::dvec3& way) { return from.x + way.x * kEdgeHeight / way.y > 0.0; }

/// What arrives and what was sent, summed over the cells of a grid.
struct Sum {
  double sent = 0.0;
  double arrived = 0.0;

  void add(const ReceiverPoint& point, const glm::dvec3& way, double weight) {
    const double cosine = glm::dot(glm::normalize(way), glm::dvec3(point.normal_ws));
    if (cosine <= 0.0) return;
    sent += cosine * weight;
    arrived += passes(point.position_ws, way) ? cosine * weight : 0.0;
  }
};

double integrate_rectangle(const ReceiverPoint& point, double half_x, double half_z) {
  constexpr int kSteps = 20000, kStepsAlong = 50;  // across the edge it takes many
  Sum sum;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kStepsAlong; ++j) {
      const glm::dvec3 at(half_x * ((2.0 * i + 1.0) / kSteps - 1.0), kLampHeight,
                          half_z * ((2.0 * j + 1.0) / kStepsAlong - 1.0));
      const glm::dvec3 way = at - glm::dvec3(point.position_ws);
      sum.add(point, way, std::abs(way.y) / glm::length(way) / glm::dot(way, way));
    }
  }
  return sum.arrived / sum.sent;
}

double integrate_sphere(const ReceiverPoint& point, double radius) {
  constexpr int kSteps = 1500;
  const glm::dvec3 to_centre = glm::dvec3(0.0, kLampHeight, 0.0) - glm::dvec3(point.position_ws);
  const glm::dvec3 axis = glm::normalize(to_centre), u = glm::normalize(glm::cross(axis, glm::dvec3(0, 0, 1))),
                   v = glm::cross(axis, u);
  const double sine = radius / glm::length(to_centre), cap = 1.0 - std::sqrt(1.0 - sine * sine);
  Sum sum;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double cosine = 1.0 - cap * (i + 0.5) / kSteps, turn = 2.0 * std::numbers::pi * (j + 0.5) / kSteps;
      const double across = std::sqrt(1.0 - cosine * cosine);
      sum.add(point, cosine * axis + across * (std::cos(turn) * u + std::sin(turn) * v), 1.0);
    }
  }
  return sum.arrived / sum.sent;
}

/// Traces one pixel that is repeated, so that errors can be held against their own standard errors.
void expect_ratio(const AreaLight& light, const ReceiverPoint& point,
                  const std::function<double(const ReceiverPoint&)>& integrate) {
  const Occluders occluders(std::vector<OccluderMesh>{make_sheet(-40.0, 0.0, -40.0, 40.0, kEdgeHeight)});
  ReceiverImage image{16, 4, std::vector<ReceiverPoint>(64, point)};
  const TracedVisibility traced = trace_area(occluders, image, light, {.standard_error = 0.002});
  const double expected = integrate(point);
  double mean = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    mean += static_cast<double>(traced.ratio[i]) / 64.0;
    const double error = (static_cast<double>(traced.ratio[i]) - expected) / static_cast<double>(traced.ratio_error[i]);
    squares += error * error / 64.0;
  }
  EXPECT_NEAR(mean, expected, 0.002) << "x " << point.position_ws.x;
  EXPECT_LT(std::sqrt(squares), 1.6) << "errors are as large as they are said to be";
  EXPECT_GT(std::abs(mean - static_cast<double>(traced.visibility[0])), 0.01) << "or this shows nothing";
}

ReceiverPoint make_point(float x, const glm::vec3& normal) { return {{x, 0.0f, 0.0f}, glm::normalize(normal), true}; }

TEST(UnshadowedShare, OfARectangle_WeighsBothCosinesAndTheDistance) {
  const AreaLight light = AreaLight::make_rectangle({0.0, kLampHeight, 0.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, 0.4});
  for (const float x : {-1.0f, 1.5f}) {
    expect_ratio(
        light, make_point(x, {0.0f, 1.0f, 0.0f}),
        [](const auto& point) { return integrate_rectangle(point, 2.0, 0.4); });
  }
}

TEST(UnshadowedShare, OfASphere_WeighsTheReceiversCosine) {
  const AreaLight light = AreaLight::make_sphere({0.0, kLampHeight, 0.0}, 0.8);
  expect_ratio(light, make_point(0.1f, {0.95f, 0.2f, 0.0f}),
               [](const auto& point) { return integrate_sphere(point, 0.8); });
}

TEST(UnshadowedShare, LightBelowTheReceiversPlane_BringsNothing_AndIsNotMissed) {
  const Occluders nothing(std::vector<OccluderMesh>{});
  const ReceiverImage image{8, 1, std::vector<ReceiverPoint>(8, make_point(0.0f, {1.0f, 0.0f, 0.0f}))};
  const AreaLight light = AreaLight::make_rectangle({0.0, kLampHeight, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  const TracedVisibility traced = trace_area(nothing, image, light, {});
  for (std::size_t i = 0; i < image.points.size(); ++i) {
    EXPECT_NEAR(traced.visibility[i], 0.5, 0.05) << "half of the light is below the plane";
    EXPECT_EQ(traced.ratio[i], 1.0f);
    EXPECT_EQ(traced.ratio_error[i], 0.0f);
  }
}

}  // namespace
}  // namespace shadowbench::truth
