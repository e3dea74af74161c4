#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace shadowbench::files {

/// Hashes bytes.
/// Source: Fowler, Noll and Vo, FNV-1a, 64 bits.
std::uint64_t hash_text(std::string_view text);

/// Makes a file stem of any name, so that the file stays in the report folder.
/// Returns letters, digits, '-', '_' and '.' only, at most 80 characters, not starting with '.' or '-'; a name that had
/// to be changed gets its hash appended, so that two names never share a file.
std::string make_file_stem(std::string_view name);

/// Percent-encodes a relative path with '/' between folders for use as a URL.
std::string encode_url_path(std::string_view path);

}  // namespace shadowbench::files
