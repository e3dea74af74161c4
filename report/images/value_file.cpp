#include "report/images/value_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>

#include "base/bytes.h"
#include "base/files.h"

namespace shadowbench::images {
namespace {

constexpr std::uint32_t kNoCode = 65535, kNoFloat = 0x7fc00000;
constexpr double kMostOff = 1.0 / 32768.0, kMostOffOfGreatest = 1.0 / 1024.0;  // else codes do not serve
constexpr int kValueCompression = 7;  // 9 makes them 4 % smaller, and takes three times as long

/// A plane as words of 16 bits, codes over a range, or of 32, floats.
struct Words {
  std::vector<std::uint32_t> words;
  std::size_t bytes = 2;
  double low = 0.0;
  double high = 1.0;
};

/// Covers a plane by [0,1] or [-1,1], or by as much more as it needs.
Words start_codes(const Image& plane) {
  Words codes;
  for (const float value : plane.texels) {
    if (!std::isfinite(value)) continue;
    codes.low = std::min(codes.low, value < 0.0f ? std::min(static_cast<double>(value), -1.0) : 0.0);
    codes.high = std::max(codes.high, static_cast<double>(value));
  }
  return codes;
}

Words encode_floats(const Image& plane) {
  Words floats{{}, sizeof(float), 0.0, 0.0};
  for (const float value : plane.texels)
    floats.words.push_back(std::isfinite(value) ? std::bit_cast<std::uint32_t>(value) : kNoFloat);
  return floats;
}

/// Takes codes where they are near enough, else floats.
Words encode(const Image& plane) {
  Words codes = start_codes(plane);
  const double step = (codes.high - codes.low) / kHighestCode;
  double greatest = 0.0, off = 0.0;
  for (const float value : plane.texels) {
    codes.words.push_back(kNoCode);
    if (!std::isfinite(value)) continue;
    const double exact = value, code = std::round((exact - codes.low) / step);
    codes.words.back() = static_cast<std::uint32_t>(code);
    greatest = std::max(greatest, std::abs(exact));
    off = std::max(off, std::abs(codes.low + step * code - exact));
  }
  return off <= std::min(kMostOff, kMostOffOfGreatest * greatest) ? codes : encode_floats(plane);
}

std::string pack_words(const Words& plane, int width) {
  const std::size_t count = plane.words.size();
  std::string bytes(plane.bytes * count, '\0');
  std::uint32_t left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % static_cast<std::size_t>(width) == 0) left = 0;
    const std::uint32_t step = plane.words[i] - left;
    for (std::size_t b = 0; b < plane.bytes; ++b)
      bytes[b * count + i] = static_cast<char>(step >> 8 * (plane.bytes - 1 - b) & 0xff);
    left = plane.words[i];
  }
  return bytes;
}

std::string pack(const std::string& bytes) { return pack_bytes(std::as_bytes(std::span(bytes))); }

}  // namespace

std::string encode_base64(std::string_view bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * (bytes.size() / 3 + 1));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t at) { return at < bytes.size() ? static_cast<std::uint8_t>(bytes[at]) : 0u; };
    const std::uint32_t three = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (const int shift : {18, 12, 6, 0}) text += kDigits[three >> shift & 63];
  }
  for (std::size_t rest = bytes.size() % 3; rest == 1 || rest == 2; ++rest) text[text.size() - (3 - rest)] = '=';
  return text;
}

std::string pack_bytes(std::span<const std::byte> bytes) {
  return encode_base64(compress_bytes(bytes, kValueCompression));
}

std::string pack_floats(const Image& plane) { return pack(pack_words(encode_floats(plane), plane.width)); }

void write_value_file(const std::filesystem::path& path, const std::string& name, const ValuePlanes& planes) {
  assert(!planes.empty());
  AtomicFile file(path);
  const auto quote = [](const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  };
  file.write(fmt::format("shadowbenchValues({}, {{\"width\":{},\"height\":{},\"planes\":[", quote(name),
                         planes.front().second.width, planes.front().second.height));
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const auto& [title, plane] = planes[i];
    assert(plane.channels == 1 && plane.texels.size() == planes.front().second.texels.size());
    const Words words = encode(plane);
    const std::string range =
        words.bytes == sizeof(float) ? "" : fmt::format("\"low\":{},\"high\":{},", words.low, words.high);
    file.write(fmt::format("{}\n{{\"name\":{},{}\"data\":\"{}\"}}", i > 0 ? "," : "", quote(title), range,
                           pack(pack_words(words, plane.width))));
  }
  file.write("]});\n");
  file.commit();
}

}  // namespace shadowbench::images
