#include "base/nearest_name.h"

#include <gtest/gtest.h>

namespace shadowbench {
namespace {

const std::vector<std::string> kNames{"none", "pcf2x2", "tent3x3", "poisson", "vsm", "esm"};

TEST(NearestNameTest, SwappedNeighbours_AreOneMistake) {
  EXPECT_EQ(nearest_name("pfc2x2", {"xyc2x2", "pcf2x2"}), "pcf2x2");
  EXPECT_EQ(nearest_name("vms", kNames), "vsm");
}

TEST(NearestNameTest, MissingExtraAndWrongLetters_FindTheName) {
  EXPECT_EQ(nearest_name("poison", kNames), "poisson");
  EXPECT_EQ(nearest_name("nonee", kNames), "none");
  EXPECT_EQ(nearest_name("tent3x4", kNames), "tent3x3");
}

TEST(NearestNameTest, Case_IsIgnored) { EXPECT_EQ(nearest_name("PCF2X2", kNames), "pcf2x2"); }

TEST(NearestNameTest, NothingLike_GivesNothing) {
  EXPECT_EQ(nearest_name("chandelier", kNames), std::nullopt);
  EXPECT_EQ(nearest_name("", kNames), std::nullopt);
  EXPECT_EQ(nearest_name("vsm", {}), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(100000, 'x'), kNames), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(256, 'x'), {std::string(300, 'x')}), std::nullopt);
}

TEST(NearestNameTest, AmongManyNames_FewerLettersMayDiffer) {
  EXPECT_EQ(nearest_name("depht_at", {"depth_at"}, 3), "depth_at");
  EXPECT_EQ(nearest_name("deep", {"step"}), "step");
  EXPECT_EQ(nearest_name("deep", {"step"}, 3), std::nullopt);
}

TEST(NearestNameTest, Message_NamesTheNearestOrAll) {
  EXPECT_EQ(did_you_mean("vssm", kNames), "; did you mean 'vsm'?");
  EXPECT_EQ(did_you_mean("chandelier", kNames), "");
  EXPECT_EQ(did_you_mean_or_known("vssm", kNames), "; did you mean 'vsm'?");
  EXPECT_EQ(did_you_mean_or_known("chandelier", {"esm", "vsm"}), "; known: esm, vsm");
  EXPECT_EQ(did_you_mean_or_known("chandelier", {}), "");
}

}  // namespace
}  // namespace shadowbench
