#include "filters/glsl_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace shadowbench::filters {
namespace {

// Names that filters may use.

using ::testing::Contains;
using ::testing::ElementsAre;

std::string read(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(std::filesystem::path(SHADOWBENCH_SOURCE_DIR) / file).rdbuf();
  return text.str();
}

/// The names before a parenthesis in the first column of a table: "| `float fetch_depth(Receiver r, ...)` | ...".
std::vector<std::string> list_functions(const std::string& table) {
  std::vector<std::string> names;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find('(');
    if (!line.starts_with("| `") || end == std::string::npos) continue;
    names.push_back(line.substr(line.rfind(' ', end) + 1, end - line.rfind(' ', end) - 1));
  }
  return names;
}

TEST(MapNames, AreThoseOfTheDocuments_AndOfTheShaders) {
  const std::string page = read("filters/README.md");
  const std::size_t begin = page.find("## Map functions"), end = page.find("## Rules and faults");
  ASSERT_LT(begin, end);
  const std::string section = page.substr(begin, end - begin);
  const std::string shaders =
      read("shaders/lib/map_access.glsl") + read("shaders/lib/random.glsl") + read("shaders/lib/screen_input.glsl");
  const std::vector<std::string> documented = list_functions(section);
  EXPECT_GE(documented.size(), 12U);
  for (const std::string& name : documented) EXPECT_THAT(list_map_names(), Contains(name));
  for (const std::string& name : list_map_names()) {
    EXPECT_TRUE(has_word(page, name)) << name;
    EXPECT_TRUE(has_word(shaders, name)) << name;
  }
}

TEST(DeclaredNames, AreWhatStandsBehindATypeOrDefine) {
  EXPECT_THAT(list_declared_names("#define TAPS 4\n#define square(x) ((x) * (x))\nuniform float radius;\n"
                                  "struct Disk { vec2 at; };\n/* float no; */ Disk turn(Disk d) { return d; }"),
              ElementsAre("square", "radius", "Disk", "at", "turn", "d"));
  EXPECT_THAT(list_declared_names(""), ElementsAre());
}

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
