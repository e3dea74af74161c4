// What a user meets whose filters' files have mistakes: at `run`, and at `regress` behind it.

#include <gmock/gmock.h>

#include "tests/harness/cli/program.h"

namespace shadowbench::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class FilterMistakesOfARun : public ProgramTest {
 protected:
  /// A filter whose function's body stands in its line 8.
  void write_filter(const std::string& id, const std::string& body, const std::string& kind = "other") const {
    write(id + ".glsl", "/*+++\ntitle = \"x\"\nsource = \"a test\"\nkind = \"" + kind +
                            "\"\nradius_texels = 1\n+++*/\nfloat visibility(Receiver r) {\n" + body + "\n}\n");
  }

  Outcome draw(const std::string& filters) const {
    return run(
        "run --gl software --grids --scene cubes --size 32x18 --map-size 32 --rounds 1 --no-truth --pad-texels 4 "
        "--filters none --out out " +
        filters);
  }
};

constexpr const char* kGood = "  return compare_2x2(r, vec2(0.0), r.depth);";

TEST_F(FilterMistakesOfARun, AllFiles_AreCheckedBeforeAnyIsMeasured) {
  write_filter("good", kGood);
  write_filter("one", "  return 12.x;");
  write_filter("two", "  return compare2x2(r, vec2(0.0), r.depth);");
  const Outcome outcome = draw("--filter-file good.glsl --filter-file one.glsl --filter-file two.glsl");
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("shadowbench: 2 filters have mistakes\n"));
  EXPECT_THAT(outcome.err, HasSubstr("one.glsl:8: the GLSL of 'one lookup' does not compile: syntax error"));
  EXPECT_THAT(outcome.err, HasSubstr("two.glsl:8: the GLSL of 'two lookup' does not compile: there is no function "
                                     "'compare2x2'; did you mean 'compare_2x2'?\n    return compare2x2(r, vec2(0.0), "
                                     "r.depth);\n"));
  EXPECT_THAT(outcome.err, Not(HasSubstr(" % ·")));
  EXPECT_TRUE(std::filesystem::is_empty(folder() / "out" / "cells")) << "nothing was measured";
}

TEST_F(FilterMistakesOfARun, FrontMatters_AreToldTogether) {
  write_filter("one", kGood, "mistaken");
  write_filter("two", kGood, "mistaken");
  const Outcome outcome = draw("--filter-file one.glsl --filter-file two.glsl");
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("2 filters have mistakes\none.glsl:4"), HasSubstr("\ntwo.glsl:4")));
}

TEST_F(FilterMistakesOfARun, ABuildServer_HasAFailingTestCase_UntilTheyAreMended) {
  write_filter("mine", "  return nowhere;");
  EXPECT_EQ(draw("--filter-file mine.glsl").exit_code, 5);
  const Outcome broken = run("regress out --baseline base --junit junit.xml");
  EXPECT_EQ(broken.exit_code, 5) << broken.err;
  EXPECT_THAT(broken.out, HasSubstr("mine.glsl:8: the GLSL of 'mine lookup' does not compile: 'nowhere' is not"));
  EXPECT_THAT(broken.out, HasSubstr("\nnothing was measured, because a filter has a mistake\n"));
  EXPECT_THAT(broken.err, HasSubstr("shadowbench: there is nothing to compare; mend mine.glsl, and run again"));
  const std::string junit = read_text(folder() / "junit.xml");
  EXPECT_THAT(junit,
              AllOf(HasSubstr("tests=\"1\" failures=\"1\""), HasSubstr("<testcase classname=\"filters\" name=\"mine"),
                    HasSubstr("<failure type=\"broken\""), HasSubstr("mine.glsl:8: ")));
  EXPECT_THAT(read_text(folder() / "out" / "regress" / "regress.md"), HasSubstr("return nowhere;"));
  EXPECT_EQ(run("regress out --baseline base --accept").exit_code, 5) << "there is nothing to accept";
  EXPECT_FALSE(std::filesystem::exists(folder() / "base"));
  write_filter("mine", kGood);
  ASSERT_EQ(draw("--filter-file mine.glsl").exit_code, 0);
  EXPECT_EQ(run("regress out --baseline base --accept").exit_code, 0);
  EXPECT_EQ(run("regress out --baseline base --junit junit.xml").exit_code, 0);
  EXPECT_THAT(read_text(folder() / "junit.xml"), AllOf(Not(HasSubstr("broken")), HasSubstr(" time=\"")));
}

TEST_F(FilterMistakesOfARun, OfARunThatWasFinishedBefore_NothingIsCompared) {
  write_filter("mine", kGood);
  ASSERT_EQ(draw("--filter-file mine.glsl").exit_code, 0);
  ASSERT_EQ(run("regress out --baseline base --accept").exit_code, 0);
  write_filter("mine", "  return nowhere;");
  EXPECT_EQ(draw("--filter-file mine.glsl").exit_code, 5);
  EXPECT_EQ(run("regress out --baseline base").exit_code, 5) << "the cells are those of another file";
  write_filter("mine", kGood);
  EXPECT_THAT(draw("--filter-file mine.glsl").err, HasSubstr("nothing is left to do"));
  EXPECT_EQ(run("regress out --baseline base").exit_code, 0);
}

}  // namespace
}  // namespace shadowbench::test
