#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <stdexcept>

#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "tests/harness/gl/gl_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::gl {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

ShaderSource make_source(const std::string& text) {
  SourceOptions options;
  options.main_file = "main";
  options.pieces = {{"main", text, "main.frag", 1}};
  return build_source(options);
}

/// Builds a lookup shader around a user's filter, which begins in line 18 of its file.
ShaderSource make_filter_source(const std::string& filter) {
  SourceOptions options;
  options.main_file = "main";
  options.pieces = {
      {"main", "out float o;\nfloat visibility();\n#include \"filter\"\nvoid main() { o = visibility(); }\n",
       "lookup.frag", 1},
      {"lib", "float helper() {\n  return 1.0;\n}\n", "lib.glsl", 1},
      {"filter", filter, "/home/me/soft.glsl", 18}};
  return build_source(options);
}

Program make_filter_program(const std::string& filter) {
  return Program("soft", FullscreenTriangle::vertex_source(), make_filter_source(filter), ErrorKind::kFilter);
}

std::vector<float> draw(Program& program) {
  Texture target("target", GL_RGBA32F, 1, 1);
  Framebuffer framebuffer("target");
  framebuffer.attach_color(0, target);
  framebuffer.bind();
  program.use();
  FullscreenTriangle().draw();
  return target.read_floats(4);
}

TEST_F(GlTest, CompileErrorInAFilter_NamesTheUsersLine) {
  const Error error = error_of([] { make_filter_program("\nfloat visibility() {\n  return nosuch;\n}\n"); });
  EXPECT_EQ(error.kind(), ErrorKind::kFilter);
  EXPECT_EQ(error.where(), "/home/me/soft.glsl:20");
  EXPECT_THAT(error.message(), HasSubstr("nosuch"));
  EXPECT_THAT(error.message(), HasSubstr("'soft'"));
}

TEST_F(GlTest, CompileErrorInOurPartOfTheShader_NamesOurLine) {
  const Error error = error_of([] { make_filter_program("#define visibility nosuch\n"); });
  EXPECT_EQ(error.where(), "lookup.frag:4");
}

TEST_F(GlTest, MissingFunction_IsALinkErrorOfTheFilter) {
  const Error error = error_of([] { make_filter_program("float unrelated() { return 1.0; }\n"); });
  EXPECT_EQ(error.kind(), ErrorKind::kFilter);
  EXPECT_THAT(error.message(), HasSubstr("visibility"));
}

TEST_F(GlTest, CompileErrorInAShaderOfOurs_IsABug) {
  EXPECT_THROW(Program("ours", FullscreenTriangle::vertex_source(), make_source("nonsense")), std::logic_error);
}

TEST_F(GlTest, CompileError_LeavesNoGlError) {
  EXPECT_THROW(make_filter_program("x"), Error);
  EXPECT_THAT(context().take_gl_errors(), ::testing::IsEmpty());
}

TEST_F(GlTest, Defines_ReachTheShader) {
  SourceOptions options;
  options.main_file = "main";
  options.defines = {{"VALUE", "7.0"}};
  options.pieces = {{"main", "out vec4 o;\nvoid main() { o = vec4(VALUE); }\n", "main.frag", 1}};
  Program program("defines", FullscreenTriangle::vertex_source(), build_source(options));
  EXPECT_THAT(draw(program), ElementsAre(7, 7, 7, 7));
}

TEST_F(GlTest, Uniforms_OfEveryType_ReachTheShader) {
  Program program("uniforms", FullscreenTriangle::vertex_source(), make_source(R"(
uniform int i; uniform uint u; uniform float f; uniform ivec2 i2; uniform vec2 v2; uniform vec3 v3; uniform vec4 v4;
uniform mat4 m4;
out vec4 o;
void main() {
  o.x = float(i) + float(u) * 10.0 + f * 100.0 + float(i2.y) * 1000.0;
  o.y = v2.y + v3.z * 10.0 + v4.w * 100.0;
  o.z = m4[3][1] * 10.0;
  o.w = 1.0;
}
)"));
  program.set("i", 1);
  program.set("u", 2u);
  program.set("f", 3.0f);
  program.set("i2", glm::ivec2(0, 4));
  program.set("v2", glm::vec2(0, 1));
  program.set("v3", glm::vec3(0, 0, 2));
  program.set("v4", glm::vec4(0, 0, 0, 3));
  program.set("m4", glm::mat4(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 6, 0, 0));
  EXPECT_THAT(draw(program), ElementsAre(4321, 321, 60, 1));
}

TEST_F(GlTest, UniformThatTheCompilerDropped_IsIgnored) {
  Program program("dropped", FullscreenTriangle::vertex_source(),
                  make_source("uniform float dropped;\nout vec4 o;\nvoid main() { o = vec4(1.0); }\n"));
  EXPECT_FALSE(program.has("dropped"));
  EXPECT_NO_THROW(program.set("dropped", 1.0f));
}

TEST_F(GlTest, UniformThatNoSourceNames_IsABug) {
  Program program("typo", FullscreenTriangle::vertex_source(),
                  make_source("uniform float radius_texels;\nout vec4 o;\nvoid main() { o = vec4(radius_texels); }\n"));
  EXPECT_TRUE(program.has("radius_texels"));
  EXPECT_THROW(program.set("radius", 1.0f), std::logic_error);
  EXPECT_THROW(program.set("texels", 1.0f), std::logic_error);
}

struct Vertex {
  glm::vec2 position;
  glm::vec3 color;
};

Program make_vertex_program() {
  return Program("vertices",
                 make_source("layout(location = 0) in vec2 position;\nlayout(location = 3) in vec3 color;\n"
                             "flat out vec3 v_color;\n"
                             "void main() { v_color = color; gl_Position = vec4(position, 0.0, 1.0); }\n"),
                 make_source("flat in vec3 v_color;\nout vec4 o;\nvoid main() { o = vec4(v_color, 1.0); }\n"));
}

TEST_F(GlTest, VertexArray_FeedsInterleavedAttributes) {
  const std::array vertices = {Vertex{{9, 9}, {0, 0, 0}}, Vertex{{-1, -1}, {1, 2, 3}}, Vertex{{3, -1}, {1, 2, 3}},
                               Vertex{{-1, 3}, {4, 5, 6}}};
  const Buffer vertex_buffer("vertices", std::as_bytes(std::span(vertices)));
  VertexArray array("triangle");
  array.set_vertices(vertex_buffer, sizeof(Vertex));
  array.set_attribute(0, 2, offsetof(Vertex, position));
  array.set_attribute(3, 3, offsetof(Vertex, color));
  const Program program = make_vertex_program();
  Texture target("target", GL_RGBA32F, 1, 1);
  Framebuffer framebuffer("target");
  framebuffer.attach_color(0, target);
  framebuffer.bind();
  program.use();
  array.bind();
  glDrawArrays(GL_TRIANGLES, 1, 3);
  EXPECT_THAT(target.read_floats(4), ElementsAre(4, 5, 6, 1));
}

}  // namespace
}  // namespace shadowbench::gl
