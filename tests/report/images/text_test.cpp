#include "report/images/text.h"

#include <gmock/gmock.h>

namespace shadowbench::images {
namespace {

std::string without_spaces(std::string text) {
  text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
  return text;
}

Image draw(const std::string& text) {
  Image canvas(60, 40, 3);
  draw_text(canvas, 4, 4, text, {20, false}, {1.0f, 1.0f, 1.0f});
  return canvas;
}

TEST(Text, CleanText_HasNoControlCharactersAndIsUtf8) {
  EXPECT_EQ(clean_text("  a \n\t b\x01"
                       "c \x7f"),
            "a b c");
  EXPECT_EQ(clean_text("a\xff"
                       "b"),
            "a\xEF\xBF\xBD"
            "b");
  EXPECT_EQ(clean_text("Würfel · 2×"), "Würfel · 2×");
  EXPECT_EQ(clean_text(" "), "");
}

TEST(Text, CharactersOutsideAscii_AreDrawnAsThemselves) {
  EXPECT_NE(draw("·").texels, draw("7").texels);
  EXPECT_NE(draw("·").texels, draw("×").texels);
  EXPECT_NE(draw("ä").texels, draw("a").texels);
}

TEST(Text, WrappedLines_FitAndLoseNoCharacter) {
  const std::string text =
      "taps 16, radius 2.5 texels, rotation interleaved-gradient · "
      "a_word_so_long_that_it_must_be_broken_somewhere_ÄÖÜÄÖÜÄÖÜÄÖÜÄÖÜ end";
  for (const int width : {40, 100, 250, 900}) {
    std::string joined;
    for (const std::string& line : wrap_text(text, {20, false}, width)) {
      EXPECT_LE(measure_text(line, {20, false}), width) << line;
      EXPECT_EQ(clean_text(line), line);
      joined += line;
    }
    EXPECT_EQ(without_spaces(joined), without_spaces(text));
  }
}

TEST(Text, ShortText_IsOneLineAndEmptyTextNone) {
  EXPECT_THAT(wrap_text("vsm", {20, true}, 400), ::testing::ElementsAre("vsm"));
  EXPECT_TRUE(wrap_text("", {20, true}, 400).empty());
}

TEST(Text, DrawnText_StaysInItsMeasuredBox) {
  const std::string text = "jÄg·Qy";
  const Font font{20, true};
  Image canvas(200, 60, 3);
  draw_text(canvas, 30, 10, text, font, {1.0f, 1.0f, 1.0f});
  bool any = false;
  for (int y = 0; y < canvas.height; ++y) {
    for (int x = 0; x < canvas.width; ++x) {
      if (*canvas.at(x, y) > 0.0f) {
        any = true;
        EXPECT_TRUE(x >= 30 && x < 30 + measure_text(text, font) && y >= 10 && y < 10 + line_height(font))
            << x << " " << y;
      }
    }
  }
  EXPECT_TRUE(any);
}

}  // namespace
}  // namespace shadowbench::images
