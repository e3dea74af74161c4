// What is drawn, written down: programs, inputs, targets, and what was there before.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "harness/gl/recorder.h"
#include "tests/harness/gl/gl_fixture.h"

namespace shadowbench::gl {
namespace {

using ::testing::ElementsAre;

Program make_program(const std::string& label, const std::string& text) {
  SourceOptions options;
  options.main_file = "main";
  options.pieces = {{"main", text, "main.frag", 1}};
  return Program(label, FullscreenTriangle::vertex_source(), build_source(options));
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

class RecorderTest : public GlTest {};

TEST_F(RecorderTest, ADrawHasItsProgramItsUniformsAndWhatItReads) {
  Recorder recorder;
  Bench bench;
  bench.draw_first({0.5f, 0.25f});
  const StepPointer filled = recorder.newest_draw();
  bench.draw_second();
  const DrawStep& copy = as_draw(recorder.newest_draw());
  EXPECT_EQ(copy.program->label, "copy");
  EXPECT_TRUE(copy.program->sources.at(GL_FRAGMENT_SHADER).starts_with("#version 450"));
  ASSERT_EQ(copy.inputs.size(), 1u);
  EXPECT_EQ(copy.inputs[0].sampler, "from");
  EXPECT_EQ(copy.inputs[0].texture->height, 3);
  EXPECT_THAT(copy.inputs[0].levels, ElementsAre(filled));
  EXPECT_EQ(copy.viewport, glm::ivec4(0, 0, 2, 3));
  EXPECT_THAT(as_draw(filled).uniforms.at("color"), ElementsAre(0.5, 0.25));
  EXPECT_EQ(recorder.newest_draw()->targets[0].texture->format, GLenum{GL_R32F});
  EXPECT_EQ(recorder.content_of(bench.first).step, filled);
}

TEST_F(RecorderTest, WhatCoversAllForgetsWhatWasThere_AndWhatAddsDoesNot) {
  Recorder recorder;
  Bench bench;
  bench.to_first.clear_color(0, glm::vec4(0.125f));
  const StepPointer cleared = recorder.content_of(bench.first).step;
  ASSERT_TRUE(cleared);
  EXPECT_FLOAT_EQ(std::get<ClearStep>(cleared->what).value.x, 0.125f);
  bench.draw_first({1.0f, 1.0f});
  EXPECT_EQ(recorder.newest_draw()->targets[0].before, nullptr);
  const Texture depth("depth", GL_DEPTH_COMPONENT32F, 2, 3);
  bench.to_first.attach_depth(depth);
  bench.to_first.clear_depth(0.0f);
  const StepPointer below = recorder.content_of(bench.first).step, masked = recorder.content_of(depth).step;
  bench.draw_first({0.5f, 0.5f}, true);
  const std::vector<StepTarget>& targets = recorder.newest_draw()->targets;
  ASSERT_EQ(targets.size(), 2u);
  EXPECT_EQ(targets[0].before, below);
  EXPECT_EQ(targets[1].place, StepTarget::kDepth);
  EXPECT_EQ(targets[1].before, masked);
  EXPECT_TRUE(as_draw(recorder.newest_draw()).adds);
  EXPECT_EQ(recorder.content_of(depth).step, masked);  // depth was looked at, and not written
}

TEST_F(RecorderTest, WhatIsDrawnInAPauseIsNotWrittenDown) {
  Recorder recorder;
  Bench bench;
  bench.draw_first({0.5f, 0.25f});
  const StepPointer filled = recorder.newest_draw();
  {
    const Recorder::Pause pause(&recorder);
    bench.draw_second();
  }
  EXPECT_EQ(recorder.newest_draw(), filled);
  const Recorder::Pause nothing(nullptr);  // where there is no recorder
}

TEST_F(RecorderTest, ATargetThatIsBoundAsAnInputIsNoInput) {
  Recorder recorder;
  Bench bench;
  bench.draw_first({0.5f, 0.25f});
  bench.to_first.bind();
  bench.first.bind(5);
  bench.copy.use();
  bench.triangle.draw();
  EXPECT_TRUE(as_draw(recorder.newest_draw()).inputs.empty());
}

TEST_F(RecorderTest, UploadsKeepTheirTexels_AndATextureThatIsGoneIsForgotten) {
  Recorder recorder;
  Bench bench;
  const std::array<float, 6> values = {1, 2, 3, 4, 5, 6};
  bench.second.upload_floats(values, 1);
  const StepPointer upload = recorder.content_of(bench.second).step;
  ASSERT_TRUE(upload);
  EXPECT_EQ(std::get<UploadStep>(upload->what).texels.size(), sizeof(values));
  bench.second = Texture("another", GL_R32F, 4, 4);
  EXPECT_EQ(recorder.content_of(bench.second).step, nullptr);
  EXPECT_EQ(recorder.content_of(bench.second).texture->width, 4);
}

TEST_F(RecorderTest, WithoutOneOpenGlIsAsBefore) {
  const auto before = glad_glDrawArrays;
  { Recorder recorder; }
  EXPECT_EQ(glad_glDrawArrays, before);
}

}  // namespace
}  // namespace shadowbench::gl
