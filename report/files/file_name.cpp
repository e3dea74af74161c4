#include "report/files/file_name.h"

#include <fmt/format.h>

#include <algorithm>

namespace shadowbench::files {
namespace {

constexpr std::size_t kMaxStem = 80;

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
}

}  // namespace

std::uint64_t hash_text(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3U;
  }
  return hash;
}

std::string make_file_stem(std::string_view name) {
  const bool starts_plainly = !name.empty() && name.front() != '.' && name.front() != '-';
  std::string stem(starts_plainly ? "" : "_");
  stem += name;
  std::replace_if(
      stem.begin(), stem.end(), [](char c) { return !is_plain(c); }, '_');
  if (stem == name && stem.size() <= kMaxStem) return stem;
  const std::string suffix = fmt::format("-{:016x}", hash_text(name));
  return stem.substr(0, kMaxStem - suffix.size()) + suffix;
}

std::string encode_url_path(std::string_view path) {
  std::string url;
  for (const char c : path)
    if (is_plain(c) || c == '/')
      url += c;
    else
      url += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  return url;
}

}  // namespace shadowbench::files
