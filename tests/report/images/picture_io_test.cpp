#include "report/images/picture_io.h"

#include <OpenImageIO/deepdata.h>
#include <OpenImageIO/imageio.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/bytes.h"
#include "report/images/value_file.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {
namespace {

using namespace records;
using PictureIo = FolderTest;

Image make_noise(int width, int height, int channels) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.texels.size(); ++i)
    image.texels[i] = std::sin(static_cast<float>(i) * 12.9898f) * 43758.547f;
  return image;
}

bool has_same_bits(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels &&
         std::memcmp(a.texels.data(), b.texels.data(), a.texels.size() * sizeof(float)) == 0;
}

/// The values as codes of 8 bits.
std::vector<long> list_codes(const Image& image) {
  return list_each(
      image.texels, [](float value) { return std::lround(value * 255.0f); });
}

TEST_F(PictureIo, Srgb_EqualsTheStandardsValues) {
  EXPECT_EQ(encode_srgb(-1.0f), 0.0f);
  EXPECT_NEAR(encode_srgb(0.002f), 0.02584f, 1e-6f);
  EXPECT_NEAR(encode_srgb(0.5f), 0.735357f, 1e-5f);
  EXPECT_FLOAT_EQ(encode_srgb(9.0f), 1.0f);
  EXPECT_TRUE(std::isnan(encode_srgb(std::numeric_limits<float>::quiet_NaN())));
}

TEST_F(PictureIo, DecodingSrgb_UndoesEncodingIt) {
  EXPECT_FLOAT_EQ(decode_srgb(0.04045f), 0.04045f / 12.92f);
  EXPECT_NEAR(decode_srgb(0.5f), 0.214041f, 1e-6f);
  for (int code = 0; code < 256; ++code) {
    const float value = static_cast<float>(code) / 255.0f;
    EXPECT_NEAR(encode_srgb(decode_srgb(value)), value, 1e-6f) << code;
  }
}

TEST_F(PictureIo, PicturePng_IsEncodedForADisplay) {
  Image picture(2, 1, 3);
  picture.texels = {0.0f, 0.5f, 1.0f, -1.0f, 2.0f, 0.2158605f};
  write_picture_png(folder_.path() / "a.png", picture);
  const Image back = read_picture(folder_.path() / "a.png");
  ASSERT_EQ(back.channels, 3);
  EXPECT_THAT(list_codes(back), ElementsAre(0, 188, 255, 0, 255, 128));
  EXPECT_EQ(count_files(folder_.path()), 1u);
}

TEST_F(PictureIo, GreyPng_IsLinearInTheValue) {
  Image image(4, 1, 1);
  image.texels = {0.0f, 0.5f, 1.0f, 2.0f};
  write_grey_png(folder_.path() / "a.png", image);
  const Image back = read_picture(folder_.path() / "a.png");
  ASSERT_EQ(back.channels, 1);
  EXPECT_THAT(list_codes(back), ElementsAre(0, 128, 255, 255));
}

TEST_F(PictureIo, Png_KeepsEveryCode) {
  for (const int channels : {1, 3}) {
    Image image(257, 129, channels);  // more than one block of deflate
    for (std::size_t i = 0; i < image.texels.size(); ++i)
      image.texels[i] = static_cast<float>(i * i / 7 % 256) / 255.0f;
    (channels == 1 ? write_grey_png : write_display_png)(folder_.path() / "a.png", image);
    const StoredPicture back = read_stored_picture(folder_.path() / "a.png");
    ASSERT_EQ(back.image.texels.size(), image.texels.size());
    for (std::size_t i = 0; i < image.texels.size(); ++i)
      ASSERT_FLOAT_EQ(back.image.texels[i], image.texels[i]) << channels << " " << i;
    EXPECT_EQ(back.image.width, image.width);
    const auto bytes = read_file_bytes(folder_.path() / "a.png");
    EXPECT_THAT(std::string(bytes.begin(), bytes.end()), HasSubstr("sRGB"));
  }
}

TEST_F(PictureIo, TexelThatIsNotFinite_IsMagenta) {
  Image image(2, 1, 1);
  image.texels = {0.25f, std::numeric_limits<float>::quiet_NaN()};
  write_grey_png(folder_.path() / "a.png", image);
  const Image grey = read_picture(folder_.path() / "a.png");
  ASSERT_EQ(grey.channels, 3);
  EXPECT_THAT(list_codes(grey), ElementsAre(64, 64, 64, 255, 0, 255));
}

TEST_F(PictureIo, Exr_ComesBackBitForBit) {
  Image special = make_noise(7, 5, 1);
  special.texels[3] = std::numeric_limits<float>::infinity();
  special.texels[4] = std::numeric_limits<float>::denorm_min();
  special.texels[5] = -0.0f;
  special.texels[6] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Part> parts = {{"gbuffer", {"X", "Y", "Z"}, make_noise(7, 5, 3)},
                                   {"vsm.visibility", {"visibility"}, special},
                                   {"vsm.picture", {"R", "G", "B"}, make_noise(7, 5, 3)}};
  const Metadata metadata = {{"shadowbench:seed", 7.0},
                             {"shadowbench:command", std::string("shadowbench run --seed 7")}};
  write_exr(folder_.path() / "a.exr", parts, metadata);
  const ExrFile back = read_exr(folder_.path() / "a.exr");
  ASSERT_EQ(back.parts.size(), parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_EQ(back.parts[i].name, parts[i].name);
    EXPECT_EQ(back.parts[i].channel_names, parts[i].channel_names) << parts[i].name;
    EXPECT_TRUE(has_same_bits(back.parts[i].image, parts[i].image)) << parts[i].name;
    EXPECT_FALSE(back.parts[i].half);
  }
  EXPECT_EQ(back.metadata.at("shadowbench:seed"), metadata.at("shadowbench:seed"));
  EXPECT_EQ(back.metadata.at("shadowbench:command"), metadata.at("shadowbench:command"));
  EXPECT_EQ(count_files(folder_.path()), 1u);
}

TEST_F(PictureIo, ExrParts_MayDifferInSize) {
  const std::vector<Part> parts = {{"visibility", {"visibility"}, make_noise(8, 4, 1)},
                                   {"depth", {"Z"}, make_noise(32, 32, 1)}};
  write_exr(folder_.path() / "a.exr", parts, {});
  const ExrFile back = read_exr(folder_.path() / "a.exr");
  ASSERT_EQ(back.parts.size(), 2u);
  EXPECT_TRUE(has_same_bits(back.parts[1].image, parts[1].image));
  const ExrFile chosen = read_exr(folder_.path() / "a.exr", [](const std::string& name) { return name == "depth"; });
  ASSERT_EQ(chosen.parts.size(), 1u);
  EXPECT_EQ(chosen.parts[0].name, "depth");
  EXPECT_TRUE(has_same_bits(chosen.parts[0].image, parts[1].image));
}

TEST_F(PictureIo, RoundingToHalf_GivesWhatAHalfPartKeeps) {
  Image image = make_noise(31, 17, 3);
  image.texels[0] = 1e-7f;                  // below the smallest normal half
  image.texels[1] = 1e6f;                   // above the largest
  image.texels[2] = 1.0f + 1.0f / 2048.0f;  // halfway between two
  image.texels[3] = std::numeric_limits<float>::infinity();
  image.texels[4] = 0.1f;
  write_exr(folder_.path() / "a.exr", {{"picture", {"R", "G", "B"}, image, true}}, {});
  EXPECT_TRUE(has_same_bits(round_to_half(image), read_exr(folder_.path() / "a.exr").parts.at(0).image));
  EXPECT_EQ(round_to_half(image).texels[4], 0.0999755859375f);
}

TEST_F(PictureIo, PartsOfOneName_AreAnOutputError) {
  const Part part{"a", {"Y"}, make_noise(2, 2, 1)};
  const auto message_of = [&](const std::vector<Part>& parts) {
    return error_of([&] { write_exr(folder_.path() / "a.exr", parts, {}); }).message();
  };
  EXPECT_THAT(message_of({part, part}), HasSubstr("two parts have one name"));
  EXPECT_EQ(count_files(folder_.path()), 0u);
}

TEST_F(PictureIo, DamagedFile_IsAnInputError) {
  write_text_file(folder_.path() / "a.exr", "not an image");
  for (const char* name : {"a.exr", "missing.exr"})
    EXPECT_THAT(error_of([&] { read_exr(folder_.path() / name); }), is_error(ErrorKind::kInput, name));
}

// The image libraries overlook a full disk.
TEST_F(PictureIo, FullDisk_IsAnOutputErrorAndLeavesNothing) {
  const Image grey = make_noise(64, 64, 1), colour = make_noise(64, 64, 3);
  const std::vector<std::function<void()>> actions = {
      [&] { write_grey_png(folder_.path() / "a.png", grey); },
      [&] { write_picture_png(folder_.path() / "b.png", colour); },
      [&] {
        write_exr(folder_.path() / "c.exr", {{"x", {"Y"}, grey, false}, {"y", {"R", "G", "B"}, colour, false}}, {});
      }};
  for (const rlim_t bytes : {rlim_t{0}, rlim_t{50}, rlim_t{150}}) {
    for (std::size_t i = 0; i < actions.size(); ++i) {
      const Error error = with_file_limit(bytes, [&] { return error_of(actions[i]); });
      EXPECT_EQ(error.kind(), ErrorKind::kOutput);
      EXPECT_THAT(error.what(),
                  AllOf(HasSubstr(folder_.path().string()), HasSubstr("File too large"), HasSubstr("--out")))
          << i << " " << bytes;
      EXPECT_EQ(count_files(folder_.path()), 0u) << i << " " << bytes;
    }
  }
}

Image make_grey(float value) { return fill(Image(2, 1, 1), value); }

/// A folder with the file "a.exr" of two parts.
class StoredPictureTest : public FolderTest {
 protected:
  void SetUp() override {
    write_exr(folder_.path() / "a.exr",
              {{"none.visibility", {"Y"}, make_grey(0.25f), false}, {"truth.area", {"Y"}, make_grey(0.5f), false}}, {});
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  StoredPicture read(const std::string& name) const { return read_stored_picture(path(name)); }

  void expect_refusal(const std::string& name, const std::vector<std::string>& words) const {
    const Error error = error_of([&] { read(name); });
    EXPECT_EQ(error.kind(), ErrorKind::kInput) << name;
    for (const std::string& word : words) EXPECT_THAT(error.what(), HasSubstr(word));
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
  }

  void write(const std::string& name, const OIIO::ImageSpec& spec, const void* values) const {
    const auto output = OIIO::ImageOutput::create(path(name));
    ASSERT_TRUE(output->open(path(name), spec) && output->write_image(spec.format, values) && output->close());
  }

  /// Writes a 1 x 1 RGBA picture of 8 bits.
  void write_rgba(const std::string& name, const std::array<std::uint8_t, 4>& codes) const {
    OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    write(name, spec, codes.data());
  }
};

TEST_F(StoredPictureTest, PartOfAFile_IsReadByItsName_FileAloneIsItsFirst) {
  EXPECT_THAT(read("a.exr#truth.area").image.texels, ElementsAre(0.5f, 0.5f));
  EXPECT_THAT(read("a.exr#none.visibility").image.texels, ElementsAre(0.25f, 0.25f));
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
  OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeDesc::FLOAT);
  spec.attribute("Exif:ColorSpace", 1);
  write("float.tif", spec, color.texels.data());
  EXPECT_FALSE(read("float.tif").srgb);
  write_rgba("c.tif", {1, 2, 3, 4});
  EXPECT_FALSE(read("c.tif").srgb) << "a TIFF does not say so";
}

TEST_F(StoredPictureTest, DataWindow_SaysWhereItBegins) {
  OIIO::ImageSpec spec(2, 1, 1, OIIO::TypeDesc::FLOAT);
  spec.x = 3;
  spec.y = 4;
  write("w.exr", spec, make_grey(1.0f).texels.data());
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

/// Decodes base64 as the text of RFC 4648 says, apart from the encoder.
std::vector<unsigned char> decode_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    if ((count += 6) >= 8) bytes.push_back(static_cast<unsigned char>(bits >> (count -= 8)));
  }
  return bytes;
}

std::vector<double> decode(const nlohmann::json& file, const nlohmann::json& plane) {
  const std::size_t width = file["width"], count = width * file["height"].get<std::size_t>();
  const bool floats = !plane.contains("low");
  const auto packed = decode_base64(plane["data"]);
  std::vector<unsigned char> bytes((floats ? 4 : 2) * count);
  EXPECT_TRUE(decompress_bytes(std::as_bytes(std::span(packed)), std::as_writable_bytes(std::span(bytes))));
  std::vector<double> values;
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t step = 0;
    for (std::size_t at = i; at < bytes.size(); at += count) step = step << 8 | bytes[at];
    word = (i % width == 0 ? 0 : word) + step;
    if (!floats) word &= 65535;
    if (floats)
      values.push_back(static_cast<double>(std::bit_cast<float>(word)));
    else
      values.push_back(word == 65535 ? std::nan("")
                                     : plane["low"].get<double>() +
                                           (plane["high"].get<double>() - plane["low"].get<double>()) * word / 65534.0);
  }
  return values;
}

nlohmann::json write_and_parse(const ValuePlanes& planes) {
  const TestFolder folder;
  write_value_file(folder.path() / "a.js", "a \"b\".js", planes);
  const std::string text = folder.read("a.js"), start = "shadowbenchValues(\"a \\\"b\\\".js\", ", end = ");\n";
  EXPECT_THAT(text, AllOf(StartsWith(start), EndsWith(end)));
  return nlohmann::json::parse(text.substr(start.size(), text.size() - start.size() - end.size()));
}

TEST(ValueFile, ComesBackWithinHalfAStep) {
  Image visibility(5, 3, 1), error(5, 3, 1);
  for (std::size_t i = 0; i < 15; ++i) {
    visibility.texels[i] = static_cast<float>(i * i % 15) / 14.0f;
    error.texels[i] = -1.5f + 0.2f * static_cast<float>(i);
  }
  visibility.texels[7] = std::numeric_limits<float>::quiet_NaN();
  error.texels[8] = std::numeric_limits<float>::infinity();
  const auto file = write_and_parse({{"visibility", visibility}, {"error", error}});
  EXPECT_EQ(file["planes"][0]["low"], 0.0);
  EXPECT_EQ(file["planes"][0]["high"], 1.0);
  EXPECT_EQ(file["planes"][1]["name"], "error");
  const Image* const planes[] = {&visibility, &error};
  for (std::size_t p = 0; p < 2; ++p) {
    const auto values = decode(file, file["planes"][p]);
    const double step = (file["planes"][p]["high"].get<double>() - file["planes"][p]["low"].get<double>()) / 65534.0;
    for (std::size_t i = 0; i < 15; ++i)
      if (std::isfinite(planes[p]->texels[i]))
        EXPECT_NEAR(values[i], planes[p]->texels[i], 0.5001 * step) << p << " " << i;
      else
        EXPECT_TRUE(std::isnan(values[i])) << p << " " << i;
  }
}

TEST(ValueFile, EveryLengthOfBase64_IsWhole) {
  for (int width = 1; width < 12; ++width) {
    Image plane(width, 1, 1);
    for (int x = 0; x < width; ++x) plane.at(x, 0)[0] = static_cast<float>((37 * x) % 11) / 10.0f;
    const auto file = write_and_parse({{"p", plane}});
    EXPECT_EQ(file["planes"][0]["data"].get<std::string>().size() % 4, 0u);
    EXPECT_THAT(decode(file, file["planes"][0]), SizeIs(width));
  }
}

TEST(ValueFile, LargeAndTinyValues_ComeBackExactly) {
  for (const float greatest : {1000.0f, -1000.0f, 1e-5f, 1e-30f}) {
    Image plane(50, 3, 1);
    for (std::size_t i = 0; i < 150; ++i)
      plane.texels[i] = greatest * std::pow(0.9f, static_cast<float>(i)) * (i % 7 == 0 ? -1.0f : 1.0f);
    plane.texels[70] = std::numeric_limits<float>::infinity();
    const auto file = write_and_parse({{"p", plane}});
    const auto values = decode(file, file["planes"][0]);
    EXPECT_FALSE(file["planes"][0].contains("low"));
    for (std::size_t i = 0; i < 150; ++i)
      if (i == 70)
        EXPECT_TRUE(std::isnan(values[i]));
      else
        EXPECT_EQ(values[i], static_cast<double>(plane.texels[i])) << greatest << " " << i;
  }
}

TEST(ValueFile, FewStepsAndNothing_TakeCodes) {
  Image plane(50, 3, 1);
  EXPECT_EQ(write_and_parse({{"p", plane}})["planes"][0]["high"], 1.0);
  for (std::size_t i = 0; i < 150; ++i) plane.texels[i] = static_cast<float>(i % 5) / 32767.0f - 2.0f / 32767.0f;
  EXPECT_EQ(write_and_parse({{"p", plane}})["planes"][0]["low"], -1.0);
}

}  // namespace
}  // namespace shadowbench::images
