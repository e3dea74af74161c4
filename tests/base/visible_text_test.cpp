#include "base/visible_text.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace shadowbench {
namespace {

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
