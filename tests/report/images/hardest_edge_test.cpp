#include <gtest/gtest.h>

#include <limits>

#include "report/images/grid.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {

using namespace records;
namespace {

// Lit right of x = 20 and right of x = 60; blocked between 40 and 60.
Image make_two_edges() {
  Image image(80, 40, 1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) *image.at(x, y) = (x >= 20 && x < 40) || x >= 60 ? 1.0f : 0.0f;
  return image;
}

bool contains(const Rect& rect, int x, int y) {
  return x >= rect.x && x < rect.x + rect.width && y >= rect.y && y < rect.y + rect.height;
}

TEST(HardestEdge, TheEdgeThatFiltersDisagreeOn_IsFound) {
  const Image reference = make_two_edges();
  Image other = reference;
  for (int y = 25; y < 30; ++y) {
    *other.at(60, y) = 0.4f;
    *other.at(59, y) = 0.6f;
  }
  const Rect crop = find_hardest_edge({&reference, &other}, 0, {12, 9});
  EXPECT_TRUE(contains(crop, 59, 25));
  EXPECT_TRUE(contains(crop, 60, 29));
  EXPECT_EQ(crop.width, 12);
  EXPECT_EQ(crop.height, 9);
}

TEST(HardestEdge, DisagreementWithoutAnEdge_IsPassedOver) {
  const Image reference = make_two_edges();
  Image other = reference;
  for (int y = 0; y < 10; ++y)
    for (int x = 66; x < 78; ++x) *other.at(x, y) = 0.0f;  // acne far from any edge
  *other.at(20, 30) = 0.5f;
  EXPECT_TRUE(contains(find_hardest_edge({&reference, &other}, 0, {5, 5}), 20, 30));
}

TEST(HardestEdge, WithoutAnyEdge_HoldsTheDisagreement) {
  Image lit(80, 40, 1);
  std::fill(lit.texels.begin(), lit.texels.end(), 1.0f);
  Image other = lit;
  *other.at(55, 20) = 0.0f;
  EXPECT_TRUE(contains(find_hardest_edge({&lit, &other}, 0, {5, 5}), 55, 20));
}

TEST(HardestEdge, TexelThatIsNotFinite_DoesNotSpoilTheSearch) {
  const Image reference = make_two_edges();
  Image other = reference;
  *other.at(2, 2) = std::numeric_limits<float>::quiet_NaN();
  *other.at(20, 30) = 0.5f;
  EXPECT_TRUE(contains(find_hardest_edge({&reference, &other}, 0, {5, 5}), 20, 30));
}

TEST(HardestEdge, FailedFilters_AreLeftOut) {
  const Image reference = make_two_edges();
  Image other = reference;
  *other.at(20, 30) = 0.5f;
  const Image empty;
  EXPECT_TRUE(contains(find_hardest_edge({&empty, nullptr, &reference, &other}, 0, {5, 5}), 20, 30));
  EXPECT_EQ(find_hardest_edge({&empty}, 0, {5, 5}).width, 0);
}

TEST(HardestEdge, CropLargerThanTheImage_IsCutToIt) {
  const Image reference = make_two_edges();
  const Rect crop = find_hardest_edge({&reference}, 0, {500, 500});
  EXPECT_EQ(crop.width, 80);
  EXPECT_EQ(crop.height, 40);
}

TEST(HardestEdge, CropSize_FitsAnyPicture) {
  for (const Size picture : {Size{1, 1}, Size{64, 36}, Size{960, 540}, Size{2000, 3}, Size{3, 2000}}) {
    const Size crop = choose_crop_size(picture);
    EXPECT_GE(crop.width, 1);
    EXPECT_GE(crop.height, 1);
    EXPECT_LE(crop.width, picture.width);
    EXPECT_LE(crop.height, picture.height);
  }
}

}  // namespace
}  // namespace shadowbench::images
