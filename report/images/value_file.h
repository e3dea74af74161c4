#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/images/image.h"

namespace shadowbench::images {

/// The code of the largest value of a plane; the next is that of a value that is not finite.
inline constexpr double kHighestCode = 65534.0;

/// Named planes of one size, 1 channel each.
using ValuePlanes = std::vector<std::pair<std::string, Image>>;

/// Writes planes as a script that a page opened from disk can load, which pictures' pixels cannot be read by: it calls
/// `shadowbenchValues(name, {width, height, planes: [{name, low, high, data}]})`. `data` is base64 of a zlib stream of
/// 16-bit codes, first all high bytes, then all low ones; each code is stored less the one to its left, modulo 65 536.
/// A value is low + (high - low) * code / 65534; 65535 is a value that is not finite. Planes within [0,1] have that
/// range, so that a value is off by 1/131068 at most. A plane of which codes would be off by more than 1/32768, or than
/// 1/1024 of its greatest magnitude, has neither low nor high: its words are the 32 bits of floats, in the same order,
/// and NaN is a value that is not finite. Requires planes of one size.
/// Throws Error(kOutput).
void write_value_file(const std::filesystem::path& path, const std::string& name, const ValuePlanes& planes);

/// Source: RFC 4648, section 4.
std::string encode_base64(std::string_view bytes);

/// Packs bytes for a script: base64 of a zlib stream.
std::string pack_bytes(std::span<const std::byte> bytes);

/// Packs a plane exactly, as write_value_file() does one that codes do not serve.
std::string pack_floats(const Image& plane);

}  // namespace shadowbench::images
