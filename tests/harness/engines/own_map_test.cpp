#include <gtest/gtest.h>

#include "harness/engines/external_images.h"

namespace shadowbench::engines {
namespace {

constexpr int kSize = 8;
const glm::vec3 kUp(0.0f, 1.0f, 0.0f);

/// A map from straight above over the square 0 .. 8 of the floor: u along x, v against z, depth 0 at y = 8 and 1 at 0.
OwnMap make_map(bool reversed = false) {
  OwnMap map;
  map.depth = images::Image(kSize, kSize, 1);
  map.map_from_world = glm::dmat4(0.0);
  map.map_from_world[0][0] = 1.0 / kSize;
  map.map_from_world[2][1] = -1.0 / kSize;
  map.map_from_world[3][1] = 1.0;
  map.map_from_world[1][2] = reversed ? 0.125 : -0.125;
  map.map_from_world[3][2] = reversed ? 0.0 : 1.0;
  map.map_from_world[3][3] = 1.0;
  const float floor = reversed ? 0.0f : 1.0f, roof = reversed ? 0.25f : 0.75f;
  for (int row = 0; row < kSize; ++row)
    for (int column = 0; column < kSize; ++column) *map.depth.at(column, row) = column < 3 && row < 2 ? roof : floor;
  return map;
}

truth::ReceiverImage make_receivers(const std::vector<truth::ReceiverPoint>& points) {
  truth::ReceiverImage image;
  image.width = static_cast<int>(points.size());
  image.height = 1;
  image.points = points;
  return image;
}

std::vector<double> look_up_from_above(const OwnMap& map, const std::vector<truth::ReceiverPoint>& points) {
  return look_up(map, make_receivers(points), std::vector<glm::vec3>(points.size(), kUp));
}

TEST(OwnMap, ReceiversAreLookedUpInTheirTexel) {
  // Under the roof, beside it along x and along z, and beyond the map; the first row of the map is z = 0.
  const std::vector<truth::ReceiverPoint> points = {{{2.9f, 0.0f, 1.9f}, kUp, true}, {{3.1f, 0.0f, 1.9f}, kUp, true},
                                                    {{2.9f, 0.0f, 2.1f}, kUp, true}, {{9.0f, 0.0f, 1.0f}, kUp, true},
                                                    {{2.0f, 2.0f, 1.0f}, kUp, true}, {{2.9f, 0.0f, 1.9f}, kUp, false}};
  const std::vector<double> expected = {0.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  EXPECT_EQ(look_up_from_above(make_map(), points), expected);
  EXPECT_EQ(look_up_from_above(make_map(true), points), expected) << "a reversed map";
}

TEST(OwnMap, APlaneHasNoAcne_AndNoMoreBiasThanThat) {
  OwnMap map = make_map();
  // A slope that rises by one metre over each along x: a texel holds the depth of its middle.
  for (int row = 0; row < kSize; ++row)
    for (int column = 0; column < kSize; ++column)
      *map.depth.at(column, row) = static_cast<float>(1.0 - 0.125 * (column + 0.5));
  const glm::vec3 normal = glm::normalize(glm::vec3(-1.0f, 1.0f, 0.0f));
  std::vector<truth::ReceiverPoint> on, below;
  for (float x = 0.05f; x < 8.0f; x += 0.1f) {
    on.push_back({{x, x, 4.0f}, normal, true});
    below.push_back({{x, x - 1.05f, 4.0f}, normal, true});
  }
  EXPECT_EQ(look_up_from_above(map, on), std::vector<double>(on.size(), 1.0));
  EXPECT_EQ(look_up_from_above(map, below), std::vector<double>(on.size(), 0.0));
}

}  // namespace
}  // namespace shadowbench::engines
