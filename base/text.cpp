#include "base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "base/error.h"

namespace shadowbench {
namespace {

std::string to_lower(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, replace});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  }
  return cost[a.size()][b.size()];
}

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

std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known,
                                        std::size_t part) {
  constexpr std::size_t kLongestName = 256;
  if (name.size() > kLongestName) return std::nullopt;
  const std::string wanted = to_lower(name);
  std::optional<std::string> nearest;
  std::size_t nearest_distance = kLongestName;
  for (const std::string& candidate : known) {
    if (candidate.size() > kLongestName) continue;
    const std::size_t distance = edit_distance(wanted, to_lower(candidate));
    const std::size_t limit = std::max<std::size_t>(1, std::max(wanted.size(), candidate.size()) / part);
    if (distance > limit || distance >= nearest_distance) continue;
    nearest = candidate;
    nearest_distance = distance;
  }
  return nearest;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known, std::size_t part) {
  const std::optional<std::string> near = nearest_name(name, known, part);
  return near ? fmt::format("; did you mean '{}'?", *near) : "";
}

std::string did_you_mean_or_known(std::string_view name, const std::vector<std::string>& known) {
  const std::string hint = did_you_mean(name, known);
  return hint.empty() && !known.empty() ? fmt::format("; known: {}", fmt::join(known, ", ")) : hint;
}

std::vector<std::string> split_list(std::string_view list, std::string_view separator) {
  std::vector<std::string> parts;
  std::size_t end = 0;
  while ((end = list.find(separator)) != std::string_view::npos) {
    parts.emplace_back(list.substr(0, end));
    list.remove_prefix(end + separator.size());
  }
  parts.emplace_back(list);
  return parts;
}

std::vector<std::pair<std::string, std::string>> split_assignments(std::string_view list, std::string_view option) {
  std::vector<std::pair<std::string, std::string>> assignments;
  if (list.empty())
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: nothing follows the ':'; write KEY=VALUE there, or leave it out", option));
  for (const std::string& part : split_list(list)) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const std::string key = part.substr(0, equals);
    for (const auto& known : assignments)
      if (known.first == key) throw Error(ErrorKind::kUsage, fmt::format("{}: '{}' is given twice", option, key));
    assignments.emplace_back(key, part.substr(std::min(equals + 1, part.size())));
  }
  return assignments;
}

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

std::optional<double> parse_number(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

std::size_t find_name(std::string_view name, const std::vector<std::string>& known, std::string_view what) {
  const auto found = std::ranges::find(known, name);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  throw Error(ErrorKind::kUsage, fmt::format("unknown {} '{}'; known: {}", what, name, fmt::join(known, ", ")));
}

}  // namespace shadowbench
