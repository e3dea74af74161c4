// Whatever happened to the cache of traced images, results are the same.

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/harness/cli/faults.h"

namespace shadowbench::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kRun =
    "run --fresh --no-grids --size 64x36 --map-size 32 --rounds 1 --scene cubes --filters none,pcf2x2 --out out ";

class FaultCache : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    const Outcome outcome = run(kRun);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    std::filesystem::rename(folder() / "out", folder() / "whole");
    ASSERT_GE(files().size(), 2u);
  }

  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found = list_files("cache");
    // That of a single layer is of the supersampled picture, which the run's work does not count; one of none says that
    // a view was traced.
    const auto counts = [](const std::filesystem::path& path) {
      const std::string layers = path.extension() == ".truth" ? count_layers(path) : "";
      return !layers.empty() && !layers.starts_with("0x") && !layers.starts_with("1x");
    };
    std::erase_if(found, [&](const auto& path) { return !counts(path); });
    std::sort(found.begin(), found.end());
    return found;
  }

  /// Runs again; expects the same results, of as many truths traced anew.
  void expect_traced_again(std::size_t traced, const std::string& arguments = "") const {
    const Outcome outcome = run(kRun + arguments);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(results()["work"]["truths_traced"], traced);
    for (std::size_t i = 0; i < 2; ++i)
      for (const char* part : {"error", "attribution", "artefact", "truth"})
        EXPECT_EQ(results()["cells"][i][part], results("whole")["cells"][i][part]) << part;
  }

  /// The first line of a file, and all that follows.
  static std::pair<std::string, std::string> split_file(const std::filesystem::path& path) {
    const std::string whole = read_text(path);
    return {whole.substr(0, whole.find('\n')), whole.substr(whole.find('\n'))};
  }

  static std::string count_layers(const std::filesystem::path& path) {
    std::istringstream line(split_file(path).first);
    std::string word;
    for (int i = 0; i < 5; ++i) line >> word;
    return word;
  }

  static void flip_bit(const std::filesystem::path& path, std::uintmax_t at) {
    std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(at));
    const int byte = stream.get();
    stream.seekp(static_cast<std::streamoff>(at));
    stream.put(static_cast<char>(byte ^ 16));
  }
};

TEST_F(FaultCache, Intact_IsTaken) { expect_traced_again(0); }

TEST_F(FaultCache, TruncatedFiles_AreTracedAgain_AndKept) {
  for (const auto& path : files()) std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3);
  expect_traced_again(files().size());
  expect_traced_again(0);
}

TEST_F(FaultCache, FlippedBits_AreNoticed) {
  // In the middle of a file of equal values a bit may change nothing.
  for (const auto& path : files()) flip_bit(path, split_file(path).first.size() + 1);
  expect_traced_again(files().size());
  expect_traced_again(0);
}

/// Each file is whole; only the checksum in its first line says that it does not hold what was traced.
TEST_F(FaultCache, OtherValues_AreNoticed) {
  const auto all = files();
  std::map<std::string, std::vector<std::filesystem::path>> by_layers;
  for (const auto& path : all) by_layers[count_layers(path)].push_back(path);
  const auto alike = std::ranges::find_if(by_layers, [](const auto& each) { return each.second.size() >= 2; });
  ASSERT_NE(alike, by_layers.end());
  const auto &first = alike->second[0], &second = alike->second[1];
  const auto [first_line, first_values] = split_file(first);
  const auto [second_line, second_values] = split_file(second);
  std::ofstream(first, std::ios::binary) << first_line << second_values;
  std::ofstream(second, std::ios::binary) << second_line << first_values;
  expect_traced_again(2);
  expect_traced_again(0);
}

/// A file of another content, or of another version, has its name in it.
TEST_F(FaultCache, FilesUnderAnothersName_AreNotTaken) {
  const auto all = files();
  std::filesystem::copy_file(all[0], all[1], std::filesystem::copy_options::overwrite_existing);
  expect_traced_again(1);
  write("cache/" + all[0].lexically_relative(cache_folder()).string(), "a file of some other program\n");
  expect_traced_again(1);
}

TEST_F(FaultCache, AFolderOrAPipeInAFilesPlace_IsSaidOrReplaced) {
  const auto all = files();
  std::filesystem::remove(all[0]);
  std::filesystem::create_directories(all[0] / "inside");
  expect_traced_again(1);
  EXPECT_THAT(read_text(folder() / "stderr.txt"),
              HasSubstr("warning: traced images are not kept for the next run: " + all[0].string()));
  std::filesystem::remove_all(all[0]);
  ASSERT_EQ(mkfifo(all[0].c_str(), 0600), 0);
  expect_traced_again(1);
  expect_traced_again(0);
}

TEST_F(FaultCache, OnAReadOnlyMount_IsRead_AndNotWritten) {
  const auto shell = find_mounting_shell();
  if (!shell) GTEST_SKIP() << "no file system can be mounted here (neither as root nor with 'unshare -rm')";
  const std::string script =
      "mount --bind cache cache && mount -o remount,bind,ro cache || exit 98\nrm -f cache/no 2>/dev/null\nshadowbench ";
  EXPECT_EQ(run_script(*shell, script + kRun), 0);
  EXPECT_EQ(results()["work"]["truths_traced"], 0);
  EXPECT_THAT(read_text(folder() / "script.txt"), Not(HasSubstr("warning")));
  EXPECT_EQ(run_script(*shell, script + kRun + "--seed 2"), 0);
  EXPECT_THAT(read_text(folder() / "script.txt"), HasSubstr("warning: traced images are not kept for the next run"));
  EXPECT_THAT(read_text(folder() / "script.txt"), HasSubstr("Read-only file system"));
}

TEST_F(FaultCache, ThatCannotBeCreated_IsSaid) {
  write("taken", "a file");
  const std::size_t all = files().size();
  expect_traced_again(all, "--cache taken/inner");
  EXPECT_THAT(read_text(folder() / "stderr.txt"),
              HasSubstr("warning: traced images are not kept for the next run: taken/inner"));
}

/// What a killed run left is cleared away; what a living process is writing is not.
TEST_F(FaultCache, HalfWrittenFilesOfTheDead_AreRemoved) {
  const auto path = files().front();
  const auto of = [&](const std::string& process) {
    return path.parent_path() / ("x.shadowbench-tmp-" + process + ".truth");
  };
  for (const std::string& process : {std::string("99999999"), std::to_string(getpid())})
    std::ofstream(of(process)) << "half";
  expect_traced_again(0);
  EXPECT_FALSE(std::filesystem::exists(of("99999999")));
  EXPECT_TRUE(std::filesystem::exists(of(std::to_string(getpid()))));
}

}  // namespace
}  // namespace shadowbench::test
