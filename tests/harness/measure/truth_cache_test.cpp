// Traced images are kept between runs, and taken only where they are whole and follow from the very same content.

#include "harness/measure/truth_cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

namespace shadowbench::measure {
namespace {

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
  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".exr"); }

  static std::vector<images::Part> make_parts(float value) {
    images::Image image(8, 4, 1);
    for (std::size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = value + static_cast<float>(i);
    return {{"visibility", {"Y"}, image, false}, {"rays", {"Y"}, image, false}};
  }

  std::filesystem::path folder_;
  std::vector<std::string> notes_;
};

TEST_F(Cache, GivesBackWhatWasStored) {
  TruthCache cache = open();
  EXPECT_FALSE(cache.load("a"));
  cache.store("a", make_parts(0.5f));
  const auto parts = cache.load("a");
  ASSERT_TRUE(parts);
  EXPECT_EQ((*parts)[0].name, "visibility");
  EXPECT_EQ((*parts)[1].image.texels, make_parts(0.5f)[1].image.texels);
  EXPECT_EQ(cache.loaded(), 1);
  EXPECT_EQ(cache.traced(), 1);
  EXPECT_FALSE(cache.load("b"));
}

TEST_F(Cache, AnotherContentUnderTheName_IsNotTaken) {
  TruthCache cache = open();
  cache.store("a", make_parts(0.5f));
  std::filesystem::copy(file("a"), file("b"));
  EXPECT_FALSE(cache.load("b"));
}

TEST_F(Cache, DamagedFiles_AreNotTaken_AndCanBeReplaced) {
  TruthCache cache = open();
  cache.store("a", make_parts(0.5f));
  const auto size = std::filesystem::file_size(file("a"));
  for (const std::uintmax_t kept : {std::uintmax_t{0}, std::uintmax_t{7}, size / 2, size - 1}) {
    cache.store("a", make_parts(0.5f));
    std::filesystem::resize_file(file("a"), kept);
    EXPECT_FALSE(cache.load("a")) << kept << " of " << size;
  }
  cache.store("a", make_parts(0.5f));
  ASSERT_TRUE(cache.load("a"));
}

TEST_F(Cache, AFlippedBit_IsNoticed) {
  TruthCache cache = open();
  int noticed = 0, tried = 0;
  cache.store("a", make_parts(0.5f));
  const auto size = std::filesystem::file_size(file("a"));
  for (std::uintmax_t at = size / 2; at < size; at += 3) {
    cache.store("a", make_parts(0.5f));
    std::fstream stream(file("a"), std::ios::in | std::ios::out | std::ios::binary);
    stream.seekg(static_cast<std::streamoff>(at));
    const int byte = stream.get();
    stream.seekp(static_cast<std::streamoff>(at));
    stream.put(static_cast<char>(byte ^ 4));
    stream.close();
    const auto parts = cache.load("a");
    ++tried;
    // Bits that no value follows from may differ; values may not.
    if (!parts || ((*parts)[0].image.texels == make_parts(0.5f)[0].image.texels &&
                   (*parts)[1].image.texels == make_parts(0.5f)[1].image.texels))
      ++noticed;
  }
  EXPECT_GT(tried, 20);
  EXPECT_EQ(noticed, tried);
}

TEST_F(Cache, Prune_RemovesWhatWasUsedLongestAgo) {
  TruthCache cache = open();
  for (const char* name : {"a", "b", "c"}) cache.store(name, make_parts(0.5f));
  const auto now = std::filesystem::file_time_type::clock::now();
  std::filesystem::last_write_time(file("a"), now - std::chrono::hours(2));
  std::filesystem::last_write_time(file("b"), now - std::chrono::hours(3));
  std::filesystem::last_write_time(file("c"), now - std::chrono::hours(1));
  ASSERT_TRUE(cache.load("b"));  // used just now
  cache.prune(2 * std::filesystem::file_size(file("a")));
  EXPECT_FALSE(std::filesystem::exists(file("a")));
  EXPECT_TRUE(std::filesystem::exists(file("b")));
  EXPECT_TRUE(std::filesystem::exists(file("c")));
}

TEST_F(Cache, AFolderThatCannotBeWritten_IsNotedOnce_AndNothingIsLost) {
  std::ofstream(folder_) << "a file where the folder should be";
  TruthCache cache = open();
  EXPECT_FALSE(cache.load("a"));
  cache.store("a", make_parts(0.5f));
  cache.store("b", make_parts(0.5f));
  ASSERT_EQ(notes_.size(), 1u);
  EXPECT_THAT(notes_[0], ::testing::HasSubstr(folder_.string()));
  EXPECT_THAT(notes_[0], ::testing::HasSubstr("--cache"));
}

TEST_F(Cache, WithoutAFolder_KeepsNothing) {
  TruthCache cache({}, [](const std::string&) { FAIL(); });
  cache.store("a", make_parts(0.5f));
  EXPECT_FALSE(cache.load("a"));
  cache.prune(0);
}

}  // namespace
}  // namespace shadowbench::measure
