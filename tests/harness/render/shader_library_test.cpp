// What a compiler's log becomes for the one who wrote the filter. The logs are Mesa's own, but for the files' names.

#include "harness/render/shader_library.h"

#include "tests/test_files.h"

namespace shadowbench::render {
namespace {

/// Explains a log in which "@8(15)" stands for line 8, column 15 of the filter.
std::string explain(const std::string& body, std::string log) {
  gl::SourceOptions options;
  options.main_file = "lookup.frag";
  options.pieces = {{"filter_parameters", "uniform float strength;\n", "mine.glsl (parameters)", 1},
                    {"filter", "float visibility(Receiver r) {\n" + body + "\n}\n", "mine.glsl", 7}};
  const std::vector<gl::Piece> pieces = options.pieces;
  options.pieces.push_back(
      {"lookup.frag",
       "struct Receiver { float depth; };\nfloat map_texels;\n#include \"filter_parameters\"\n#include \"filter\"\n"
       "float out_visibility;\n",
       "lookup.frag", 1});
  const gl::ShaderSource shader = gl::build_source(options);
  const auto place = std::ranges::find(shader.files, "mine.glsl") - shader.files.begin();
  for (std::size_t at = log.find('@'); at != std::string::npos; at = log.find('@'))
    log.replace(at, 1, fmt::format("{}:{}0000", place, place));
  gl::ShaderLog translated = gl::translate_log(log, shader.files);
  const std::string message = "the GLSL of 'mine lookup' does not compile: " + translated.message;
  return explain_mistakes({ErrorKind::kFilter, message, std::move(translated)}, pieces, shader).what();
}

TEST(FilterMistakes, UnknownFunction_IsQuoted_WithANearName) {
  EXPECT_EQ(explain("  return 1.0 + compare2x2(r, vec2(0.0), r.depth);",
                    "@8(15): error: no function with name 'compare2x2'\n"
                    "@8(9): error: operands to arithmetic operators must be numeric\n"
                    "@8(2): error: could not implicitly convert return value to float, in function `visibility'\n"),
            "mine.glsl:8: the GLSL of 'mine lookup' does not compile: there is no function 'compare2x2'; did you mean "
            "'compare_2x2'?\n"
            "    return 1.0 + compare2x2(r, vec2(0.0), r.depth);");
}

TEST(FilterMistakes, UnknownVariableMemberAndType_GetNearNames) {
  EXPECT_THAT(explain("  return strenght;", "@8(9): error: `strenght' undeclared\n"),
              HasSubstr("'strenght' is not declared; did you mean 'strength'?\n"));
  EXPECT_THAT(explain("  return r.dept;", "@8(9): error: cannot access field `dept' of structure\n"),
              EndsWith("there is no member 'dept'; did you mean 'depth'?\n    return r.dept;"));
  EXPECT_THAT(
      explain("  flaot s = 1.0;", "@8(8): error: syntax error, unexpected NEW_IDENTIFIER, expecting ',' or ';'\n"),
      EndsWith(": 'flaot' is not known; did you mean 'float'?\n    flaot s = 1.0;"));
  EXPECT_THAT(explain("  return corner_dept(r);", "@8(9): error: no function with name 'corner_dept'\n"),
              HasSubstr("did you mean 'corner_depth'?"));
}

TEST(FilterMistakes, NothingNear_NothingIsSuggested) {
  const std::string text = explain("  return utterly_different;", "@8(9): error: `utterly_different' undeclared\n");
  EXPECT_THAT(text, HasSubstr("'utterly_different' is not declared\n"));
  EXPECT_THAT(explain("  return map_texel_siz;", "@8(9): error: `map_texel_siz' undeclared\n"),
              HasSubstr("did you mean 'map_texel_uv'?"))
      << "'map_texels' is nearer, and the program's own";
  EXPECT_THAT(explain("  return visibilite;", "@8(9): error: `visibilite' undeclared\n"), HasSubstr("'visibility'"));
}

TEST(FilterMistakes, AllErrors_AreTold_ButNotWhatFollowsFromThem) {
  const std::string text =
      explain("  float s = vec2(1.0);\n  return s + nowhere;",
              "@8(12): error: initializer of type vec2 cannot be assigned to variable of type float\n"
              "@9(9): warning: `s' used uninitialized\n"
              "@9(13): error: `nowhere' undeclared\n"
              "@9(13): error: type mismatch\n");
  EXPECT_THAT(text, EndsWith("\nmine.glsl:9: 'nowhere' is not declared\n    return s + nowhere;"));
  EXPECT_THAT(text, Not(AnyOf(HasSubstr("type mismatch"), HasSubstr("uninitialized"))));
  EXPECT_THAT(explain("  return compare_2x2(r);",
                      "@8(9): error: no matching function for call to `compare_2x2(Receiver)'; candidates are:\n"
                      "@8(9): error:    float compare_2x2(Receiver, vec2, float)\n"),
              EndsWith("candidates are:\n      float compare_2x2(Receiver, vec2, float)\n    return compare_2x2(r);"));
}

TEST(FilterMistakes, SyntaxErrors_AreToldAsTheyAre) {
  const std::string said = "syntax error, unexpected RETURN, expecting ',' or ';'";
  EXPECT_THAT(
      explain("  float s = 1.0\n  return s;  // not flaot", "@9(2): error: " + said + "\n"),
      EndsWith("mine.glsl:9: the GLSL of 'mine lookup' does not compile: " + said + "\n    return s;  // not flaot"));
  const std::string name = "syntax error, unexpected NEW_IDENTIFIER, expecting ',' or ';'";
  EXPECT_THAT(explain("  float a = 12.x;  // flaot", "@8(15): error: " + name + "\n"),
              EndsWith(name + "\n    float a = 12.x;  // flaot"));
}

TEST(FilterMistakes, ALongLine_EndsBehindAWholeCharacter) {
  const std::string text =
      explain("  /* " + std::string(96, 'x') + "\xC3\xA4 */ nowhere;", "@8(9): error: `nowhere' undeclared\n");
  EXPECT_THAT(text, EndsWith(std::string(96, 'x') + "\xC3\xA4"));
}

TEST(FilterMistakes, OtherCompilers_AreUnderstood) {
  EXPECT_THAT(explain("  return nowhere;", "3(8) : error C1503: undefined variable \"nowhere\"\n"),
              EndsWith("'nowhere' is not declared\n    return nowhere;"));
  EXPECT_THAT(explain("  return strenght;", "ERROR: 3:8: 'strenght' : undeclared identifier\n"),
              HasSubstr("'strenght' is not declared; did you mean 'strength'?"));
}

TEST(FilterMistakes, CodeBehindTheFilter_BlamesItsEnd) {
  EXPECT_THAT(explain("  for (;;) {", "1:5(13): error: syntax error, unexpected '{', expecting ';'\n"),
              StartsWith("mine.glsl:9: the GLSL breaks the code after it, at or before this line"));
}

}  // namespace
}  // namespace shadowbench::render
