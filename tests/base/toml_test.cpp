#include "base/toml.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <toml++/toml.h>

#include <functional>

namespace shadowbench {
namespace {

using ::testing::ElementsAre;

/// The text stands in a file of filters, from its third line on.
TomlTable parse(const std::string& text) { return {text, "the text", {"a.glsl", 3, ErrorKind::kFilter}}; }

std::string error_of(const std::string& text, const std::function<void(const TomlTable&)>& read) {
  try {
    read(parse(text));
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kFilter);
    return error.what();
  }
  return "no error";
}

TEST(Toml, ErrorsSayWhatWasExpected_WhatIsThere_AndWhere) {
  const auto read_whole = [](const TomlTable& t) { t.whole("x", {1, 9}); };
  EXPECT_EQ(error_of("\nx = 2.5", read_whole),
            "a.glsl:4: 'x' in the text must be a whole number from 1 to 9, but is 2.5");
  EXPECT_EQ(error_of("x = 10", read_whole), "a.glsl:3: 'x' in the text must be a whole number from 1 to 9, but is 10");
  EXPECT_EQ(error_of("", read_whole), "a.glsl:3: the text lacks 'x': expected a whole number from 1 to 9");
  EXPECT_EQ(error_of(
                "x = [1, 'two', [3], {}]", [](const TomlTable& t) { t.string("x"); }),
            "a.glsl:3: 'x' in the text must be a string, but is [1, 'two', [...], {...}]");
  EXPECT_EQ(error_of(
                "x = 0", [](const TomlTable& t) { t.number("x", kPositive); }),
            "a.glsl:3: 'x' in the text must be a number above 0, but is 0");
  EXPECT_EQ(error_of(
                "x = inf", [](const TomlTable& t) { t.number("x", kFinite); }),
            "a.glsl:3: 'x' in the text must be a finite number, but is inf");
  EXPECT_EQ(error_of(
                "x = [1,\n'two']", [](const TomlTable& t) { t.strings("x"); }),
            "a.glsl:3: 'x' in the text must be a string or a list of strings, but is 1");
  EXPECT_EQ(error_of(
                "x = [1,\n2,\n'three']", [](const TomlTable& t) { t.vec3("x", kFinite); }),
            "a.glsl:5: 'x' in the text must be a finite number, but is 'three'");
  EXPECT_EQ(error_of(
                "x = 'foor'",
                [](const TomlTable& t) {
                  t.choice("x", {"three", "four"});
                }),
            "a.glsl:3: unknown x 'foor' in the text; expected one of: three, four; did you mean 'four'?");
  EXPECT_EQ(error_of(
                "a = 1\ncolour = 1", [](const TomlTable& t) { t.require_known_keys({"a"}, {"color"}); }),
            "a.glsl:4: unknown key 'colour' in the text; did you mean 'color'?");
  EXPECT_EQ(error_of("[[x]]\na = 1\n[[x]]\na = 'b'",
                     [](const TomlTable& t) {
                       t.tables("x")[1].integer("a", {0, 1});
                     }),
            "a.glsl:6: 'a' in [[x]] number 2 must be a whole number from 0 to 1, but is 'b'");
  for (const char* none : {"x = 1", "x = []", "x = [1]", "x = [{}, 1]"})
    EXPECT_THAT(error_of(none, [](const TomlTable& t) { t.tables("x"); }),
                ::testing::HasSubstr("'x' in the text must be tables, [[x]], but is"));
  EXPECT_EQ(error_of("\n\nx = = 1", [](const TomlTable&) {}).substr(0, 26), "a.glsl:5: not valid TOML: ");
}

TEST(Toml, Numbers_WithoutAFraction_AreWhole_AndFallbacksStandIn) {
  const TomlTable table = parse("a = 3.0\nb = 4294967295\nc = 'one'\nd = ['one', 'two']");
  EXPECT_EQ(table.integer("a", {0, 9}), 3);
  EXPECT_EQ(table.whole("b", {0, 1e10}), 4294967295);
  EXPECT_EQ(table.number("b", kFinite), 4294967295.0);
  EXPECT_EQ(table.integer("none", {0, 9}, 77), 77);
  EXPECT_THAT(table.strings("c"), ElementsAre("one"));
  EXPECT_THAT(table.strings("d"), ElementsAre("one", "two"));
  EXPECT_EQ(table.choose<int>("c", {{"zero", 0}, {"one", 1}}), 1);
  EXPECT_EQ(table.choose<int>("none", {{"zero", 0}, {"one", 1}}, "zero"), 0);
}

TEST(Toml, AValue_OutlivesItsTable_AndOneThatWasPutTogetherHasNoPlace) {
  const auto value = parse("[a]\nb = 1").table("a")->find("b");
  EXPECT_EQ(value->where(), "a.glsl:4");
  EXPECT_EQ(value->as<double>(), 1.0);
  EXPECT_EQ(value->as<bool>(), std::nullopt);
  const TomlTable made(toml::table{{"a", 1.5}}, "the table");
  EXPECT_EQ(made.number("a", kFinite), 1.5);
  EXPECT_EQ(made.error("a", "wrong").where(), "");
}

TEST(Toml, WhatIsWritten_IsReadBack) {
  const toml::table document{{"z", write_number(0.1f)},
                             {"list", write_numbers(std::vector{0.7f, 1e-9f})},
                             {"text", "it's \"x\""},
                             {"table", toml::table{{"inner", true}}},
                             {"tables", toml::array{toml::table{{"a", 1}}, toml::table{{"a", 2}}}}};
  const std::string text = write_toml(document);
  EXPECT_EQ(text.substr(0, 19), "list = [0.7, 1e-09]");
  EXPECT_EQ(toml::parse(text), document);
}

}  // namespace
}  // namespace shadowbench
