#include "base/text.h"

#include <toml++/toml.h>

#include "base/bytes.h"
#include "base/toml.h"
#include "tests/test_files.h"

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

// Names of content: other bytes, another order or other pieces give another name, in both of its halves.

std::string hash_name_of(const std::vector<std::string>& pieces) {
  ContentHash hash;
  for (const std::string& piece : pieces) hash.add(piece);
  return hash.name();
}

TEST(ContentHash, TellsBytesOrderAndPiecesApart) {
  const std::string name = hash_name_of({"ab", "c"});
  EXPECT_EQ(name, "6e1b98b34d6a4beea73fdbfc1a855115");  // caches and keys of before hold such names
  EXPECT_EQ(hash_name_of({"ab", "c"}), name);
  for (const std::vector<std::string>& other : {std::vector<std::string>{"ab", "d"},
                                                {"bb", "c"},
                                                {"a", "bc"},
                                                {"abc"},
                                                {"c", "ab"},
                                                {"ab", "c", ""},
                                                {"", "ab", "c"},
                                                {"ab"},
                                                {}}) {
    EXPECT_NE(hash_name_of(other).substr(0, 16), name.substr(0, 16));
    EXPECT_NE(hash_name_of(other).substr(16), name.substr(16));
  }
}

/// The text stands in a file of filters, from its third line on.
TomlTable parse(const std::string& text) { return {text, "the text", {"a.glsl", 3, ErrorKind::kFilter}}; }

std::string error_of(const std::string& text, const std::function<void(const TomlTable&)>& read) {
  const Error error = shadowbench::error_of([&] { read(parse(text)); });
  EXPECT_EQ(error.kind(), ErrorKind::kFilter);
  return error.what();
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
                HasSubstr("'x' in the text must be tables, [[x]], but is"));
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
