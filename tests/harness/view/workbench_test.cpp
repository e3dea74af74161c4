#include "harness/view/workbench.h"

#include <gtest/gtest.h>

#include "tests/test_files.h"

namespace shadowbench::view {
namespace {

/// Watches a file that is there.
class FileWatchTest : public testing::Test {
 protected:
  FileWatchTest() { watch_.watch({write("a.glsl", "one")}); }

  std::filesystem::path write(const char* name, const char* text) const { return folder_.write(name, text); }
  std::filesystem::path path(const char* name) const { return folder_.path() / name; }

  const TestFolder folder_;
  FileWatch watch_;
};

TEST_F(FileWatchTest, SeesASave_AReplacement_AndNothingElse) {
  EXPECT_FALSE(watch_.has_changed());
  write("a.glsl", "three");
  EXPECT_TRUE(watch_.has_changed());
  EXPECT_FALSE(watch_.has_changed());
  // Many editors write a new file and rename it.
  write("b", "seven..");
  std::filesystem::rename(path("b"), path("a.glsl"));
  EXPECT_TRUE(watch_.has_changed());
}

TEST_F(FileWatchTest, AFileThatIsGone_IsNoChangeUntilItIsBack) {
  std::filesystem::remove(path("a.glsl"));
  EXPECT_FALSE(watch_.has_changed());
  write("a.glsl", "other");
  EXPECT_TRUE(watch_.has_changed());
}

TEST_F(FileWatchTest, WatchingMore_ForgetsNoChange) {
  write("a.glsl", "three");
  watch_.watch({path("a.glsl"), path("b")});
  EXPECT_TRUE(watch_.has_changed());
}

}  // namespace
}  // namespace shadowbench::view
