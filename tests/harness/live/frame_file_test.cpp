// Frames in the files of a report.

#include "harness/live/frame_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/files.h"

namespace shadowbench::live {
namespace {

using ::testing::StartsWith;

class FrameFileTest : public ::testing::Test {
 protected:
  const ScratchFolder scratch_{make_temporary_folder_path(std::filesystem::temp_directory_path() / "frames", "test")};

  static Frame make_frame(float value) {
    const auto texture = std::make_shared<gl::RecordedTexture>(gl::RecordedTexture{GL_R32F, 2, 2, 1, 0});
    gl::Step step{gl::ClearStep{glm::vec4(value)}, {{0, texture, 0, nullptr}}};
    return {std::make_shared<const gl::Step>(std::move(step))};
  }

  static std::string read(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
};

TEST_F(FrameFileTest, AScriptHandsItsTextToThePage_UnderTheNameOfWhatItHolds) {
  const std::string path = write_frames(scratch_.path(), {{"a", make_frame(1.0f)}}, {});
  EXPECT_THAT(read(scratch_.path() / path), StartsWith("shadowbenchValues(\"" + path + "\",\""));
  EXPECT_EQ(write_frames(scratch_.path(), {{"a", make_frame(1.0f)}}, {}), path);
  EXPECT_NE(write_frames(scratch_.path(), {{"a", make_frame(2.0f)}}, {}), path);
}

TEST_F(FrameFileTest, CopiesStandBesideWhatIsThere) {
  const std::filesystem::path from = scratch_.path() / "from", to = scratch_.path() / "to";
  const std::string first = write_frames(from, {{"a", make_frame(1.0f)}}, {});
  const std::string second = write_frames(to, {{"a", make_frame(2.0f)}}, {});
  copy_frames(from, to);
  EXPECT_EQ(read(to / first), read(from / first));
  EXPECT_TRUE(std::filesystem::exists(to / second));
  copy_frames(scratch_.path() / "nothing there", to);
}

}  // namespace
}  // namespace shadowbench::live
