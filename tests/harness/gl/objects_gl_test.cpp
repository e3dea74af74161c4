#include <array>
#include <stdexcept>
#include <utility>

#include "harness/gl/objects.h"
#include "harness/gl/program.h"
#include "harness/gl/survey.h"
#include "tests/harness/gl/gl_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::gl {
namespace {

using ::testing::ElementsAreArray;
using ::testing::FloatEq;

constexpr std::array<std::byte, 4> kFourBytes{};

std::string get_label(GLenum identifier, GLuint id) {
  std::array<char, 256> text{};
  glGetObjectLabel(identifier, id, static_cast<GLsizei>(text.size()), nullptr, text.data());
  return text.data();
}

struct RoundTrip {
  GLenum format;
  int channels;
  double step;  ///< between neighbouring values near 1
};

TEST(Texture, Floats_ComeBackWithinTheFormatsStep) {
  const ContextChoice choice = create_context(Backend::kSoftware);
  const RoundTrip formats[] = {{GL_R32F, 1, 0.0},
                               {GL_RG32F, 2, 0.0},
                               {GL_RGBA32F, 4, 0.0},
                               {GL_R16F, 1, 0x1p-11},
                               {GL_RG16F, 2, 0x1p-11},
                               {GL_RGBA16F, 4, 0x1p-11},
                               {GL_RG16, 2, 0x1p-16},
                               {GL_RGBA8, 4, 0x1p-8},
                               {GL_DEPTH_COMPONENT16, 1, 0x1p-16},
                               {GL_DEPTH_COMPONENT24, 1, 0x1p-23},
                               {GL_DEPTH_COMPONENT32F, 1, 0.0}};
  for (const auto& [format, channels, step] : formats) {
    SCOPED_TRACE(pixel_format(format).name);
    std::vector<float> texels(static_cast<std::size_t>(5 * 3 * channels));
    for (std::size_t i = 0; i < texels.size(); ++i)
      texels[i] = static_cast<float>(i) / static_cast<float>(texels.size());
    Texture texture("round trip", format, 5, 3);
    texture.upload_floats(texels, channels);
    const auto back = texture.read_floats(channels);
    ASSERT_EQ(back.size(), texels.size());
    for (std::size_t i = 0; i < texels.size(); ++i) EXPECT_NEAR(back[i], texels[i], step) << i;
  }
}

void disturb_transfer_state() {
  for (const GLenum name : {GL_PACK_ALIGNMENT, GL_UNPACK_ALIGNMENT}) glPixelStorei(name, 8);
  for (const GLenum name : {GL_PACK_ROW_LENGTH, GL_UNPACK_ROW_LENGTH}) glPixelStorei(name, 17);
  for (const GLenum name : {GL_PACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS}) glPixelStorei(name, 1);
}

TEST_F(GlTest, Texture_TransfersRight_WhateverTransferStateIsSet) {
  Texture texture("odd", GL_R32F, 3, 2);
  const std::array texels = {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f};
  disturb_transfer_state();
  texture.upload_floats(texels, 1);
  disturb_transfer_state();
  EXPECT_THAT(texture.read_floats(1), ElementsAreArray(texels));
}

TEST_F(GlTest, Texture_TakesNormalisedBytes) {
  Texture texture("bytes", GL_RGBA8, 1, 1);
  texture.upload_bytes(std::array<std::uint8_t, 4>{0, 51, 255, 102}, 4);
  EXPECT_THAT(texture.read_floats(4), ElementsAre(0.0f, FloatEq(0.2f), 1.0f, FloatEq(0.4f)));
}

TEST_F(GlTest, Texture_WrongNumberOfTexels_IsABug) {
  Texture texture("small", GL_R32F, 2, 2);
  EXPECT_THROW(texture.upload_floats(std::array{1.0f}, 1), std::logic_error);
  EXPECT_THROW(texture.upload_bytes(std::array<std::uint8_t, 3>{}, 1), std::logic_error);
}

TEST_F(GlTest, Texture_AboveTheLimit_IsAUsageErrorWithLimitAndValue) {
  const int limit = context().info().max_texture_size;
  EXPECT_THAT(
      error_of([&] { Texture("depth map", GL_R8, limit + 1, 1); }),
      is_error(ErrorKind::kUsage, "depth map", std::to_string(limit + 1) + "x1", "at most " + std::to_string(limit)));
  EXPECT_EQ(error_of([&] { Texture("tall", GL_R8, 1, limit + 1); }).kind(), ErrorKind::kUsage);
  EXPECT_NO_THROW(Texture("at the limit", GL_R8, limit, 1));
}

TEST_F(GlTest, Texture_OfNoSize_IsAUsageError) {
  EXPECT_EQ(error_of([] { Texture("none", GL_R8, 0, 4); }).kind(), ErrorKind::kUsage);
  EXPECT_EQ(error_of([] { Texture("none", GL_R8, 4, -1); }).kind(), ErrorKind::kUsage);
}

TEST_F(GlTest, Texture_BeyondMemory_IsAnInputError) {
  const int limit = context().info().max_texture_size;
  EXPECT_THAT(error_of([&] { Texture("huge", GL_RGBA32F, limit, limit); }), is_error(ErrorKind::kInput, "huge"));
  context().take_gl_errors();
}

TEST_F(GlTest, Texture_CountsTheBytesOfAllLevels) {
  EXPECT_EQ(Texture("one", GL_RG32F, 8, 4).bytes(), 8u * 4u * 8u);
  EXPECT_EQ(Texture("all", GL_R32F, 4, 4, 3).bytes(), (16u + 4u + 1u) * 4u);
}

TEST_F(GlTest, Texture_MovedFrom_OwnsNothing) {
  Texture first("first", GL_R32F, 1, 1);
  const GLuint id = first.id();
  Texture second = std::move(first);
  EXPECT_EQ(second.id(), id);
  EXPECT_EQ(first.id(), 0u);
  second = Texture("third", GL_R32F, 1, 1);
  EXPECT_EQ(glIsTexture(id), GL_FALSE);
}

TEST_F(GlTest, Objects_CarryTheirLabels) {
  EXPECT_EQ(get_label(GL_TEXTURE, Texture("shadow map", GL_R8, 1, 1).id()), "shadow map");
  EXPECT_EQ(get_label(GL_BUFFER, Buffer("vertices", kFourBytes).id()), "vertices");
  EXPECT_EQ(get_label(GL_FRAMEBUFFER, Framebuffer("g-buffer").id()), "g-buffer");
  EXPECT_EQ(get_label(GL_SAMPLER, Sampler("compare").id()), "compare");
  EXPECT_EQ(get_label(GL_VERTEX_ARRAY, VertexArray("mesh").id()), "mesh");
}

TEST_F(GlTest, Label_LongerThanGlAllows_IsCut) {
  EXPECT_EQ(get_label(GL_BUFFER, Buffer(std::string(5000, 'x'), kFourBytes).id()), std::string(255, 'x'));
}

TEST_F(GlTest, Buffer_HoldsWhatItWasMadeOf) {
  const std::array values = {1, 2, 9, 4};
  const Buffer buffer("numbers", std::as_bytes(std::span(values)));
  ASSERT_EQ(buffer.size(), sizeof(values));
  std::array<int, 4> back{};
  glGetNamedBufferSubData(buffer.id(), 0, sizeof(back), back.data());
  EXPECT_EQ(back, values);
}

TEST_F(GlTest, Framebuffer_ClearsEachTextureByItself) {
  Texture first("first", GL_RG32F, 4, 2);
  Texture second("second", GL_R32F, 4, 2);
  Texture depth("depth", GL_DEPTH_COMPONENT32F, 4, 2);
  Framebuffer framebuffer("three");
  framebuffer.attach_color(0, first);
  framebuffer.attach_color(2, second);
  framebuffer.attach_depth(depth);
  framebuffer.bind();
  framebuffer.clear_color(0, {1.0f, 2.0f, 0.0f, 0.0f});
  framebuffer.clear_color(2, {3.0f, 0.0f, 0.0f, 0.0f});
  framebuffer.clear_depth(0.5f);
  EXPECT_THAT(first.read_floats(2), ElementsAre(1, 2, 1, 2, 1, 2, 1, 2, 1, 2, 1, 2, 1, 2, 1, 2));
  EXPECT_THAT(second.read_floats(1), Each(3.0f));
  EXPECT_THAT(depth.read_floats(1), Each(0.5f));
  EXPECT_EQ(framebuffer.width(), 4);
  EXPECT_EQ(framebuffer.height(), 2);
}

TEST_F(GlTest, Framebuffer_WithNothingAttached_IsABug) { EXPECT_THROW(Framebuffer("empty").bind(), std::logic_error); }

TEST_F(GlTest, Framebuffer_OfUnequalSizes_IsABug) {
  Texture small("small", GL_R32F, 2, 2);
  Texture large("large", GL_DEPTH_COMPONENT24, 4, 4);
  Framebuffer framebuffer("mixed");
  framebuffer.attach_color(0, small);
  EXPECT_THROW(framebuffer.attach_depth(large), std::logic_error);
}

TEST_F(GlTest, FullscreenTriangle_CoversEveryPixelOnce_WhateverStateIsSet) {
  for (const GLenum capability : {GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_CULL_FACE, GL_BLEND}) glEnable(capability);
  glScissor(0, 0, 1, 1);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glCullFace(GL_FRONT_AND_BACK);
  Query samples("samples", GL_SAMPLES_PASSED);
  SurveyShader probe("survey_loop.frag", {37, 23});
  probe.program().set("u_turns", 3);
  samples.begin();
  probe.draw();
  samples.end();
  EXPECT_EQ(samples.result(), 37u * 23u);
  EXPECT_THAT(probe.run(), ::testing::Each(3.0f));
}

// Places across a map of two texels: half way between them, and beyond the right edge.
constexpr float kHalfway = 0.5f, kOutside = 4.0f;

float sample(float place, const Texture& map, const Sampler* sampler = nullptr) {
  SurveyShader probe("survey_filter.frag", {1, 1});
  map.bind(0);
  if (sampler) sampler->bind(0);
  probe.program().set("u_map", 0);
  probe.program().set("u_first", place);
  probe.program().set("u_step", 0.0f);
  return probe.run().front();
}

TEST_F(GlTest, Sampler_OverridesTheTexturesFilter_UntilATextureIsBound) {
  Texture map("step", GL_R32F, 2, 1);
  map.upload_floats(std::array{0.0f, 1.0f}, 1);
  Sampler linear("linear");
  linear.set_filter(GL_LINEAR, GL_LINEAR);
  EXPECT_NE(sample(kHalfway, map), 0.5f);
  EXPECT_EQ(sample(kHalfway, map, &linear), 0.5f);
  EXPECT_NE(sample(kHalfway, map), 0.5f);
  map.set_filter(GL_LINEAR, GL_LINEAR);
  EXPECT_EQ(sample(kHalfway, map), 0.5f);
  Sampler nearest("nearest, as new ones are");
  EXPECT_NE(sample(kHalfway, map, &nearest), 0.5f);
}

TEST_F(GlTest, Outside_IsTheEdge_OfNewTexturesAndSamplers) {
  Texture map("edge", GL_R32F, 2, 1);
  map.upload_floats(std::array{0.25f, 1.0f}, 1);
  EXPECT_EQ(sample(kOutside, map), 1.0f);
  map.set_wrap(GL_REPEAT);
  EXPECT_EQ(sample(kOutside, map), 0.25f);
  Sampler sampler("edge");
  EXPECT_EQ(sample(kOutside, map, &sampler), 1.0f);
  sampler.set_wrap(GL_REPEAT);
  EXPECT_EQ(sample(kOutside, map, &sampler), 0.25f);
}

TEST_F(GlTest, Border_IsWhatLiesOutside_OfSampler) {
  Texture map("border", GL_R32F, 2, 1);
  map.upload_floats(std::array{1.0f, 1.0f}, 1);
  Sampler sampler("border");
  sampler.set_wrap(GL_CLAMP_TO_BORDER);
  sampler.set_border({0.75f, 0.0f, 0.0f, 0.0f});
  EXPECT_EQ(sample(kOutside, map, &sampler), 0.75f);
}

TEST_F(GlTest, Mipmaps_AverageTheLevelAbove) {
  Texture map("mips", GL_R32F, 2, 2, 2);
  map.upload_floats(std::array{0.0f, 1.0f, 2.0f, 3.0f}, 1);
  map.generate_mipmaps();
  float top = 0.0f;
  glGetTextureImage(map.id(), 1, GL_RED, GL_FLOAT, sizeof(top), &top);
  EXPECT_EQ(top, 1.5f);
}

}  // namespace
}  // namespace shadowbench::gl
