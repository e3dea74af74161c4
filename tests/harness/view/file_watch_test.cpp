#include "harness/view/file_watch.h"

#include <gtest/gtest.h>

#include <fstream>

#include "filters/base/temporary_files.h"

namespace shadowbench::view {
namespace {

void write(const std::filesystem::path& file, const std::string& text) { std::ofstream(file) << text; }

/// A folder of this test's own.
class Folder : public ScratchFolder {
 public:
  Folder() : ScratchFolder(make_temporary_folder_path(std::filesystem::temp_directory_path(), "file watch")) {
    std::filesystem::create_directories(path());
  }
};

TEST(FileWatch, SeesASave_AReplacement_AndNothingElse) {
  const Folder folder;
  const std::filesystem::path file = folder.path() / "a.glsl";
  write(file, "one");
  FileWatch watch;
  watch.watch({file});
  EXPECT_FALSE(watch.has_changed());
  write(file, "three");
  EXPECT_TRUE(watch.has_changed());
  EXPECT_FALSE(watch.has_changed());
  // Many editors write a new file and rename it.
  write(folder.path() / "b", "seven..");
  std::filesystem::rename(folder.path() / "b", file);
  EXPECT_TRUE(watch.has_changed());
}

TEST(FileWatch, AFileThatIsGone_IsNoChangeUntilItIsBack) {
  const Folder folder;
  const std::filesystem::path file = folder.path() / "a.glsl";
  write(file, "one");
  FileWatch watch;
  watch.watch({file});
  std::filesystem::remove(file);
  EXPECT_FALSE(watch.has_changed());
  write(file, "other");
  EXPECT_TRUE(watch.has_changed());
}

TEST(FileWatch, WatchingMore_ForgetsNoChange) {
  const Folder folder;
  write(folder.path() / "a", "one");
  FileWatch watch;
  watch.watch({folder.path() / "a"});
  write(folder.path() / "a", "three");
  watch.watch({folder.path() / "a", folder.path() / "b"});
  EXPECT_TRUE(watch.has_changed());
}

}  // namespace
}  // namespace shadowbench::view
