#include "report/images/value_file.h"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "tests/report/records/synthetic.h"

namespace shadowbench::images {
namespace {

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

nlohmann::json write_and_parse(const Image& plane) {
  const TestFolder folder;
  write_value_file(folder.path() / "a.js", "a", {{"p", plane}});
  const std::string text = read_text(folder.path() / "a.js");
  return nlohmann::json::parse(text.substr(23, text.size() - 26));
}

TEST(ValueFile, ComesBackWithinHalfAStep) {
  const TestFolder folder;
  Image visibility(5, 3, 1), error(5, 3, 1);
  for (std::size_t i = 0; i < 15; ++i) {
    visibility.texels[i] = static_cast<float>(i * i % 15) / 14.0f;
    error.texels[i] = -1.5f + 0.2f * static_cast<float>(i);
  }
  visibility.texels[7] = std::numeric_limits<float>::quiet_NaN();
  error.texels[8] = std::numeric_limits<float>::infinity();
  write_value_file(folder.path() / "a.js", "a \"b\".js", {{"visibility", visibility}, {"error", error}});
  const std::string text = read_text(folder.path() / "a.js");
  const std::string start = "shadowbenchValues(\"a \\\"b\\\".js\", ";
  ASSERT_EQ(text.substr(0, start.size()), start);
  ASSERT_EQ(text.substr(text.size() - 3), ");\n");
  const auto file = nlohmann::json::parse(text.substr(start.size(), text.size() - start.size() - 3));
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
    const auto file = write_and_parse(plane);
    EXPECT_EQ(file["planes"][0]["data"].get<std::string>().size() % 4, 0u);
    EXPECT_THAT(decode(file, file["planes"][0]), ::testing::SizeIs(width));
  }
}

TEST(ValueFile, LargeAndTinyValues_ComeBackExactly) {
  for (const float greatest : {1000.0f, -1000.0f, 1e-5f, 1e-30f}) {
    Image plane(50, 3, 1);
    for (std::size_t i = 0; i < 150; ++i)
      plane.texels[i] = greatest * std::pow(0.9f, static_cast<float>(i)) * (i % 7 == 0 ? -1.0f : 1.0f);
    plane.texels[70] = std::numeric_limits<float>::infinity();
    const auto file = write_and_parse(plane);
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
  EXPECT_EQ(write_and_parse(plane)["planes"][0]["high"], 1.0);
  for (std::size_t i = 0; i < 150; ++i) plane.texels[i] = static_cast<float>(i % 5) / 32767.0f - 2.0f / 32767.0f;
  EXPECT_EQ(write_and_parse(plane)["planes"][0]["low"], -1.0);
}

}  // namespace
}  // namespace shadowbench::images
