#include "base/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"

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

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(SplitList, KeepsEmptyParts) {
  EXPECT_THAT(split_list("a,bc"), ElementsAre("a", "bc"));
  EXPECT_THAT(split_list(",a,,b,"), ElementsAre("", "a", "", "b", ""));
  EXPECT_THAT(split_list(""), ElementsAre(""));
  EXPECT_THAT(split_list("a · b,c", " · "), ElementsAre("a", "b,c"));
}

TEST(SplitAssignments, TakesKeysAndValues) {
  EXPECT_THAT(split_assignments("a=1,b", "--x"), ElementsAre(Pair("a", "1"), Pair("b", "")));
  EXPECT_THROW(split_assignments("a=1,a=2", "--x"), Error);
  EXPECT_THROW(split_assignments("", "--x"), Error);
}

using ::testing::EndsWith;
using ::testing::StartsWith;

TEST(VisibleText, ControlCharacters_AreShown_AndTextStays) {
  EXPECT_EQ(make_visible("a\x1b[31mb\r\x7f\n\tc"), "a\\x1b[31mb\\x0d\\x7f\n\\x09c");
  EXPECT_EQ(make_visible("csi \xc2\x9b!"), "csi \\x9b!");
  EXPECT_EQ(make_visible("Fläche 1.5 × 2 \xf0\x9f\x99\x82 \xc2\xa0"), "Fläche 1.5 × 2 \xf0\x9f\x99\x82 \xc2\xa0");
}

TEST(VisibleText, LongNames_AreShortenedInTheMiddle) {
  const std::string message = make_readable("first " + std::string(200'000, 'a') + " last\nnext");
  EXPECT_LT(message.size(), 2100u);
  EXPECT_THAT(message, StartsWith("first aaa"));
  EXPECT_THAT(message, EndsWith("aaa last\nnext"));
  std::string lines;
  for (int i = 0; i < 100'000; ++i) lines += "é\n";
  EXPECT_LT(make_readable(lines).size(), 40'100u);
  EXPECT_EQ(make_readable("short\n\nlog\n"), "short\n\nlog\n");
}

TEST(VisibleText, IsShortenedBetweenCharacters) {
  std::string name;
  for (int i = 0; i < 1001; ++i) name += "aé";
  const std::string shown = make_readable(name);
  EXPECT_NE(shown, name);
  for (std::size_t i = 0; i < shown.size(); ++i)
    if (static_cast<unsigned char>(shown[i]) == 0xc3) EXPECT_EQ(static_cast<unsigned char>(shown[i + 1]), 0xa9);
  EXPECT_EQ(std::count(shown.begin(), shown.end(), '\xc3'), std::count(shown.begin(), shown.end(), '\xa9'));
}

}  // namespace
}  // namespace shadowbench
