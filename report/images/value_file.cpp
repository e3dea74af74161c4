#include "report/images/value_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <new>
#include <nlohmann/json.hpp>

#include "filters/base/atomic_file.h"
#include "filters/base/error.h"

namespace shadowbench::images {
namespace {

constexpr double kHighestCode = 65534.0;
constexpr std::uint16_t kNoCode = 65535;
constexpr int kCompression = 6;

struct Range {
  double low = 0.0;
  double high = 1.0;
};

Range find_range(const Image& plane) {
  Range range;
  for (const float value : plane.texels) {
    if (!std::isfinite(value)) continue;
    range.low = std::min(range.low, static_cast<double>(value));
    range.high = std::max(range.high, static_cast<double>(value));
  }
  return range;
}

std::uint16_t encode(float value, const Range& range) {
  if (!std::isfinite(value)) return kNoCode;
  return static_cast<std::uint16_t>(
      std::lround(kHighestCode * (static_cast<double>(value) - range.low) / (range.high - range.low)));
}

std::vector<unsigned char> pack_codes(const Image& plane, const Range& range) {
  const std::size_t count = plane.texels.size();
  std::vector<unsigned char> bytes(2 * count);
  std::uint16_t left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % static_cast<std::size_t>(plane.width) == 0) left = 0;
    const std::uint16_t code = encode(plane.texels[i], range);
    const auto step = static_cast<std::uint16_t>(code - left);
    bytes[i] = static_cast<unsigned char>(step >> 8);
    bytes[count + i] = static_cast<unsigned char>(step & 0xff);
    left = code;
  }
  return bytes;
}

std::vector<unsigned char> compress_bytes(const std::vector<unsigned char>& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<unsigned char> packed(size);
  // With room for the bound, zlib fails for want of memory alone.
  if (compress2(packed.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), kCompression) != Z_OK)
    throw std::bad_alloc();
  packed.resize(size);
  return packed;
}

/// Source: RFC 4648, section 4.
std::string encode_base64(const std::vector<unsigned char>& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * (bytes.size() / 3 + 1));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t at) { return at < bytes.size() ? std::uint32_t{bytes[at]} : 0u; };
    const std::uint32_t three = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (const int shift : {18, 12, 6, 0}) text += kDigits[three >> shift & 63];
  }
  for (std::size_t rest = bytes.size() % 3; rest == 1 || rest == 2; ++rest) text[text.size() - (3 - rest)] = '=';
  return text;
}

}  // namespace

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
    const Range range = find_range(plane);
    file.write(fmt::format("{}\n{{\"name\":{},\"low\":{},\"high\":{},\"data\":\"{}\"}}", i > 0 ? "," : "", quote(title),
                           range.low, range.high, encode_base64(compress_bytes(pack_codes(plane, range)))));
  }
  file.write("]});\n");
  file.commit();
}

}  // namespace shadowbench::images
