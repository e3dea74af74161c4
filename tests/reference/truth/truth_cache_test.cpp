// Traced images are kept between runs, and taken only where they are whole and follow from the very same content.

#include "reference/truth/truth_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

namespace shadowbench::truth {
namespace {

constexpr std::size_t kValues = 32;

std::optional<Layers> load(TruthCache& cache, const std::string& name) { return cache.load(name, 2, kValues); }

class Cache : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    folder_ = std::filesystem::temp_directory_path() / ("shadowbench.cache." + name + "." + std::to_string(getpid()));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  TruthCache open() {
    return {folder_, [this](const std::string& message) { notes_.push_back(message); }};
  }
  static std::string read(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".truth"); }

  static Layers make_layers(float value) {
    std::vector<float> layer(kValues);
    for (std::size_t i = 0; i < layer.size(); ++i) layer[i] = value + static_cast<float>(i);
    return {layer, std::vector<float>(kValues, value)};
  }

  std::filesystem::path folder_;
  std::vector<std::string> notes_;
};

TEST_F(Cache, GivesBackWhatWasStored) {
  TruthCache cache = open();
  EXPECT_FALSE(load(cache, "a"));
  cache.store("a", make_layers(0.5f));
  EXPECT_EQ(load(cache, "a"), make_layers(0.5f));
  EXPECT_EQ(cache.loaded(), 1);
  EXPECT_EQ(cache.traced(), 1);
  EXPECT_FALSE(load(cache, "b"));
}

TEST_F(Cache, AnotherContentUnderTheName_IsNotTaken) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  std::filesystem::copy(file("a"), file("b"));
  EXPECT_FALSE(load(cache, "b"));
}

/// What the file holds is whole; only the checksum in its first line says that something else was stored.
TEST_F(Cache, OtherValuesUnderTheSameFirstLine_AreNotTaken) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  const std::string first_line = read(file("a")).substr(0, read(file("a")).find('\n'));
  cache.store("a", make_layers(0.75f));
  const std::string other = read(file("a"));
  std::ofstream(file("a"), std::ios::binary) << first_line << other.substr(other.find('\n'));
  EXPECT_FALSE(load(cache, "a"));
}

TEST_F(Cache, AnotherSize_IsNotTaken) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  EXPECT_FALSE(cache.load("a", 1, kValues));
  EXPECT_FALSE(cache.load("a", 2, kValues / 2));
  EXPECT_FALSE(cache.load("a", 4, kValues / 2));
}

TEST_F(Cache, DamagedFiles_AreNotTaken_AndCanBeReplaced) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  const auto size = std::filesystem::file_size(file("a"));
  for (const std::uintmax_t kept : {std::uintmax_t{0}, std::uintmax_t{7}, size / 2, size - 1}) {
    cache.store("a", make_layers(0.5f));
    std::filesystem::resize_file(file("a"), kept);
    EXPECT_FALSE(load(cache, "a")) << kept << " of " << size;
  }
  cache.store("a", make_layers(0.5f));
  ASSERT_TRUE(load(cache, "a"));
}

TEST_F(Cache, AFileThatIsFarTooLong_IsNotRead) {
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  std::filesystem::resize_file(file("a"), std::uintmax_t{1} << 27);
  EXPECT_FALSE(load(cache, "a"));
}

TEST_F(Cache, AFlippedBit_IsNoticed) {
  TruthCache cache = open();
  int noticed = 0, tried = 0;
  cache.store("a", make_layers(0.5f));
  const auto size = std::filesystem::file_size(file("a"));
  for (std::uintmax_t at = 0; at < size; at += 3) {
    cache.store("a", make_layers(0.5f));
    std::fstream stream(file("a"), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(at));
    const int byte = stream.get();
    stream.seekp(static_cast<std::streamoff>(at));
    stream.put(static_cast<char>(byte ^ 4));
    stream.close();
    const auto layers = load(cache, "a");
    ++tried;
    // A bit that no value depends on may differ; values may not.
    if (!layers || *layers == make_layers(0.5f)) ++noticed;
  }
  EXPECT_GT(tried, 20);
  EXPECT_EQ(noticed, tried);
}

TEST_F(Cache, Prune_RemovesWhatWasUsedLongestAgo) {
  TruthCache cache = open();
  for (const char* name : {"a", "b", "c"}) cache.store(name, make_layers(0.5f));
  const auto now = std::filesystem::file_time_type::clock::now();
  std::filesystem::last_write_time(file("a"), now - std::chrono::hours(2));
  std::filesystem::last_write_time(file("b"), now - std::chrono::hours(3));
  std::filesystem::last_write_time(file("c"), now - std::chrono::hours(1));
  ASSERT_TRUE(load(cache, "b"));  // used just now
  cache.prune(2 * std::filesystem::file_size(file("a")));
  EXPECT_FALSE(std::filesystem::exists(file("a")));
  EXPECT_TRUE(std::filesystem::exists(file("b")));
  EXPECT_TRUE(std::filesystem::exists(file("c")));
}

/// Neither a name nor an ending nor what it begins with makes a file ours, and none makes a folder another's.
TEST_F(Cache, Prune_LeavesFilesThatAreNotOurs) {
  open().store("a", make_layers(0.5f));
  std::ofstream(folder_ / "old.exr") << std::string(1000, 'x');
  std::ofstream(folder_ / "own.truth") << std::string(1000, 'x');
  std::filesystem::copy_file(file("a"), folder_ / "copy.bin");
  std::filesystem::create_symlink("a.truth", folder_ / "link.truth");
  open().prune(0);
  EXPECT_FALSE(std::filesystem::exists(file("a")));
  for (const char* name : {"old.exr", "own.truth", "copy.bin", "link.truth"})
    EXPECT_TRUE(std::filesystem::is_symlink(folder_ / name) || std::filesystem::exists(folder_ / name)) << name;
}

TEST_F(Cache, InAFolderOfTheUser_NothingIsDeleted) {
  std::filesystem::create_directories(folder_);
  const auto own = folder_ / "own.exr", half = folder_ / "a.shadowbench-tmp-999999999.truth";
  for (const auto& each : {own, half}) std::ofstream(each) << "kept";
  TruthCache cache = open();
  cache.store("a", make_layers(0.5f));
  cache.prune(0);
  for (const auto& each : {own, half, file("a")}) EXPECT_TRUE(std::filesystem::exists(each)) << each;
  EXPECT_TRUE(load(cache, "a"));
}

/// What versions of before made has no tag.
TEST_F(Cache, AFolderOfTruthsAlone_IsOurs) {
  open().store("a", make_layers(0.5f));
  std::filesystem::remove(folder_ / "CACHEDIR.TAG");
  std::filesystem::create_directories(folder_ / "gpu");
  TruthCache cache = open();
  cache.prune(0);
  EXPECT_FALSE(std::filesystem::exists(file("a")));
}

/// A process number that is free belongs to a process that is gone.
TEST_F(Cache, WhatKilledProcessesLeft_IsRemoved) {
  std::filesystem::create_directories(folder_);
  const auto half = folder_ / "a.shadowbench-tmp-999999999.truth";
  std::ofstream(half) << "half";
  open();
  EXPECT_FALSE(std::filesystem::exists(half));
}

TEST_F(Cache, AFolderThatCannotBeWritten_IsNotedOnce_AndNothingIsLost) {
  std::ofstream(folder_) << "a file where the folder should be";
  TruthCache cache = open();
  EXPECT_FALSE(load(cache, "a"));
  cache.store("a", make_layers(0.5f));
  cache.store("b", make_layers(0.5f));
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_THAT(notes_[0], ::testing::HasSubstr(folder_.string()));
  EXPECT_THAT(notes_[0], ::testing::HasSubstr("--cache"));
}

TEST_F(Cache, WithoutAFolder_KeepsNothing) {
  TruthCache cache({}, [](const std::string&) { FAIL(); });
  cache.store("a", make_layers(0.5f));
  EXPECT_FALSE(load(cache, "a"));
  cache.prune(0);
}

}  // namespace
}  // namespace shadowbench::truth
