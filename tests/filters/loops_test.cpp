#include <gtest/gtest.h>

#include "filters/format/glsl_words.h"

namespace shadowbench::filters {
namespace {

TEST(CountLoops, WrapsEveryCondition_AndKeepsTheLines) {
  const CountedLoops counted = count_loops(
      "for (int i = 0; i < n(2, 3); ++i)\n  while (x < 1.0) x += 1.0;\nfor (;;) break;\ndo { y(); } while (z == 1);\n");
  EXPECT_EQ(counted.body,
            "for (int i = 0; count_turn(0,  i < n(2, 3)); ++i)\n  while ( count_turn(1, x < 1.0)) x += 1.0;\n"
            "for (; count_turn(2, true);) break;\ndo { y(); } while ( count_turn(3, z == 1));\n");
  EXPECT_EQ(counted.loops, 4);
}

TEST(CountLoops, LeavesTheRestAsItIs) {
  for (const char* glsl :
       {"", "float x = 1.0;", "// for (int i = 0; i < 9; ++i)\n/* while (x) */ float before; float meanwhile;",
        "while (bool more = next()) {}", "for (int i = 0; bool more = i < 3; ++i) {}", "for", "for (int i = 0; i < 3",
        "#define each for\n", "while ()"}) {
    const CountedLoops counted = count_loops(glsl);
    EXPECT_EQ(counted.body, glsl);
    EXPECT_EQ(counted.loops, 0) << glsl;
  }
  EXPECT_EQ(count_loops("for (int i = 0; i <= 3; ++i) {}").loops, 1) << "a comparison declares nothing";
}

}  // namespace
}  // namespace shadowbench::filters
