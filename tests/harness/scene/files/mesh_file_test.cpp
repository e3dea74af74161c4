#include "harness/scene/files/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/test_files.h"

namespace shadowbench::scene {
namespace {

using testing::HasSubstr;

/// Bytes from text, so that zeros and escapes can stand in it.
template <std::size_t N>
std::vector<unsigned char> bytes(const char (&text)[N]) {
  return {text, text + N - 1};
}

constexpr char kHugePng[] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\1\0\0\0\1\0\0\x08\2\0\0\0";
constexpr char kHugeTga[] = "\0\0\2\0\0\0\0\0\0\0\0\0\xff\xff\xff\xff\x20\x28";

TEST(PictureHeader, ClaimsThatNoMemoryHolds_AreRefusedBeforeDecoding) {
  const auto complaint = [](const std::vector<unsigned char>& picture) {
    return error_of([&] { decode_texture(picture, "huge", "a.gltf", {}); }).message();
  };
  EXPECT_THAT(complaint(bytes(kHugePng)),
              HasSubstr("'huge' cannot be decoded: use PNG or JPEG, 1 to 16384 pixels a side"));
  EXPECT_THAT(complaint(bytes(kHugeTga)), testing::AllOf(HasSubstr("65535 x 65535"), HasSubstr("16384")));
  EXPECT_THAT(complaint(bytes("P6 99999 99999 255\n")), HasSubstr("99999 x 99999"));
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
