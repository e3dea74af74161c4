#include "harness/gl/program.h"

#include <cstdio>

#include "harness/gl/context/context.h"
#include "harness/gl/objects.h"
#include "harness/gl/survey.h"
#include "tests/test_files.h"

namespace shadowbench::gl {
namespace {

/// Holds shader files in a folder of its own.
class ShaderSourceTest : public ::testing::Test {
 protected:
  ShaderSourceTest() {
    options_.roots = {folder_.path()};
    options_.main_file = "main.frag";
  }

  void write(const std::string& name, const std::string& text) { folder_.write(name, text); }
  std::string path(const std::string& name) const { return (folder_.path() / name).generic_string(); }

  TestFolder folder_;
  SourceOptions options_;
};

/// Says where each line of the text comes from, as a compiler that obeys `#line` would: "file:line text".
std::vector<std::string> locate_lines(const ShaderSource& source) {
  std::vector<std::string> located;
  std::istringstream stream(source.text);
  std::size_t file = 0;
  int number = 1;
  for (std::string line; std::getline(stream, line); ++number) {
    int next = 0;
    if (std::sscanf(line.c_str(), "#line %d %zu", &next, &file) == 2) {
      EXPECT_EQ(static_cast<std::size_t>(next / kLinesPerFile), file);
      number = next % kLinesPerFile - 1;
      continue;
    }
    const auto name = std::filesystem::path(source.files.at(file)).filename().string();
    located.push_back(name + ":" + std::to_string(number) + " " + line);
  }
  return located;
}

TEST_F(ShaderSourceTest, Version_ComesFirst_ThenTheDefines) {
  write("main.frag", "void main() {}\n");
  options_.defines = {{"TAPS", "8"}, {"LOG", "1"}};
  const auto source = build_source(options_);
  EXPECT_THAT(source.text, StartsWith("#version 450 core\n#define TAPS 8\n#define LOG 1\n"));
}

TEST_F(ShaderSourceTest, EveryLine_KeepsItsOwnFileAndNumber) {
  write("main.frag", "m1\n#include \"lib/a.glsl\"\nm3\n  #  include \"filter\" // the user's\nm5");
  write("lib/a.glsl", "a1\n#include \"lib/b.glsl\"\na3\n");
  write("lib/b.glsl", "b1\r\nb2\r\n");
  options_.pieces = {{"filter", "u18\n#include \"lib/b.glsl\"\nu20\n", "user.glsl", 18}};
  EXPECT_THAT(locate_lines(build_source(options_)),
              ElementsAre("(set by the program):1 #version 450 core", "main.frag:1 m1", "a.glsl:1 a1", "b.glsl:1 b1",
                          "b.glsl:2 b2", "a.glsl:3 a3", "main.frag:3 m3", "user.glsl:18 u18", "user.glsl:20 u20",
                          "main.frag:5 m5"));
}

TEST_F(ShaderSourceTest, SameFileByTwoNames_IsInsertedOnce) {
  write("main.frag", "#include \"lib/a.glsl\"\n#include \"lib/../lib/a.glsl\"\n#include \"./lib/a.glsl\"\n");
  write("lib/a.glsl", "only\n");
  const auto lines = locate_lines(build_source(options_));
  EXPECT_THAT(lines, ElementsAre(::testing::_, "a.glsl:1 only"));
}

TEST_F(ShaderSourceTest, FirstRootThatHasTheFile_Wins) {
  std::filesystem::create_directories(folder_.path() / "second");
  write("second/main.frag", "second\n");
  write("second/other.glsl", "other\n");
  write("main.frag", "first\n#include \"other.glsl\"\n");
  options_.roots = {folder_.path(), folder_.path() / "second"};
  EXPECT_THAT(locate_lines(build_source(options_)),
              ElementsAre(::testing::_, "main.frag:1 first", "other.glsl:1 other"));
}

TEST_F(ShaderSourceTest, Piece_StandsInForAFileOfItsName) {
  write("main.frag", "file\n");
  options_.pieces = {{"main.frag", "piece\n", "user.glsl", 1}};
  EXPECT_THAT(locate_lines(build_source(options_)), ElementsAre(::testing::_, "user.glsl:1 piece"));
}

TEST_F(ShaderSourceTest, IncludeInAComment_IsLeftAlone) {
  write("main.frag",
        "/* one\n#include \"missing\"\n*/\n// #include \"missing\"\n// not open: /*\n#include \"lib/a.glsl\"\n");
  write("lib/a.glsl", "a1\n");
  const auto source = build_source(options_);
  EXPECT_THAT(source.text, HasSubstr("a1\n"));
  EXPECT_THAT(source.text, HasSubstr("#include \"missing\""));
}

TEST_F(ShaderSourceTest, ByteOrderMark_IsDropped) {
  write("main.frag", "\xEF\xBB\xBFm1\n");
  EXPECT_THAT(build_source(options_).text, Not(HasSubstr("\xEF\xBB\xBF")));
}

TEST_F(ShaderSourceTest, Circle_IsIncludedOnce) {
  write("main.frag", "#include \"lib/a.glsl\"\n");
  write("lib/a.glsl", "a1\n#include \"lib/b.glsl\"\n");
  write("lib/b.glsl", "b1\n#include \"lib/a.glsl\"\n#include \"main.frag\"\n");
  const std::string text = build_source(options_).text;
  EXPECT_EQ(text.find("a1"), text.rfind("a1"));
  EXPECT_EQ(text.find("b1"), text.rfind("b1"));
}

TEST_F(ShaderSourceTest, WhatAFilterMayNotHold_IsRefusedOnItsLine) {
  write("secret.txt", "SECRET\n");
  options_.roots = {folder_.path() / "lib"};
  write("lib/main.frag", "#include \"filter\"\nvoid main() {}\n");
  const auto expect = [&](const std::string& line, const std::string& words) {
    options_.pieces = {{"filter", "x\n" + line + "\n", "user.glsl", 20}};
    const Error error = error_of([&] { build_source(options_); });
    EXPECT_THAT(error, is_error(ErrorKind::kFilter, "user.glsl:21: ", words)) << line;
    EXPECT_THAT(error.message(), Not(HasSubstr("SECRET"))) << line;
  };
  expect("#include \"lib/nosuch.glsl\"", "lib/nosuch.glsl");
  expect("#include \"lib/nosuch.glsl\"", path("lib"));
  for (const std::string& name : {path("secret.txt"), std::string("../secret.txt"), std::string("x/../../secret.txt"),
                                  std::string("/etc/passwd")})
    expect("#include \"" + name + "\"", "'" + name + "' lies outside");
  for (const char* line : {"#line 7 1", " # line 7", "#line"}) expect(line, "#line");
  expect(std::string("\0y", 2), "NUL");
  expect("#version 330", "#version");
  expect("/* never closed", "");
}

TEST_F(ShaderSourceTest, MissingMainFile_IsAnInputError) {
  EXPECT_THAT(error_of([&] { build_source(options_); }), is_error(ErrorKind::kInput, "main.frag"));
}

TEST_F(ShaderSourceTest, Folder_IsNoFile) {
  options_.main_file = "lib";
  EXPECT_THAT(error_of([&] { build_source(options_); }).message(), HasSubstr("not found"));
}

TEST_F(ShaderSourceTest, MalformedInclude_NamesItsLine) {
  for (const std::string bad : {"#include <lib/a.glsl>", "#include", "#include \"", "#include \"\" // x",
                                "#include \"\"", "#include \"a\" b"}) {
    write("main.frag", "\n" + bad + "\n");
    EXPECT_THAT(error_of([&] { build_source(options_); }).what(), HasSubstr(path("main.frag") + ":2: malformed"))
        << bad;
  }
}

TEST_F(ShaderSourceTest, TextWithTooManyLines_IsRefused) {
  write("main.frag", std::string(kLinesPerFile - 2, '\n'));
  EXPECT_NO_THROW(build_source(options_));
  write("main.frag", std::string(kLinesPerFile, '\n'));
  EXPECT_EQ(error_of([&] { build_source(options_); }).where(), path("main.frag"));
}

const std::vector<std::string> kFiles = {"(set by the program)", "lookup.frag", "my filter.glsl"};

/// What drivers write, Mesa's form first, and what becomes of it.
TEST(ShaderLog, BecomesTheUsersFileAndLine_OfTheFirstError) {
  struct Case {
    const char *log, *where, *message;
  };
  for (const Case& each : {
           Case{"2:14(5): error: `x' undeclared\n", "my filter.glsl:14", "`x' undeclared"},
           {"2(14) : error C1503: undefined\n", "my filter.glsl:14", "error C1503: undefined"},
           {"ERROR: 2:14: 'x' : undeclared\n", "my filter.glsl:14", "'x' : undeclared"},
           {"1:3(1): warning: `a' unset\n2:14(5): error: one\r\n\n2:15(5): error: two\n", "my filter.glsl:14",
            "one\nlookup.frag:3: warning: `a' unset\nmy filter.glsl:15: error: two"},
           {"1(3) : warning C7050: \"v\"\n2(9) : error C0000: syntax\n", "my filter.glsl:9",
            "error C0000: syntax\nlookup.frag:3: warning C7050: \"v\""},
           {"WARNING: 1:3: extension\nERROR: 2:14: syntax\n", "my filter.glsl:14", "syntax\nlookup.frag:3: extension"},
           {"0:200014(5): error: one\n1:100007(5): error: two\n", "my filter.glsl:14",
            "one\nlookup.frag:7: error: two"},  // the line says the file, and overrules Mesa's index of zero
           {"2(200014) : error C1503: x\n", "my filter.glsl:14", "error C1503: x"},
           {"7:14(5): error: x\n", "", "7:14(5): error: x"},
           {"99999999999999999999999:14(5): error: x\n", "", "99999999999999999999999:14(5): error: x"},
           {"error: unresolved reference\n", "", "error: unresolved reference"},
           {"Fragment info\n---\n2(4) : error C1: x\n", "my filter.glsl:4", "error C1: x\nFragment info\n---"},
           {"", "", ""},
       }) {
    const ShaderLog log = translate_log(each.log, kFiles);
    EXPECT_EQ(log.where, each.where) << each.log;
    EXPECT_EQ(log.message, each.message) << each.log;
  }
}

TEST(PixelFormat, Name_FindsTheFormat) {
  EXPECT_EQ(parse_pixel_format("rg16f").internal_format, static_cast<GLenum>(GL_RG16F));
  EXPECT_EQ(parse_pixel_format("rg16f").bytes_per_texel, 4);
  EXPECT_EQ(&parse_pixel_format("d24"), &pixel_format(GL_DEPTH_COMPONENT24));
}

TEST(PixelFormat, UnknownName_IsAUsageErrorThatListsTheOthers) {
  EXPECT_THAT(error_of([] { parse_pixel_format("rgb5"); }), is_error(ErrorKind::kUsage, "rg32f"));
}

TEST(PixelFormat, ChannelsThatItDoesNotHave_AreABug) {
  EXPECT_EQ(pixel_format(GL_RG32F).transfer_format(1), static_cast<GLenum>(GL_RED));
  EXPECT_EQ(pixel_format(GL_DEPTH_COMPONENT16).transfer_format(1), static_cast<GLenum>(GL_DEPTH_COMPONENT));
  EXPECT_THROW(pixel_format(GL_RG32F).transfer_format(3), std::logic_error);
  EXPECT_THROW(pixel_format(GL_RG32F).transfer_format(0), std::logic_error);
  EXPECT_THROW(pixel_format(GL_RGB565), std::logic_error);
}

TEST(TimerCheck, QueryThatAgreesInMostRuns_IsBelieved) {
  EXPECT_EQ((TimerCheck{10.0, 9.8, 1.0}).choice(), TimerKind::kQuery);
  EXPECT_EQ((TimerCheck{10.0, 9.8, 0.92}).choice(), TimerKind::kQuery);
}

TEST(TimerCheck, QueryThatAgreesNowAndThen_IsNotBelieved) {
  EXPECT_EQ((TimerCheck{10.0, 9.8, 0.8}).choice(), TimerKind::kWallClock);
  EXPECT_EQ(TimerCheck{}.choice(), TimerKind::kWallClock);
}

}  // namespace
}  // namespace shadowbench::gl
