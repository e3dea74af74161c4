#include "report/files/file_name.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <set>

namespace shadowbench::files {
namespace {

TEST(FileName, PlainNames_StayAsTheyAre) {
  EXPECT_EQ(make_file_stem("cubes"), "cubes");
  EXPECT_EQ(make_file_stem("Old_house-2.lod1"), "Old_house-2.lod1");
}

TEST(FileName, AnyName_StaysInItsFolder) {
  for (const std::string name :
       {"../../etc/passwd", "..", ".", "", "/", "a/b", "a\\b", "-rf", ".hidden", "nul\0l", "ä"}) {
    const std::string stem = make_file_stem(name);
    EXPECT_THAT(stem, ::testing::MatchesRegex("[A-Za-z0-9_][A-Za-z0-9_.-]*")) << name;
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

}  // namespace
}  // namespace shadowbench::files
