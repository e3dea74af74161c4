// Frames in the files of a report.

#include "harness/live/frame_file.h"

#include "tests/test_files.h"

namespace shadowbench::live {
namespace {

class FrameFileTest : public ::testing::Test {
 protected:
  const TestFolder scratch_;

  static Frame make_frame(float value) {
    const auto texture = std::make_shared<gl::RecordedTexture>(gl::RecordedTexture{GL_R32F, 2, 2, 1, 0});
    gl::Step step{gl::ClearStep{glm::vec4(value)}, {{0, texture, 0, nullptr}}};
    return {std::make_shared<const gl::Step>(std::move(step))};
  }
};

TEST_F(FrameFileTest, AScriptHandsItsTextToThePage_UnderTheNameOfWhatItHolds) {
  const std::string path = write_frames(scratch_.path(), {{"a", make_frame(1.0f)}}, {});
  EXPECT_THAT(scratch_.read(path), StartsWith("shadowbenchValues(\"" + path + "\",\""));
  EXPECT_EQ(write_frames(scratch_.path(), {{"a", make_frame(1.0f)}}, {}), path);
  EXPECT_NE(write_frames(scratch_.path(), {{"a", make_frame(2.0f)}}, {}), path);
}

TEST_F(FrameFileTest, CopiesStandBesideWhatIsThere) {
  const std::filesystem::path from = scratch_.path() / "from", to = scratch_.path() / "to";
  const std::string first = write_frames(from, {{"a", make_frame(1.0f)}}, {});
  const std::string second = write_frames(to, {{"a", make_frame(2.0f)}}, {});
  copy_frames(from, to);
  EXPECT_EQ(read_text(to / first), read_text(from / first));
  EXPECT_TRUE(std::filesystem::exists(to / second));
  copy_frames(scratch_.path() / "nothing there", to);
}

}  // namespace
}  // namespace shadowbench::live
