#include "harness/scene/files/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/harness/scene/test_files.h"

namespace shadowbench::scene {
namespace {

using testing::HasSubstr;

/// Bytes from text, so that zeros and escapes can stand in it.
template <std::size_t N>
std::vector<unsigned char> bytes(const char (&text)[N]) {
  return {text, text + N - 1};
}

void expect_size(const std::vector<unsigned char>& picture, std::uint64_t width, std::uint64_t height) {
  const std::optional<PictureSize> size = read_picture_size(picture);
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width, width);
  EXPECT_EQ(size->height, height);
}

constexpr char kHugePng[] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\1\0\0\0\1\0\0\x08\2\0\0\0";
constexpr char kHugeTga[] = "\0\0\2\0\0\0\0\0\0\0\0\0\xff\xff\xff\xff\x20\x28";

TEST(PictureHeader, SizesOfEveryKind_AreRead) {
  expect_size(bytes("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\1\2\0\0\3\4\x08\2\0\0\0"), 0x102, 0x304);
  expect_size(bytes("\xff\xd8\xff\xe0\0\4ab\xff\xff\xc0\0\x11\x08\1\2\3\4\3\1\x22\0"), 0x304, 0x102);
  expect_size(bytes("BM....\0\0\0\0....\x28\0\0\0\2\1\0\0\xfe\xff\xff\xff"), 0x102, 2);
  expect_size(bytes("BM....\0\0\0\0....\x0c\0\0\0\2\1\4\3\1\0\x18\0"), 0x102, 0x304);
  expect_size(bytes("GIF89a\2\1\4\3\0\0\0"), 0x102, 0x304);
  expect_size(bytes("\0\0\2\0\0\0\0\0\0\0\0\0\2\1\4\3\x20\x28"), 0x102, 0x304);
  expect_size(bytes(kHugePng), 65536, 65536);
}

TEST(PictureHeader, OtherAndShortBytes_HaveNoSize) {
  for (const auto& other : {bytes("8BPS\0\1\0\0\0\0\0\0\0\3\0\0\0\1\0\0\0\1"), bytes("P6 99999 99999 255\n"),
                            bytes("#?RADIANCE\n-Y 9 +X 9\n"), bytes("\x89PNG\r\n\x1a\n\0\0\0\4CgBI\0\0\0\1\0\0\0\1"),
                            bytes("\xff\xd8\xff\xff\xff"), bytes("BM"), bytes("")})
    EXPECT_FALSE(read_picture_size(other));
}

TEST(PictureHeader, ClaimsThatNoMemoryHolds_AreRefusedBeforeDecoding) {
  const auto complaint = [](const std::vector<unsigned char>& picture) {
    return error_of([&] { decode_texture(picture, "huge", "a.gltf", {}); }).message();
  };
  EXPECT_THAT(complaint(bytes(kHugePng)),
              testing::AllOf(HasSubstr("'huge' says that it has 65536 x 65536"), HasSubstr("16384")));
  EXPECT_THAT(complaint(bytes(kHugeTga)), HasSubstr("65535 x 65535"));
  EXPECT_THAT(complaint(bytes("\0\0\2\0\0\0\0\0\0\0\0\0\1\x20\1\x20\x20\x28")), HasSubstr("8193 x 8193"));
}

TEST(PictureHeader, AllTexturesOfAModel_AreCountedTogether) {
  const auto small = bytes(
      "\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\x20\x28"
      "abcd");
  const Texture large{"large", 16384, 16384, {}};
  EXPECT_EQ(decode_texture(small, "small", "a.gltf", {}).rgba.size(), 4U);
  const Error error = error_of([&] { decode_texture(small, "small", "a.gltf", {large}); });
  EXPECT_THAT(error.message(), testing::AllOf(HasSubstr("'small'"), HasSubstr("268435457")));
}

}  // namespace
}  // namespace shadowbench::scene
