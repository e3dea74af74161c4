#include "report/images/picture_io.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <functional>
#include <limits>

#include "base/error.h"
#include "base/files.h"
#include "report/images/stored_picture.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {

using namespace records;
namespace {

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

int code_at(const Image& image, int x, int channel) {
  return static_cast<int>(std::lround(image.at(x, 0)[channel] * 255.0f));
}

std::size_t count_files(const std::filesystem::path& dir) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(dir), {}));
}

TEST(PictureIo, Srgb_EqualsTheStandardsValues) {
  EXPECT_EQ(encode_srgb(-1.0f), 0.0f);
  EXPECT_NEAR(encode_srgb(0.002f), 0.02584f, 1e-6f);
  EXPECT_NEAR(encode_srgb(0.5f), 0.735357f, 1e-5f);
  EXPECT_FLOAT_EQ(encode_srgb(9.0f), 1.0f);
  EXPECT_TRUE(std::isnan(encode_srgb(std::numeric_limits<float>::quiet_NaN())));
}

TEST(PictureIo, DecodingSrgb_UndoesEncodingIt) {
  EXPECT_FLOAT_EQ(decode_srgb(0.04045f), 0.04045f / 12.92f);
  EXPECT_NEAR(decode_srgb(0.5f), 0.214041f, 1e-6f);
  for (int code = 0; code < 256; ++code) {
    const float value = static_cast<float>(code) / 255.0f;
    EXPECT_NEAR(encode_srgb(decode_srgb(value)), value, 1e-6f) << code;
  }
}

TEST(PictureIo, PicturePng_IsEncodedForADisplay) {
  const TestFolder folder;
  Image picture(2, 1, 3);
  picture.texels = {0.0f, 0.5f, 1.0f, -1.0f, 2.0f, 0.2158605f};
  write_picture_png(folder.path() / "a.png", picture);
  const Image back = read_picture(folder.path() / "a.png");
  ASSERT_EQ(back.channels, 3);
  EXPECT_EQ(code_at(back, 0, 0), 0);
  EXPECT_EQ(code_at(back, 0, 1), 188);
  EXPECT_EQ(code_at(back, 0, 2), 255);
  EXPECT_EQ(code_at(back, 1, 0), 0);
  EXPECT_EQ(code_at(back, 1, 1), 255);
  EXPECT_EQ(code_at(back, 1, 2), 128);
  EXPECT_EQ(count_files(folder.path()), 1u);
}

TEST(PictureIo, GreyPng_IsLinearInTheValue) {
  const TestFolder folder;
  Image image(4, 1, 1);
  image.texels = {0.0f, 0.5f, 1.0f, 2.0f};
  write_grey_png(folder.path() / "a.png", image);
  const Image back = read_picture(folder.path() / "a.png");
  ASSERT_EQ(back.channels, 1);
  EXPECT_EQ(code_at(back, 1, 0), 128);
  EXPECT_EQ(code_at(back, 3, 0), 255);
}

TEST(PictureIo, Png_KeepsEveryCode) {
  const TestFolder folder;
  for (const int channels : {1, 3}) {
    Image image(257, 129, channels);  // more than one block of deflate
    for (std::size_t i = 0; i < image.texels.size(); ++i)
      image.texels[i] = static_cast<float>(i * i / 7 % 256) / 255.0f;
    (channels == 1 ? write_grey_png : write_display_png)(folder.path() / "a.png", image);
    const StoredPicture back = read_stored_picture(folder.path() / "a.png");
    ASSERT_EQ(back.image.texels.size(), image.texels.size());
    for (std::size_t i = 0; i < image.texels.size(); ++i)
      ASSERT_FLOAT_EQ(back.image.texels[i], image.texels[i]) << channels << " " << i;
    EXPECT_EQ(back.image.width, image.width);
    const auto bytes = read_file_bytes(folder.path() / "a.png");
    EXPECT_THAT(std::string(bytes.begin(), bytes.end()), ::testing::HasSubstr("sRGB"));
  }
}

TEST(PictureIo, TexelThatIsNotFinite_IsMagenta) {
  const TestFolder folder;
  Image image(2, 1, 1);
  image.texels = {0.25f, std::numeric_limits<float>::quiet_NaN()};
  write_grey_png(folder.path() / "a.png", image);
  const Image grey = read_picture(folder.path() / "a.png");
  ASSERT_EQ(grey.channels, 3);
  EXPECT_EQ(code_at(grey, 0, 1), 64);
  EXPECT_EQ(code_at(grey, 1, 0), 255);
  EXPECT_EQ(code_at(grey, 1, 1), 0);
  EXPECT_EQ(code_at(grey, 1, 2), 255);
}

TEST(PictureIo, Exr_ComesBackBitForBit) {
  const TestFolder folder;
  Image special = make_noise(7, 5, 1);
  special.texels[3] = std::numeric_limits<float>::infinity();
  special.texels[4] = std::numeric_limits<float>::denorm_min();
  special.texels[5] = -0.0f;
  special.texels[6] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Part> parts = {{"gbuffer", {"X", "Y", "Z"}, make_noise(7, 5, 3)},
                                   {"vsm.visibility", {"visibility"}, special},
                                   {"attribution", {"numeric", "estimator", "bias"}, make_noise(7, 5, 3)},
                                   {"vsm.picture", {"R", "G", "B"}, make_noise(7, 5, 3)}};
  const Metadata metadata = {{"shadowbench:seed", 7.0},
                             {"shadowbench:command", std::string("shadowbench run --seed 7")}};
  write_exr(folder.path() / "a.exr", parts, metadata);
  const ExrFile back = read_exr(folder.path() / "a.exr");
  ASSERT_EQ(back.parts.size(), parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_EQ(back.parts[i].name, parts[i].name);
    EXPECT_EQ(back.parts[i].channel_names, parts[i].channel_names) << parts[i].name;
    EXPECT_TRUE(has_same_bits(back.parts[i].image, parts[i].image)) << parts[i].name;
    EXPECT_FALSE(back.parts[i].half);
  }
  EXPECT_EQ(back.metadata.at("shadowbench:seed"), metadata.at("shadowbench:seed"));
  EXPECT_EQ(back.metadata.at("shadowbench:command"), metadata.at("shadowbench:command"));
  EXPECT_EQ(count_files(folder.path()), 1u);
}

TEST(PictureIo, ExrParts_MayDifferInSize) {
  const TestFolder folder;
  const std::vector<Part> parts = {{"visibility", {"visibility"}, make_noise(8, 4, 1)},
                                   {"depth", {"Z"}, make_noise(32, 32, 1)}};
  write_exr(folder.path() / "a.exr", parts, {});
  const ExrFile back = read_exr(folder.path() / "a.exr");
  ASSERT_EQ(back.parts.size(), 2u);
  EXPECT_TRUE(has_same_bits(back.parts[1].image, parts[1].image));
  const ExrFile chosen = read_exr(folder.path() / "a.exr", [](const std::string& name) { return name == "depth"; });
  ASSERT_EQ(chosen.parts.size(), 1u);
  EXPECT_EQ(chosen.parts[0].name, "depth");
  EXPECT_TRUE(has_same_bits(chosen.parts[0].image, parts[1].image));
}

TEST(PictureIo, RoundingToHalf_GivesWhatAHalfPartKeeps) {
  const TestFolder folder;
  Image image = make_noise(31, 17, 3);
  image.texels[0] = 1e-7f;                  // below the smallest normal half
  image.texels[1] = 1e6f;                   // above the largest
  image.texels[2] = 1.0f + 1.0f / 2048.0f;  // halfway between two
  image.texels[3] = std::numeric_limits<float>::infinity();
  image.texels[4] = 0.1f;
  write_exr(folder.path() / "a.exr", {{"picture", {"R", "G", "B"}, image, true}}, {});
  EXPECT_TRUE(has_same_bits(round_to_half(image), read_exr(folder.path() / "a.exr").parts.at(0).image));
  EXPECT_EQ(round_to_half(image).texels[4], 0.0999755859375f);
}

TEST(PictureIo, PartsOfOneName_AreAnOutputError) {
  const TestFolder folder;
  const Part part{"a", {"Y"}, make_noise(2, 2, 1)};
  EXPECT_THAT(
      [&] {
        write_exr(folder.path() / "a.exr", {part, part}, {});
      },
      ::testing::ThrowsMessage<Error>(::testing::HasSubstr("two parts have one name")));
  EXPECT_THAT(
      [&] {
        write_exr(folder.path() / "a.exr", {{"a", {"Y", "Y"}, make_noise(2, 2, 2)}}, {});
      },
      ::testing::ThrowsMessage<Error>(::testing::HasSubstr("two channels of part 'a' have one name")));
  EXPECT_EQ(count_files(folder.path()), 0u);
}

TEST(PictureIo, DamagedFile_IsAnInputError) {
  const TestFolder folder;
  write_text_file(folder.path() / "a.exr", "not an image");
  for (const char* name : {"a.exr", "missing.exr"}) {
    try {
      read_exr(folder.path() / name);
      FAIL() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_THAT(error.what(), ::testing::HasSubstr(name));
    }
  }
}

// A limit on file sizes stands for a full disk, which the image libraries overlook.
TEST(PictureIo, FullDisk_IsAnOutputErrorAndLeavesNothing) {
  const TestFolder folder;
  const Image grey = make_noise(64, 64, 1), colour = make_noise(64, 64, 3);
  const std::vector<std::function<void()>> actions = {
      [&] { write_grey_png(folder.path() / "a.png", grey); },
      [&] { write_picture_png(folder.path() / "b.png", colour); },
      [&] {
        write_exr(folder.path() / "c.exr", {{"x", {"Y"}, grey, false}, {"y", {"R", "G", "B"}, colour, false}}, {});
      }};
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const rlim_t bytes : {rlim_t{0}, rlim_t{50}, rlim_t{150}}) {
    for (std::size_t i = 0; i < actions.size(); ++i) {
      const rlimit small{bytes, before.rlim_max};
      setrlimit(RLIMIT_FSIZE, &small);
      std::string message = "no error";
      try {
        actions[i]();
      } catch (const Error& error) {
        message = error.kind() == ErrorKind::kOutput ? error.what() : "another error";
      }
      setrlimit(RLIMIT_FSIZE, &before);
      EXPECT_THAT(message, ::testing::AllOf(::testing::HasSubstr(folder.path().string()),
                                            ::testing::HasSubstr("File too large"), ::testing::HasSubstr("--out")))
          << i << " " << bytes;
      EXPECT_EQ(count_files(folder.path()), 0u) << i << " " << bytes;
    }
  }
  std::signal(SIGXFSZ, handler);
}

}  // namespace
}  // namespace shadowbench::images
