#include "harness/view/workbench.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"

namespace shadowbench::view {
namespace {

void write(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

/// Watches a file that is there.
class FileWatchTest : public testing::Test {
 protected:
  FileWatchTest() : folder_(make_temporary_folder_path(std::filesystem::temp_directory_path(), "file watch")) {
    std::filesystem::create_directories(folder_.path());
    write(file(), "one");
    watch_.watch({file()});
  }

  std::filesystem::path file() const { return path("a.glsl"); }
  std::filesystem::path path(const char* name) const { return folder_.path() / name; }

  FileWatch watch_;

 private:
  ScratchFolder folder_;
};

TEST_F(FileWatchTest, SeesASave_AReplacement_AndNothingElse) {
  EXPECT_FALSE(watch_.has_changed());
  write(file(), "three");
  EXPECT_TRUE(watch_.has_changed());
  EXPECT_FALSE(watch_.has_changed());
  // Many editors write a new file and rename it.
  write(path("b"), "seven..");
  std::filesystem::rename(path("b"), file());
  EXPECT_TRUE(watch_.has_changed());
}

TEST_F(FileWatchTest, AFileThatIsGone_IsNoChangeUntilItIsBack) {
  std::filesystem::remove(file());
  EXPECT_FALSE(watch_.has_changed());
  write(file(), "other");
  EXPECT_TRUE(watch_.has_changed());
}

TEST_F(FileWatchTest, WatchingMore_ForgetsNoChange) {
  write(file(), "three");
  watch_.watch({file(), path("b")});
  EXPECT_TRUE(watch_.has_changed());
}

}  // namespace
}  // namespace shadowbench::view
