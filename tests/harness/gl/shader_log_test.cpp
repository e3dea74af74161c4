#include "harness/gl/shader_log.h"

#include <gtest/gtest.h>

namespace shadowbench::gl {
namespace {

const std::vector<std::string> kFiles = {"(set by the program)", "lookup.frag", "my filter.glsl"};

TEST(ShaderLog, MesaError_BecomesTheUsersFileAndLine) {
  const auto log = translate_log("2:14(5): error: `x' undeclared\n", kFiles);
  EXPECT_EQ(log.where, "my filter.glsl:14");
  EXPECT_EQ(log.message, "`x' undeclared");
}

TEST(ShaderLog, NvidiaError_BecomesTheUsersFileAndLine) {
  const auto log = translate_log("2(14) : error C1503: undefined variable \"x\"\n", kFiles);
  EXPECT_EQ(log.where, "my filter.glsl:14");
  EXPECT_EQ(log.message, "error C1503: undefined variable \"x\"");
}

TEST(ShaderLog, OtherDriversError_BecomesTheUsersFileAndLine) {
  const auto log = translate_log("ERROR: 2:14: 'x' : undeclared identifier\n", kFiles);
  EXPECT_EQ(log.where, "my filter.glsl:14");
  EXPECT_EQ(log.message, "'x' : undeclared identifier");
}

TEST(ShaderLog, FirstError_GivesThePlace_AndOthersFollow) {
  const auto log =
      translate_log("1:3(1): warning: `a' used uninitialized\n2:14(5): error: one\r\n\n2:15(5): error: two\n", kFiles);
  EXPECT_EQ(log.where, "my filter.glsl:14");
  EXPECT_EQ(log.message, "one\nlookup.frag:3: warning: `a' used uninitialized\nmy filter.glsl:15: error: two");
}

TEST(ShaderLog, NvidiaWarningBeforeTheError_IsNotTheFirstError) {
  const auto log =
      translate_log("1(3) : warning C7050: \"v\" might be used\n2(9) : error C0000: syntax error\n", kFiles);
  EXPECT_EQ(log.where, "my filter.glsl:9");
  EXPECT_EQ(log.message, "error C0000: syntax error\nlookup.frag:3: warning C7050: \"v\" might be used");
}

TEST(ShaderLog, OtherDriversWarning_IsNotTheFirstError) {
  const auto log = translate_log("WARNING: 1:3: extension\nERROR: 2:14: syntax\n", kFiles);
  EXPECT_EQ(log.where, "my filter.glsl:14");
  EXPECT_EQ(log.message, "syntax\nlookup.frag:3: extension");
}

TEST(ShaderLog, LineThatSaysTheFile_OverrulesMesasIndexOfZero) {
  const auto log = translate_log("0:200014(5): error: one\n1:100007(5): error: two\n", kFiles);
  EXPECT_EQ(log.where, "my filter.glsl:14");
  EXPECT_EQ(log.message, "one\nlookup.frag:7: error: two");
}

TEST(ShaderLog, NvidiaLineThatSaysTheFile_IsSplit) {
  EXPECT_EQ(translate_log("2(200014) : error C1503: x\n", kFiles).where, "my filter.glsl:14");
}

TEST(ShaderLog, IndexWithoutAFile_IsLeftAsItIs) {
  const auto log = translate_log("7:14(5): error: x\n", kFiles);
  EXPECT_EQ(log.where, "");
  EXPECT_EQ(log.message, "7:14(5): error: x");
}

TEST(ShaderLog, IndexTooLargeForAnyNumber_IsLeftAsItIs) {
  const auto log = translate_log("99999999999999999999999:14(5): error: x\n", kFiles);
  EXPECT_EQ(log.message, "99999999999999999999999:14(5): error: x");
}

TEST(ShaderLog, LinkErrorWithoutAPlace_IsKept) {
  const auto log = translate_log("error: unresolved reference to function `visibility'\n", kFiles);
  EXPECT_EQ(log.where, "");
  EXPECT_EQ(log.message, "error: unresolved reference to function `visibility'");
}

TEST(ShaderLog, TextInNoKnownForm_IsKept) {
  const auto log = translate_log("Fragment info\n-------------\n2(4) : error C1: x\n", kFiles);
  EXPECT_EQ(log.where, "my filter.glsl:4");
  EXPECT_EQ(log.message, "error C1: x\nFragment info\n-------------");
}

TEST(ShaderLog, EmptyLog_IsEmpty) { EXPECT_EQ(translate_log("", kFiles).message, ""); }

}  // namespace
}  // namespace shadowbench::gl
