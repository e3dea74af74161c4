#include <array>
#include <cstddef>
#include <stdexcept>

#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "harness/gl/recorder.h"
#include "tests/harness/gl/gl_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::gl {
namespace {

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

/// What a program draws into one pixel.
std::vector<float> draw(
    const Program& program, const std::function<void()>& draw_shape = [] { FullscreenTriangle().draw(); }) {
  Texture target("target", GL_RGBA32F, 1, 1);
  Framebuffer framebuffer("target");
  framebuffer.attach_color(0, target);
  framebuffer.bind();
  program.use();
  draw_shape();
  return target.read_floats(4);
}

TEST_F(GlTest, CompileErrorInAFilter_NamesTheUsersLine) {
  EXPECT_THAT(error_of([] { make_filter_program("\nfloat visibility() {\n  return nosuch;\n}\n"); }),
              is_error(ErrorKind::kFilter, "/home/me/soft.glsl:20: ", "nosuch", "'soft'"));
}

TEST_F(GlTest, CompileErrorInOurPartOfTheShader_NamesOurLine) {
  EXPECT_EQ(error_of([] { make_filter_program("#define visibility nosuch\n"); }).where(), "lookup.frag:4");
}

TEST_F(GlTest, MissingFunction_IsALinkErrorOfTheFilter) {
  EXPECT_THAT(error_of([] { make_filter_program("float unrelated() { return 1.0; }\n"); }),
              is_error(ErrorKind::kFilter, "visibility"));
}

TEST_F(GlTest, CompileErrorInAShaderOfOurs_IsABug) {
  EXPECT_THROW(Program("ours", FullscreenTriangle::vertex_source(), make_source("nonsense")), std::logic_error);
}

TEST_F(GlTest, CompileError_LeavesNoGlError) {
  EXPECT_THROW(make_filter_program("x"), Error);
  EXPECT_THAT(context().take_gl_errors(), IsEmpty());
}

TEST_F(GlTest, Defines_ReachTheShader) {
  SourceOptions options;
  options.main_file = "main";
  options.defines = {{"VALUE", "7.0"}};
  options.pieces = {{"main", "out vec4 o;\nvoid main() { o = vec4(VALUE); }\n", "main.frag", 1}};
  Program program("defines", FullscreenTriangle::vertex_source(), build_source(options));
  EXPECT_THAT(draw(program), ElementsAre(7, 7, 7, 7));
}

TEST_F(GlTest, AfterADraw_NoProgramIsInUse) {
  Program program("white", FullscreenTriangle::vertex_source(),
                  make_source("out vec4 o;\nvoid main() { o = vec4(1.0); }\n"));
  draw(program);
  GLint current = -1;
  glGetIntegerv(GL_CURRENT_PROGRAM, &current);
  EXPECT_EQ(current, 0);
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
  const auto draw_triangle = [&] {
    array.bind();
    glDrawArrays(GL_TRIANGLES, 1, 3);
  };
  EXPECT_THAT(draw(make_vertex_program(), draw_triangle), ElementsAre(4, 5, 6, 1));
}

// What is drawn, written down: programs, inputs, targets, and what was there before.

Program make_program(const std::string& label, const std::string& text) {
  return Program(label, FullscreenTriangle::vertex_source(), make_source(text));
}

/// A target, and programs that write a colour into it and copy it.
struct Bench {
  Program fill = make_program("fill",
                              "uniform vec2 color;\nlayout(location = 0) out vec4 o;\n"
                              "void main() { o = vec4(color, 0.0, 1.0); }\n");
  Program copy = make_program("copy",
                              "layout(binding = 5) uniform sampler2D from;\nlayout(location = 0) out vec4 o;\n"
                              "void main() { o = texelFetch(from, ivec2(0), 0); }\n");
  Texture first{"first", GL_RGBA32F, 2, 3}, second{"second", GL_R32F, 2, 3};
  Framebuffer to_first{"first"}, to_second{"second"};
  FullscreenTriangle triangle;

  Bench() {
    to_first.attach_color(0, first);
    to_second.attach_color(0, second);
  }

  void draw_first(const glm::vec2& color, bool adds = false) {
    fill.set("color", color);
    to_first.bind();
    fill.use();
    if (adds)
      triangle.draw_added();
    else
      triangle.draw();
  }

  void draw_second() {
    to_second.bind();
    first.bind(5);
    copy.use();
    triangle.draw();
  }
};

const DrawStep& as_draw(const StepPointer& step) { return std::get<DrawStep>(step->what); }

class RecorderTest : public GlTest {
 protected:
  Recorder recorder_;
  Bench bench_;
};

TEST_F(RecorderTest, ADrawHasItsProgramItsUniformsAndWhatItReads) {
  bench_.draw_first({0.5f, 0.25f});
  const StepPointer filled = recorder_.newest_draw();
  bench_.draw_second();
  const DrawStep& copy = as_draw(recorder_.newest_draw());
  EXPECT_EQ(copy.program->label, "copy");
  EXPECT_TRUE(copy.program->sources.at(GL_FRAGMENT_SHADER).starts_with("#version 450"));
  ASSERT_EQ(copy.inputs.size(), 1u);
  EXPECT_EQ(copy.inputs[0].sampler, "from");
  EXPECT_EQ(copy.inputs[0].texture->height, 3);
  EXPECT_THAT(copy.inputs[0].levels, ElementsAre(filled));
  EXPECT_EQ(copy.viewport, glm::ivec4(0, 0, 2, 3));
  EXPECT_THAT(as_draw(filled).uniforms.at("color"), ElementsAre(0.5, 0.25));
  EXPECT_EQ(recorder_.newest_draw()->targets[0].texture->format, GLenum{GL_R32F});
  EXPECT_EQ(recorder_.content_of(bench_.first).step, filled);
}

TEST_F(RecorderTest, WhatCoversAllForgetsWhatWasThere_AndWhatAddsDoesNot) {
  bench_.to_first.clear_color(0, glm::vec4(0.125f));
  const StepPointer cleared = recorder_.content_of(bench_.first).step;
  ASSERT_TRUE(cleared);
  EXPECT_FLOAT_EQ(std::get<ClearStep>(cleared->what).value.x, 0.125f);
  bench_.draw_first({1.0f, 1.0f});
  EXPECT_EQ(recorder_.newest_draw()->targets[0].before, nullptr);
  const Texture depth("depth", GL_DEPTH_COMPONENT32F, 2, 3);
  bench_.to_first.attach_depth(depth);
  bench_.to_first.clear_depth(0.0f);
  const StepPointer below = recorder_.content_of(bench_.first).step, masked = recorder_.content_of(depth).step;
  bench_.draw_first({0.5f, 0.5f}, true);
  const std::vector<StepTarget>& targets = recorder_.newest_draw()->targets;
  ASSERT_EQ(targets.size(), 2u);
  EXPECT_EQ(targets[0].before, below);
  EXPECT_EQ(targets[1].place, StepTarget::kDepth);
  EXPECT_EQ(targets[1].before, masked);
  EXPECT_TRUE(as_draw(recorder_.newest_draw()).adds);
  EXPECT_EQ(recorder_.content_of(depth).step, masked);  // depth was looked at, and not written
}

TEST_F(RecorderTest, WhatIsDrawnInAPauseIsNotWrittenDown) {
  bench_.draw_first({0.5f, 0.25f});
  const StepPointer filled = recorder_.newest_draw();
  {
    const Recorder::Pause pause(&recorder_);
    bench_.draw_second();
  }
  EXPECT_EQ(recorder_.newest_draw(), filled);
  const Recorder::Pause nothing(nullptr);  // where there is no recorder
}

TEST_F(RecorderTest, ATargetThatIsBoundAsAnInputIsNoInput) {
  bench_.draw_first({0.5f, 0.25f});
  bench_.to_first.bind();
  bench_.first.bind(5);
  bench_.copy.use();
  bench_.triangle.draw();
  EXPECT_TRUE(as_draw(recorder_.newest_draw()).inputs.empty());
}

TEST_F(RecorderTest, UploadsKeepTheirTexels_AndATextureThatIsGoneIsForgotten) {
  const std::array<float, 6> values = {1, 2, 3, 4, 5, 6};
  bench_.second.upload_floats(values, 1);
  const StepPointer upload = recorder_.content_of(bench_.second).step;
  ASSERT_TRUE(upload);
  EXPECT_EQ(std::get<UploadStep>(upload->what).texels.size(), sizeof(values));
  bench_.second = Texture("another", GL_R32F, 4, 4);
  EXPECT_EQ(recorder_.content_of(bench_.second).step, nullptr);
  EXPECT_EQ(recorder_.content_of(bench_.second).texture->width, 4);
}

TEST_F(GlTest, OpenGl_AfterARecorder_IsAsBefore) {
  const auto before = glad_glDrawArrays;
  { Recorder recorder; }
  EXPECT_EQ(glad_glDrawArrays, before);
}

}  // namespace
}  // namespace shadowbench::gl
