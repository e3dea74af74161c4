#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shadowbench {

/// Finds the known name that `name` was most likely meant to be, ignoring case.
/// Returns nothing where even the closest one differs in more than one of `part` letters: in half of them where few
/// names are known. Among many names one is near by chance, and `part` should be larger.
/// Source: optimal string alignment distance (insert, delete, replace, swap neighbours; each costs 1).
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known,
                                        std::size_t part = 2);

/// The end of a message about an unknown name: "; did you mean 'x'?", empty where no known name is near.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known, std::size_t part = 2);

/// The same, but where no known name is near it lists them all: "; known: x, y".
std::string did_you_mean_or_known(std::string_view name, const std::vector<std::string>& known);

/// Splits a list at its separators. An empty text is a list of one empty part.
std::vector<std::string> split_list(std::string_view list, std::string_view separator = ",");

/// Splits "key=value,key=value", which follow a colon; a part without "=" has an empty value. Throws Error(kUsage), in
/// the name of `option`, for an empty text and where a key is given twice.
std::vector<std::pair<std::string, std::string>> split_assignments(std::string_view list, std::string_view option);

/// Shows control characters of names and files as "\x1b", because they would steer the terminal. Newlines stay, for
/// the logs of shaders and for tables.
std::string make_visible(std::string_view text);

/// The same of a message, in which nothing is so long that the rest is lost from sight: names in it may have any
/// length. What is left out of the middle of a line, or of all lines, is counted.
std::string make_readable(std::string_view message);

/// A finite number that is the whole text.
std::optional<double> parse_number(std::string_view text);

// The words for the values of an enumeration stand beside it, in its order:
// `constexpr auto names_of(Border) { return std::array{"border", "edge", "repeat"}; }`

template <class Enum>
constexpr const char* name_of(Enum value) {
  return names_of(value)[static_cast<std::size_t>(value)];
}

/// All words.
template <class Enum>
std::vector<std::string> list_names() {
  const auto names = names_of(Enum());
  return {names.begin(), names.end()};
}

/// The place of a name. Throws Error(kUsage) "unknown WHAT 'x'; known: a, b" where it is none of these.
std::size_t find_name(std::string_view name, const std::vector<std::string>& known, std::string_view what);

/// The value of a word. Throws likewise.
template <class Enum>
Enum parse_name(std::string_view name, std::string_view what) {
  return static_cast<Enum>(find_name(name, list_names<Enum>(), what));
}

}  // namespace shadowbench
