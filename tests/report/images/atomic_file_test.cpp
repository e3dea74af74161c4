#include <sys/stat.h>

#include "base/folder_lock.h"
#include "report/images/picture_io.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench {
namespace {

using namespace records;
using AtomicFileTest = FolderTest;
using FolderLockTest = FolderTest;
using TemporaryFiles = FolderTest;

std::string message_of(const std::function<void()>& action) {
  const Error error = error_of(action);
  EXPECT_EQ(error.kind(), ErrorKind::kOutput);
  return error.what();
}

TEST_F(AtomicFileTest, NotCommitted_LeavesTheOldFileAndNothingElse) {
  write_text_file(folder_.path() / "a.txt", "old");
  {
    AtomicFile file(folder_.path() / "a.txt");
    file.write("half");
    EXPECT_EQ(read_text(folder_.path() / "a.txt"), "old");
    EXPECT_EQ(count_files(folder_.path()), 2u);
  }
  EXPECT_EQ(read_text(folder_.path() / "a.txt"), "old");
  EXPECT_EQ(count_files(folder_.path()), 1u);
}

TEST_F(AtomicFileTest, Committed_IsWholeAndAlone) {
  write_text_file(folder_.path() / "cells" / "a.json", "text");
  EXPECT_EQ(read_text(folder_.path() / "cells" / "a.json"), "text");
  EXPECT_EQ(count_files(folder_.path() / "cells"), 1u);
}

TEST_F(AtomicFileTest, TemporaryName_KeepsFolderAndExtension) {
  const PendingFile file(folder_.path() / "cubes.grid.png");
  EXPECT_EQ(file.temporary_path().parent_path(), folder_.path());
  EXPECT_EQ(file.temporary_path().extension(), ".png");
  EXPECT_NE(file.temporary_path(), file.path());
}

/// Whoever made the folder may know the name that is written to first.
TEST_F(AtomicFileTest, LinkOfTheTemporaryName_IsNotWrittenThrough) {
  const std::filesystem::path own = folder_.path() / "own.txt", out = folder_.path() / "a.png";
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

TEST_F(AtomicFileTest, FolderThatIsAFile_IsAnOutputErrorWithPathAndReason) {
  write_text_file(folder_.path() / "file", "");
  const std::string message = message_of([&] { write_text_file(folder_.path() / "file" / "a.txt", "x"); });
  EXPECT_THAT(message, HasSubstr((folder_.path() / "file").string()));
  EXPECT_THAT(message, HasSubstr("Not a directory"));
  EXPECT_THAT(message, HasSubstr("--out"));
}

TEST_F(AtomicFileTest, FolderThatVanishes_IsSaid) {
  const std::string message = message_of([&] {
    AtomicFile file(folder_.path() / "cells" / "a.json");
    std::filesystem::rename(folder_.path() / "cells", folder_.path() / "moved");
    file.commit();
  });
  EXPECT_THAT(message,
              HasSubstr((folder_.path() / "cells" / "a.json").string() + ": its folder was removed or replaced"));
  EXPECT_THAT(message, HasSubstr("--out"));
}

TEST_F(AtomicFileTest, NameThatIsAFolder_IsAnOutputErrorAndLeavesNoTemporary) {
  std::filesystem::create_directories(folder_.path() / "a.txt" / "inside");
  EXPECT_THAT(message_of([&] { write_text_file(folder_.path() / "a.txt", "x"); }), HasSubstr("Is a directory"));
  EXPECT_EQ(count_files(folder_.path()), 1u);
}

TEST_F(AtomicFileTest, FullDisk_IsAnOutputErrorAndKeepsTheOldFile) {
  write_text_file(folder_.path() / "a.txt", "old");
  for (const std::size_t bytes : {100000u, 4097u})
    EXPECT_THAT(
        with_file_limit(
            4096,
            [&] { return message_of([&] { write_text_file(folder_.path() / "a.txt", std::string(bytes, 'x')); }); }),
        HasSubstr("File too large"));
  EXPECT_EQ(read_text(folder_.path() / "a.txt"), "old");
  EXPECT_EQ(count_files(folder_.path()), 1u);
}

TEST(FileName, PlainNames_StayAsTheyAre) {
  EXPECT_EQ(make_file_stem("cubes"), "cubes");
  EXPECT_EQ(make_file_stem("Old_house-2.lod1"), "Old_house-2.lod1");
}

TEST(FileName, AnyName_StaysInItsFolder) {
  for (const std::string name :
       {"../../etc/passwd", "..", ".", "", "/", "a/b", "a\\b", "-rf", ".hidden", "nul\0l", "ä"}) {
    const std::string stem = make_file_stem(name);
    EXPECT_THAT(stem, MatchesRegex("[A-Za-z0-9_][A-Za-z0-9_.-]*")) << name;
    EXPECT_EQ(std::filesystem::path(stem + ".png").filename(), stem + ".png") << name;
  }
}

TEST(FileName, LongNames_AreCutAndStayApart) {
  const std::string a = make_file_stem(std::string(300, 'a'));
  const std::string b = make_file_stem(std::string(301, 'a'));
  EXPECT_EQ(a.size(), 80u);
  EXPECT_NE(a, b);
}

TEST(FileName, DifferentNames_NeverShareAFile) {
  std::set<std::string> stems;
  for (const std::string name : {"a b", "a_b", "a/b", "a:b", "a?b"}) stems.insert(make_file_stem(name));
  EXPECT_EQ(stems.size(), 5u);
}

TEST(FileName, UrlPath_KeepsFoldersAndEncodesTheRest) {
  EXPECT_EQ(encode_url_path("cells/a.json"), "cells/a.json");
  EXPECT_EQ(encode_url_path("a b#%?\"<ä>:.png"), "a%20b%23%25%3F%22%3C%C3%A4%3E%3A.png");
}

std::string refusal_of(const std::filesystem::path& folder) {
  const Error error = error_of([&] { const FolderLock lock(folder); });
  return error.kind() == ErrorKind::kOutput ? error.what() : "";
}

std::set<std::string> list_names(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    names.insert(entry.path().lexically_relative(folder).string());
  return names;
}

TEST_F(FolderLockTest, IsOfOneAtATime_AndLeavesItsMark) {
  const std::filesystem::path out = folder_.path() / "a" / "out";
  {
    const FolderLock lock(out);
    lock.require_in_place();
    const std::string refusal = refusal_of(out);
    EXPECT_THAT(refusal, HasSubstr(out.string()));
    EXPECT_THAT(refusal, HasSubstr("process " + std::to_string(getpid())));
  }
  EXPECT_EQ(list_names(out), std::set<std::string>{".shadowbench-folder"});
  EXPECT_EQ(refusal_of(out), "");
}

TEST_F(FolderLockTest, OfAKilledProcess_IsFree) {
  write_text_file(folder_.path() / ".shadowbench-lock", "1\n");
  EXPECT_EQ(refusal_of(folder_.path()), "");
}

TEST_F(FolderLockTest, FolderThatIsGoneOrAnother_IsNoticed) {
  const std::filesystem::path out = folder_.path() / "out";
  const FolderLock lock(out);
  std::filesystem::remove_all(out);
  EXPECT_THROW(lock.require_in_place(), Error);
  const FolderLock other(out);
  EXPECT_THROW(lock.require_in_place(), Error);
  EXPECT_NO_THROW(other.require_in_place());
}

/// It would empty the file that the link leads to.
TEST_F(FolderLockTest, LockThatIsALinkOrAPipe_IsRefused) {
  const std::filesystem::path own = folder_.path() / "own.txt", lock = folder_.path() / "out" / ".shadowbench-lock";
  write_text_file(own, "kept");
  std::filesystem::create_directories(lock.parent_path());
  const std::function<void()> makers[] = {
      [&] { std::filesystem::create_symlink(own, lock); }, [&] { std::filesystem::create_symlink("nowhere", lock); },
      [&] { std::filesystem::create_hard_link(own, lock); }, [&] { ASSERT_EQ(mkfifo(lock.c_str(), 0600), 0); }};
  for (const auto& make : makers) {
    make();
    EXPECT_NE(refusal_of(lock.parent_path()), "");
    EXPECT_THROW(FolderLock(lock.parent_path(), true), Error);
    EXPECT_EQ(read_text(own), "kept");
    EXPECT_TRUE(std::filesystem::remove(lock)) << "it is left where it was";
  }
}

TEST_F(FolderLockTest, LinkAtAnyLevel_IsRefused) {
  const std::filesystem::path out = folder_.path() / "out", link = out / "a" / "b" / "link";
  { const FolderLock marks(out); }
  std::filesystem::create_directories(link.parent_path());
  for (const auto& target : {folder_.path(), std::filesystem::path("nowhere")}) {
    std::filesystem::create_directory_symlink(target, link);
    EXPECT_THAT(refusal_of(out), HasSubstr(link.string()));
    std::filesystem::remove(link);
  }
  EXPECT_EQ(refusal_of(out), "");
}

TEST_F(FolderLockTest, FolderOfSomebodyElse_IsLeftAsItIs_UnlessItIsTold) {
  for (const char* name : {"results.json", "index.html", "a.shadowbench-tmp-99999999.png", ".worker-99999999/a",
                           "cells/notes.json", "stress/notes.txt", "deep/er/a.txt"}) {
    const TestFolder folder;
    write_text_file(folder.path() / name, R"({"schema_version": 1})");
    const std::set<std::string> before = list_names(folder.path());
    EXPECT_THAT(refusal_of(folder.path()), HasSubstr("--force")) << name;
    EXPECT_EQ(list_names(folder.path()), before) << name;
    EXPECT_NO_THROW(FolderLock(folder.path(), true)) << name;
  }
}

/// A copy may have lost its mark.
TEST_F(FolderLockTest, FolderOfThisProgram_IsTakenAgain) {
  for (const char* name : {"results.json", "stress.json", ".shadowbench-folder"}) {
    const TestFolder folder;
    write_text_file(folder.path() / name, R"({"command": ["shadowbench"], "schema_version": 1})");
    write_text_file(folder.path() / "notes.txt", "of the user");
    EXPECT_EQ(refusal_of(folder.path()), "") << name;
  }
  { const FolderLock inner(folder_.path() / "out" / "stress"); }
  EXPECT_EQ(refusal_of(folder_.path() / "out"), "");
}

/// Only names of ours are removed, however alike others are.
TEST_F(TemporaryFiles, AreRemoved_AndNothingElseIs) {
  const char* others[] = {"a.json",      "a.tmp-12.png", "a.shadowbench-tmp-.png", "a.shadowbench-tmp-12x.png",
                          ".worker-x/a", ".worker-/a",   "cells/b.json",           "deep/er/a.shadowbench-tmp-12.png"};
  const char* ours[] = {"a.shadowbench-tmp-12.png",        "b.grid.shadowbench-tmp-12.json", "c.shadowbench-tmp-12",
                        "cells/d.shadowbench-tmp-12.json", ".worker-12/cells/e.json",        ".gpu-12/request.json"};
  for (const char* name : others) write_text_file(folder_.path() / name, "x");
  for (const char* name : ours) write_text_file(folder_.path() / name, "x");
  remove_temporary_files(folder_.path(), [](const Writer& writer) { return writer.process == 13; });
  for (const char* name : ours) EXPECT_TRUE(std::filesystem::exists(folder_.path() / name)) << name;
  remove_temporary_files(folder_.path(), [](const Writer& writer) { return writer.process == 12; });
  for (const char* name : ours) EXPECT_FALSE(std::filesystem::exists(folder_.path() / name)) << name;
  for (const char* name : others) EXPECT_TRUE(std::filesystem::exists(folder_.path() / name)) << name;
  EXPECT_FALSE(is_gone(this_writer()));
  EXPECT_TRUE(is_gone({this_writer().host, 99999999}));
}

/// Machines that share a folder have processes of equal numbers.
TEST_F(TemporaryFiles, OfAnotherMachine_AreItsOwn) {
  const std::string theirs = "a.shadowbench-tmp-99999999-elsewhere.json";
  write_text_file(folder_.path() / theirs, "x");
  write_text_file(folder_.path() / ("a.shadowbench-tmp-99999999-" + this_writer().host + ".json"), "x");
  remove_temporary_files(folder_.path(), is_gone);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / theirs));
  std::filesystem::remove(folder_.path() / theirs);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  const std::string own = make_temporary_path("a.json").string();
  EXPECT_TRUE(own.ends_with(this_writer().host + ".json")) << own;
}

TEST_F(TemporaryFiles, NamesOfThisProcess_AreRecognised) {
  { PendingFile(folder_.path() / "x.png"); }
  for (const char* name : {"x.png", "x", "x.y.exr"}) write_text_file(make_temporary_path(folder_.path() / name), "x");
  std::filesystem::create_directories(make_temporary_folder_path(folder_.path(), "worker"));
  remove_temporary_files(folder_.path(), [](const Writer& writer) { return writer == this_writer(); });
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace shadowbench
