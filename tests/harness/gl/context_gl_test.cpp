#include <stdexcept>

#include "base/text.h"
#include "harness/gl/context/context.h"
#include "harness/gl/objects.h"
#include "harness/gl/survey.h"
#include "tests/harness/gl/gl_fixture.h"
#include "tests/test_files.h"

namespace shadowbench::gl {
namespace {

#ifdef __SANITIZE_ADDRESS__
/// Mesa unloads its driver with the last GLX context, and no leak could be traced to the driver, nor suppressed, after
/// that.
extern "C" int dlclose(void* /*library*/) { return 0; }
#endif

// Draws and reads back: what a context is for.
void expect_it_draws(Context& context) {
  Texture texture("clear", GL_R32F, 8, 8);
  Framebuffer framebuffer("clear");
  framebuffer.attach_color(0, texture);
  framebuffer.bind();
  framebuffer.clear_color(0, {0.25f, 0.0f, 0.0f, 0.0f});
  EXPECT_THAT(texture.read_floats(1), Each(0.25f));
  SurveyShader probe("survey_load.frag", {4, 4});
  probe.program().set("u_iterations", 0);
  EXPECT_FLOAT_EQ(probe.run()[1], 1.5f * 0.001f + 0.5f * 0.0001f);
  EXPECT_NO_THROW(context.require_no_gl_errors());
}

void expect_core_45(const GlInfo& info) {
  GLint profile = 0;
  glGetIntegerv(GL_CONTEXT_PROFILE_MASK, &profile);
  EXPECT_EQ(profile, GL_CONTEXT_CORE_PROFILE_BIT);
  GLint major = 0;
  GLint minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  EXPECT_GE(10 * major + minor, 45) << info.version;
}

TEST_F(GlTest, Info_SaysWhatItRunsOn) {
  const GlInfo& info = context().info();
  EXPECT_EQ(info.backend, has_backend(Backend::kOsmesa) ? "osmesa" : "egl");
  EXPECT_TRUE(info.software);
  EXPECT_THAT(info.renderer, Not(IsEmpty()));
  EXPECT_THAT(info.version, HasSubstr("4.5"));
  EXPECT_GE(info.max_texture_size, 16384);
  EXPECT_GT(info.creation_ms, 0.0);
}

TEST_F(GlTest, ClipControl_IsLowerLeftZeroToOne) {
  GLint origin = 0;
  GLint depth = 0;
  glGetIntegerv(GL_CLIP_ORIGIN, &origin);
  glGetIntegerv(GL_CLIP_DEPTH_MODE, &depth);
  EXPECT_EQ(origin, GL_LOWER_LEFT);
  EXPECT_EQ(depth, GL_ZERO_TO_ONE);
}

TEST_F(GlTest, GlError_IsRecordedOnceWithItsCall) {
  glEnable(0x1234);
  EXPECT_THAT(context().take_gl_errors(), ElementsAre(HasSubstr("glEnable")));
  EXPECT_THAT(context().take_gl_errors(), IsEmpty());
}

TEST_F(GlTest, GlError_ThrowsWhereNoneIsAllowed) {
  glEnable(0x1234);
  EXPECT_THROW(context().require_no_gl_errors(), std::logic_error);
}

TEST_F(GlTest, GlErrorWithoutAMessage_IsRecordedByItsCode) {
  glDisable(GL_DEBUG_OUTPUT);
  glEnable(0x1234);
  EXPECT_THAT(context().take_gl_errors(), ElementsAre("GL_INVALID_ENUM"));
}

TEST(Context, ABackendThatTheBuildLeavesOut_IsRefusedByName) {
  for (const Backend backend : {Backend::kOsmesa, Backend::kEgl, Backend::kGlfw}) {
    if (has_backend(backend)) continue;
    EXPECT_THAT(error_of([&] { create_context(backend); }),
                is_error(ErrorKind::kContext, fmt::format("this build has no --gl {}", name_of(backend))));
  }
  EXPECT_TRUE(has_backend(Backend::kAuto));
}

TEST(Context, AutoOnAnyMachine_GivesOneThatDraws_AndSaysWhyNotTheOthers) {
  const auto choice = create_context(Backend::kAuto);
  expect_core_45(choice.context->info());
  expect_it_draws(*choice.context);
  if (choice.context->info().software) {
    ASSERT_THAT(choice.refused, Not(IsEmpty()));
    EXPECT_THAT(choice.refused.front(), StartsWith("egl on a GPU: "));
  }
}

class BackendTest : public ::testing::TestWithParam<Backend> {
 protected:
  /// A context of that back end, or why this machine gives none. OSMesa needs nothing of it.
  ContextChoice create() {
    try {
      return create_context(GetParam());
    } catch (const Error& error) {
      if (GetParam() == Backend::kOsmesa && has_backend(Backend::kOsmesa)) throw;
      EXPECT_EQ(error.kind(), ErrorKind::kContext);
      return {nullptr, {error.what()}};
    }
  }
};

TEST_P(BackendTest, Context_IsCore45_AndDraws) {
  const ContextChoice choice = create();
  if (!choice.context) GTEST_SKIP() << choice.refused.front();
  EXPECT_EQ(choice.context->info().backend, name_of(GetParam()));
  EXPECT_THAT(choice.refused, IsEmpty());
  expect_core_45(choice.context->info());
  expect_it_draws(*choice.context);
}

TEST_P(BackendTest, MadeTwiceWithASoftwareOneBetween_StillDraws) {
  for (int i = 0; i < 2; ++i) {
    if (const ContextChoice choice = create(); choice.context)
      expect_it_draws(*choice.context);
    else
      GTEST_SKIP() << choice.refused.front();
    expect_it_draws(*create_context(Backend::kSoftware).context);
  }
}

TEST_P(BackendTest, AliveBesideASoftwareOne_TakesTurns) {
  const ContextChoice other = create();
  if (!other.context) GTEST_SKIP() << other.refused.front();
  const auto software = create_context(Backend::kSoftware);
  for (Context* context : {software.context.get(), other.context.get(), software.context.get()}) {
    context->make_current();
    expect_it_draws(*context);
  }
}

INSTANTIATE_TEST_SUITE_P(All, BackendTest, ::testing::Values(Backend::kOsmesa, Backend::kEgl, Backend::kGlfw),
                         [](const auto& test) { return std::string(name_of(test.param)); });

/// Mesa would end this process.
TEST(Context, DriverThatMesaLacks_IsRefusedByName) {
  setenv("GALLIUM_DRIVER", "nosuch", 1);
  const Error error = error_of([] { create_context(Backend::kSoftware); });
  unsetenv("GALLIUM_DRIVER");
  EXPECT_THAT(error, is_error(ErrorKind::kContext, "GALLIUM_DRIVER=nosuch"));
}

// What NUMBERS.md says of llvmpipe, found again.
TEST_F(GlTest, Survey_OfLlvmpipe_FindsWhatIsKnownOfIt) {
  const filters::GlAccuracy measured = survey_gl();
  EXPECT_EQ(measured.weight_bits, 23.0);
  EXPECT_GT(measured.exp_roundoffs, 1.0);
  EXPECT_LT(measured.exp_roundoffs, 100.0);
}

TEST_F(GlTest, TimerQuery_OfLlvmpipe_IsNotBelieved) {
  const TimerCheck check = check_timer(context());
  EXPECT_GT(check.wall_ms, 1.0);
  EXPECT_LT(check.agreement, 0.9);
  EXPECT_EQ(choose_timer(context()), TimerKind::kWallClock);
}

TEST_F(GlTest, WallTime_GrowsWithTheWork) {
  SurveyShader probe("survey_loop.frag", {256, 256});
  const auto time = [&](int iterations) {
    probe.program().set("u_turns", iterations);
    double best = time_ms(TimerKind::kWallClock, [&] { probe.draw(); });
    for (int i = 0; i < 4; ++i) best = std::min(best, time_ms(TimerKind::kWallClock, [&] { probe.draw(); }));
    return best;
  };
  EXPECT_GT(time(400), 4.0 * time(20));
}

TEST_F(GlTest, WallTime_LeavesOutWhatWasQueuedBefore) {
  SurveyShader probe("survey_loop.frag", {512, 512});
  probe.program().set("u_turns", 400);
  const auto time_nothing = [&] {
    probe.draw();
    return time_ms(TimerKind::kWallClock, [] {});
  };
  probe.draw();
  const double one_draw = time_ms(TimerKind::kWallClock, [&] { probe.draw(); });
  EXPECT_LT(std::min({time_nothing(), time_nothing(), time_nothing()}), 0.2 * one_draw);
}

TEST_F(GlTest, QueryTime_IsPositive) {
  SurveyShader probe("survey_loop.frag", {256, 256});
  probe.program().set("u_turns", 100);
  EXPECT_GT(time_ms(TimerKind::kQuery, [&] { probe.draw(); }), 0.0);
}

}  // namespace
}  // namespace shadowbench::gl
