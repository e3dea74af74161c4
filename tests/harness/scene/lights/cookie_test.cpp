// The picture that a spot shines through: how a scene file names it, and what is refused.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/scene/load.h"
#include "tests/harness/scene/test_files.h"

namespace shadowbench::scene {
namespace {

using testing::HasSubstr;

constexpr int kCookieLine = 6;

/// A lamp over a floor, with a cookie in line 6.
std::string cookie_scene(const std::string& value,
                         const std::string& light = "type = 'spot'\nposition = [0, 3, 0]\ntarget = [0, 0, 0]") {
  return fmt::format("title = 'Cookie'\n[light]\n{}\ncookie = {}\n[[object]]\nshape = 'plane'\nsize = [1, 1]\n", light,
                     value);
}

/// A picture of 32 bits a pixel, rows from the top.
std::string make_tga(std::uint16_t width, std::uint16_t height, const std::vector<std::uint8_t>& bgra) {
  return std::string("\0\0\2\0\0\0\0\0\0\0\0\0", 12) + bytes_of(std::vector{width, height}) + "\x20\x28" +
         bytes_of(bgra);
}

const std::string kRedAndBlue = make_tga(1, 2, {0, 0, 255, 255, 255, 0, 0, 128});

TEST(Cookie, IsReadBesideTheScene) {
  const TestFolder folder;
  folder.write("pictures/two.tga", kRedAndBlue);
  const Scene scene = load_scene(folder.write("a.toml", cookie_scene("'pictures/two.tga'")));
  const Texture* cookie = find_cookie(scene.light);
  ASSERT_TRUE(cookie);
  EXPECT_EQ(cookie->width, 1);
  EXPECT_EQ(cookie->height, 2);
  EXPECT_EQ(cookie->rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 0, 255, 128}));
  EXPECT_EQ(find_cookie(place_in_sky(scene.light, {10.0, 40.0})), cookie) << "the light keeps it when it is turned";
  EXPECT_TRUE(scene.textures.empty());
}

TEST(Cookie, IsAPartOfTheLightsContent_ByItsPixels) {
  const TestFolder folder;
  const auto content = [&](const char* name, const std::string& picture) {
    folder.write(name, picture);
    return list_light_content(load_scene(folder.write("a.toml", cookie_scene(fmt::format("'{}'", name)))).light);
  };
  const std::vector<std::string> two = content("two.tga", kRedAndBlue);
  EXPECT_EQ(content("copy.tga", kRedAndBlue), two);
  EXPECT_NE(content("two.tga", make_tga(2, 1, {0, 0, 255, 255, 255, 0, 0, 128})), two) << "the same pixels in a row";
  EXPECT_NE(content("two.tga", make_tga(1, 2, {0, 0, 254, 255, 255, 0, 0, 128})), two);
  Light bare = load_scene(folder.path() / "a.toml").light;
  std::get<Spot>(bare.kind).cookie = nullptr;
  EXPECT_EQ(list_light_content(bare), std::vector(two.begin(), two.end() - 1));
}

TEST(Cookie, ThatCannotBeRead_IsTheFaultOfTheLineThatNamesIt) {
  const TestFolder folder;
  const auto expect_complaint = [&](const std::string& value, const std::vector<std::string>& words) {
    const auto scene = folder.write("bad.toml", cookie_scene(value));
    const Error error = error_of([&] { load_scene(scene); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.where(), fmt::format("{}:{}", scene.string(), kCookieLine)) << error.what();
    for (const std::string& word : words) EXPECT_THAT(error.message(), HasSubstr(word));
    EXPECT_THAT(error.message(), testing::Not(HasSubstr("\n")));
  };
  const auto expect_bad_picture = [&](const std::string& bytes, const std::string& word) {
    folder.write("x.png", bytes);
    expect_complaint("'x.png'", {"'cookie' in [light]", (folder.path() / "x.png").string(), word});
  };
  expect_complaint("'none.png'", {"'cookie' in [light]", "there is no file", "none.png"});
  expect_complaint("'.'", {"'cookie' in [light]", "this is not a file"});
  expect_complaint("''", {"'cookie' in [light]", "this is not a file"});
  expect_complaint("7", {"'cookie' in [light] must be a string"});
  expect_bad_picture("", "no usable size: 0 bytes");
  expect_bad_picture("a text", "cannot be decoded: use PNG or JPEG");
  const std::string png("\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR", 16);
  expect_bad_picture(png + std::string("\0\0\0\2\0\0\0\5\x08\2\0\0\0", 13), "cannot be decoded");
  expect_bad_picture(png + std::string("\0\0\0\0\0\0\0\5\x08\2\0\0\0", 13), "has no pixels: 0 x 5");
  expect_bad_picture(png + std::string("\0\1\0\0\0\1\0\0\x08\2\0\0\0", 13), "65536 x 65536 pixels; at most 16384");
}

TEST(Cookie, OfASun_IsAnUnknownKey) {
  const TestFolder folder;
  folder.write("two.tga", kRedAndBlue);
  const auto scene = folder.write("sun.toml", cookie_scene("'two.tga'", "elevation_deg = 40\nazimuth_deg = 0"));
  EXPECT_THAT(error_of([&] { load_scene(scene); }).message(), HasSubstr("unknown key 'cookie' in [light]"));
}

}  // namespace
}  // namespace shadowbench::scene
