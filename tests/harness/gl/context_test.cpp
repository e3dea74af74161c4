#include "harness/gl/context/context.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/gl/objects.h"
#include "harness/gl/survey.h"
#include "tests/test_files.h"

namespace shadowbench::gl {
namespace {

TEST(Backend, EveryName_ReadsBackAsItself) {
  for (const Backend backend : {Backend::kAuto, Backend::kOsmesa, Backend::kEgl, Backend::kGlfw})
    EXPECT_EQ(parse_backend(backend_name(backend)), backend);
}

TEST(Backend, UnknownName_IsAUsageErrorThatListsTheOthers) {
  const Error error = error_of([] { parse_backend("vulkan"); });
  EXPECT_EQ(error.kind(), ErrorKind::kUsage);
  EXPECT_THAT(error.message(), ::testing::HasSubstr("'vulkan'"));
  EXPECT_THAT(error.message(), ::testing::HasSubstr("osmesa"));
}

TEST(PixelFormat, Name_FindsTheFormat) {
  EXPECT_EQ(parse_pixel_format("rg16f").internal_format, static_cast<GLenum>(GL_RG16F));
  EXPECT_EQ(parse_pixel_format("rg16f").bytes_per_texel, 4);
  EXPECT_EQ(&parse_pixel_format("d24"), &pixel_format(GL_DEPTH_COMPONENT24));
}

TEST(PixelFormat, UnknownName_IsAUsageErrorThatListsTheOthers) {
  const Error error = error_of([] { parse_pixel_format("rgb5"); });
  EXPECT_EQ(error.kind(), ErrorKind::kUsage);
  EXPECT_THAT(error.message(), ::testing::HasSubstr("rg32f"));
}

TEST(PixelFormat, ChannelsThatItDoesNotHave_AreABug) {
  EXPECT_EQ(pixel_format(GL_RG32F).transfer_format(1), static_cast<GLenum>(GL_RED));
  EXPECT_EQ(pixel_format(GL_DEPTH_COMPONENT16).transfer_format(1), static_cast<GLenum>(GL_DEPTH_COMPONENT));
  EXPECT_THROW(pixel_format(GL_RG32F).transfer_format(3), std::logic_error);
  EXPECT_THROW(pixel_format(GL_RG32F).transfer_format(0), std::logic_error);
  EXPECT_THROW(pixel_format(GL_RGB565), std::logic_error);
}

TEST(TimerCheck, QueryThatAgreesInMostRuns_IsBelieved) {
  EXPECT_EQ((TimerCheck{10.0, 9.8, 1.0}).choice(), TimerKind::kQuery);
  EXPECT_EQ((TimerCheck{10.0, 9.8, 0.92}).choice(), TimerKind::kQuery);
}

TEST(TimerCheck, QueryThatAgreesNowAndThen_IsNotBelieved) {
  EXPECT_EQ((TimerCheck{10.0, 9.8, 0.8}).choice(), TimerKind::kWallClock);
  EXPECT_EQ(TimerCheck{}.choice(), TimerKind::kWallClock);
}

}  // namespace
}  // namespace shadowbench::gl
