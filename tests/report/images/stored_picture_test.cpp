#include "report/images/stored_picture.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>

#include <array>

#include "base/error.h"
#include "base/files.h"
#include "report/images/picture_io.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {

using namespace records;
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Image make_grey(float value) {
  Image image(2, 1, 1);
  image.texels = {value, value};
  return image;
}

/// A folder with the file "a.exr" of two parts.
class StoredPictureTest : public ::testing::Test {
 protected:
  TestFolder folder_;

  void SetUp() override {
    write_exr(folder_.path() / "a.exr",
              {{"none.visibility", {"Y"}, make_grey(0.25f), false}, {"truth.area", {"Y"}, make_grey(0.5f), false}}, {});
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  StoredPicture read(const std::string& name) const { return read_stored_picture(path(name)); }

  void expect_refusal(const std::string& name, const std::vector<std::string>& words) const {
    try {
      read(name);
      FAIL() << name << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      for (const std::string& word : words) EXPECT_THAT(error.what(), HasSubstr(word));
      EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("\n")));
    }
  }

  /// Writes a 1 x 1 RGBA picture of 8 bits.
  void write_rgba(const std::string& name, const std::array<std::uint8_t, 4>& codes) const {
    const auto output = OIIO::ImageOutput::create(path(name));
    OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    ASSERT_TRUE(output->open(path(name), spec) && output->write_image(OIIO::TypeDesc::UINT8, codes.data()) &&
                output->close());
  }
};

TEST_F(StoredPictureTest, PartOfAFile_IsReadByItsName) {
  EXPECT_THAT(read("a.exr#truth.area").image.texels, ElementsAre(0.5f, 0.5f));
  EXPECT_THAT(read("a.exr#none.visibility").image.texels, ElementsAre(0.25f, 0.25f));
}

TEST_F(StoredPictureTest, FileAlone_IsItsFirstPart) {
  EXPECT_THAT(read("a.exr").image.texels, ElementsAre(0.25f, 0.25f));
}

TEST_F(StoredPictureTest, FileOfTheWholeName_ComesFirst) {
  std::filesystem::copy(path("a.exr"), path("a.exr#truth.area"));
  EXPECT_THAT(read("a.exr#truth.area").image.texels, ElementsAre(0.25f, 0.25f));
  EXPECT_THAT(read("a.exr#truth.area#truth.area").image.texels, ElementsAre(0.5f, 0.5f));
}

TEST_F(StoredPictureTest, UnnamedPart_GoesByItsNumber) {
  write_grey_png(path("g.png"), make_grey(1.0f));
  EXPECT_THAT(read("g.png#0").image.texels, ElementsAre(1.0f, 1.0f));
  expect_refusal("g.png#1", {"'1'", "parts: 0"});
}

TEST_F(StoredPictureTest, UnknownPart_ListsTheOthers) {
  expect_refusal("a.exr#truth.areal",
                 {"a.exr: ", "'truth.areal'", "did you mean 'truth.area'", "parts: none.visibility, truth.area"});
  expect_refusal("a.exr#", {"''", "parts: none.visibility, truth.area"});
}

TEST_F(StoredPictureTest, Alpha_IsFoundAndColorsAreNotMultipliedByIt) {
  for (const char* name : {"a.png", "a.tif", "a.tga"}) {
    write_rgba(name, {200, 100, 50, 128});
    const StoredPicture picture = read(name);
    EXPECT_EQ(picture.alpha_channel, 3) << name;
    EXPECT_FLOAT_EQ(picture.image.texels[0], 200.0f / 255.0f) << name;
    EXPECT_FLOAT_EQ(picture.image.texels[3], 128.0f / 255.0f) << name;
  }
  EXPECT_EQ(read("a.exr").alpha_channel, -1);
}

TEST_F(StoredPictureTest, AlphaOfAGif_IsNotTheFifthOfFourChannels) {
  write_rgba("a.gif", {200, 100, 50, 255});
  const StoredPicture picture = read("a.gif");
  EXPECT_EQ(picture.image.channels, 4);
  EXPECT_EQ(picture.alpha_channel, 3);
}

TEST_F(StoredPictureTest, OnlyIntegerCodes_AreSrgb) {
  Image color(1, 1, 3);
  write_picture_png(path("c.png"), color);
  EXPECT_TRUE(read("c.png").srgb);
  EXPECT_FALSE(read("a.exr").srgb);
  const auto output = OIIO::ImageOutput::create(path("float.tif"));
  OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeDesc::FLOAT);
  spec.attribute("Exif:ColorSpace", 1);
  ASSERT_TRUE(output->open(path("float.tif"), spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, color.texels.data()) && output->close());
  EXPECT_FALSE(read("float.tif").srgb);
  write_rgba("c.tif", {1, 2, 3, 4});
  EXPECT_FALSE(read("c.tif").srgb) << "a TIFF does not say so";
}

TEST_F(StoredPictureTest, DataWindow_SaysWhereItBegins) {
  const auto output = OIIO::ImageOutput::create(path("w.exr"));
  OIIO::ImageSpec spec(2, 1, 1, OIIO::TypeDesc::FLOAT);
  spec.x = 3;
  spec.y = 4;
  ASSERT_TRUE(output->open(path("w.exr"), spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, make_grey(1.0f).texels.data()) && output->close());
  EXPECT_EQ(read("w.exr").origin_x, 3);
  EXPECT_EQ(read("w.exr").origin_y, 4);
}

TEST_F(StoredPictureTest, FilesThatAreNoPictures_AreRefused) {
  expect_refusal("missing.png", {"missing.png: ", "no such file"});
  expect_refusal("missing.exr#truth.area", {"missing.exr: ", "no such file"});
  expect_refusal("", {"folder"});
  write_text_file(path("text.png"), "hello");
  expect_refusal("text.png", {"text.png: ", "cannot be read"});
  write_text_file(path("text.abc"), "hello");
  expect_refusal("text.abc", {"text.abc: ", "cannot be read"});
}

TEST_F(StoredPictureTest, FileCutOff_IsDamaged) {
  write_exr(path("long.exr"), {{"a", {"Y"}, make_visibility(64, 64, 8.0f), false}}, {});
  std::filesystem::resize_file(path("long.exr"), std::filesystem::file_size(path("long.exr")) / 2);
  expect_refusal("long.exr", {"long.exr: ", "damaged"});
}

/// A GIF of 800 bytes: 65535 x 65535 pixels, a palette, and one pixel.
TEST_F(StoredPictureTest, PictureLargerThanMemory_IsRefused) {
  std::string gif = "GIF89a\xff\xff\xff\xff\xf7";
  gif.append(2 + 768, '\0');
  gif.append("\x2c\0\0\0\0\1\0\1\0\0\x02\x02\x44\x01\0\x3b", 16);
  write_text_file(path("bomb.gif"), gif);
  expect_refusal("bomb.gif", {"bomb.gif: ", "larger than memory"});
}

TEST_F(StoredPictureTest, DeepPicture_IsRefused) {
  const auto output = OIIO::ImageOutput::create(path("layers.exr"));
  OIIO::ImageSpec spec(2, 1, 1, OIIO::TypeDesc::FLOAT);
  spec.deep = true;
  ASSERT_TRUE(output->open(path("layers.exr"), spec));
  OIIO::DeepData data(spec);
  ASSERT_TRUE(output->write_deep_image(data) && output->close());
  expect_refusal("layers.exr", {"layers.exr: ", "flatten"});
}

}  // namespace
}  // namespace shadowbench::images
