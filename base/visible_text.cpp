#include "base/visible_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace shadowbench {
namespace {

constexpr std::size_t kLongestLine = 2000;
constexpr std::size_t kLongestMessage = 40000;

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Leaves out the middle, between characters.
std::string shorten(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  std::size_t begin = most / 2, end = text.size() - most / 2;
  while (begin > 0 && continues_character(text[begin])) --begin;
  while (end < text.size() && continues_character(text[end])) ++end;
  return fmt::format("{} [... {} bytes ...] {}", text.substr(0, begin), end - begin, text.substr(end));
}

}  // namespace

std::string make_visible(std::string_view text) {
  std::string visible;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto code = static_cast<unsigned char>(text[i]);
    const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : '\0');
    if (code == 0xc2 && next >= 0x80 && next < 0xa0)  // a control character of 8 bits, as UTF-8
      visible += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[++i]));
    else if ((code < 0x20 && code != '\n') || code == 0x7f)
      visible += fmt::format("\\x{:02x}", code);
    else
      visible += text[i];
  }
  return visible;
}

std::string make_readable(std::string_view message) {
  std::string lines;
  for (std::size_t begin = 0; begin <= message.size();) {
    const std::size_t end = std::min(message.find('\n', begin), message.size());
    lines += (begin > 0 ? "\n" : "") + shorten(make_visible(message.substr(begin, end - begin)), kLongestLine);
    begin = end + 1;
  }
  return shorten(lines, kLongestMessage);
}

}  // namespace shadowbench
