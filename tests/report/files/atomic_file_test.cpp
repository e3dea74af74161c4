#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>

#include "base/error.h"
#include "base/files.h"
#include "report/images/picture_io.h"
#include "tests/report/records/synthetic.h"
#include "tests/test_files.h"

namespace shadowbench::files {

using namespace records;
namespace {

using ::testing::HasSubstr;

std::size_t count_files(const std::filesystem::path& dir) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(dir), {}));
}

std::string message_of(const std::function<void()>& action) {
  const Error error = error_of(action);
  EXPECT_EQ(error.kind(), ErrorKind::kOutput);
  return error.what();
}

TEST(AtomicFile, NotCommitted_LeavesNothing) {
  const TestFolder folder;
  {
    AtomicFile file(folder.path() / "results.json");
    file.write("half");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "results.json"));
    EXPECT_EQ(count_files(folder.path()), 1u);
  }
  EXPECT_EQ(count_files(folder.path()), 0u);
}

TEST(AtomicFile, NotCommitted_KeepsTheOldFile) {
  const TestFolder folder;
  write_text_file(folder.path() / "a.txt", "old");
  { AtomicFile(folder.path() / "a.txt").write("new"); }
  EXPECT_EQ(read_text(folder.path() / "a.txt"), "old");
}

TEST(AtomicFile, Committed_IsWholeAndAlone) {
  const TestFolder folder;
  write_text_file(folder.path() / "cells" / "a.json", "text");
  EXPECT_EQ(read_text(folder.path() / "cells" / "a.json"), "text");
  EXPECT_EQ(count_files(folder.path() / "cells"), 1u);
}

TEST(AtomicFile, TemporaryName_KeepsFolderAndExtension) {
  const TestFolder folder;
  const PendingFile file(folder.path() / "cubes.grid.png");
  EXPECT_EQ(file.temporary_path().parent_path(), folder.path());
  EXPECT_EQ(file.temporary_path().extension(), ".png");
  EXPECT_NE(file.temporary_path(), file.path());
}

/// Whoever made the folder may know the name that is written to first.
TEST(AtomicFile, LinkOfTheTemporaryName_IsNotWrittenThrough) {
  const TestFolder folder;
  const std::filesystem::path own = folder.path() / "own.txt", out = folder.path() / "a.png";
  const std::function<void()> writers[] = {[&] { write_text_file(out, "x"); }, [&] { copy_whole_file(__FILE__, out); },
                                           [&] { images::write_grey_png(out, images::Image(2, 2, 1)); }};
  write_text_file(own, "kept");
  for (const auto& write : writers) {
    std::filesystem::create_symlink(own, make_temporary_path(out));
    write();
    EXPECT_EQ(read_text(own), "kept");
    EXPECT_FALSE(std::filesystem::is_symlink(out));
  }
}

TEST(AtomicFile, FolderThatIsAFile_IsAnOutputErrorWithPathAndReason) {
  const TestFolder folder;
  write_text_file(folder.path() / "file", "");
  const std::string message = message_of([&] { write_text_file(folder.path() / "file" / "a.txt", "x"); });
  EXPECT_THAT(message, HasSubstr((folder.path() / "file").string()));
  EXPECT_THAT(message, HasSubstr("Not a directory"));
  EXPECT_THAT(message, HasSubstr("--out"));
}

TEST(AtomicFile, FolderThatVanishes_IsSaid) {
  const TestFolder folder;
  const std::string message = message_of([&] {
    AtomicFile file(folder.path() / "cells" / "a.json");
    std::filesystem::rename(folder.path() / "cells", folder.path() / "moved");
    file.commit();
  });
  EXPECT_THAT(message,
              HasSubstr((folder.path() / "cells" / "a.json").string() + ": its folder was removed or replaced"));
  EXPECT_THAT(message, HasSubstr("--out"));
}

TEST(AtomicFile, NameThatIsAFolder_IsAnOutputErrorAndLeavesNoTemporary) {
  const TestFolder folder;
  std::filesystem::create_directories(folder.path() / "a.txt" / "inside");
  EXPECT_THAT(message_of([&] { write_text_file(folder.path() / "a.txt", "x"); }), HasSubstr("Is a directory"));
  EXPECT_EQ(count_files(folder.path()), 1u);
}

// A limit on file sizes stands for a full disk.
TEST(AtomicFile, FullDisk_IsAnOutputErrorAndKeepsTheOldFile) {
  const TestFolder folder;
  write_text_file(folder.path() / "a.txt", "old");
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = message_of([&] { write_text_file(folder.path() / "a.txt", std::string(100000, 'x')); });
  const std::string short_message =
      message_of([&] { write_text_file(folder.path() / "a.txt", std::string(4097, 'x')); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, HasSubstr("File too large"));
  EXPECT_THAT(short_message, HasSubstr("File too large"));
  EXPECT_EQ(read_text(folder.path() / "a.txt"), "old");
  EXPECT_EQ(count_files(folder.path()), 1u);
}

}  // namespace
}  // namespace shadowbench::files
