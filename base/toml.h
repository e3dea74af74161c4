#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

// The header of toml++ costs seconds wherever it is included.
namespace toml {
inline namespace v3 {
class array;
class node;
class table;
}  // namespace v3
}  // namespace toml

namespace shadowbench {

class TomlTable;

/// The values a number may take, both ends included.
struct Range {
  double min;
  double max;
};

inline constexpr Range kFinite{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max()};
/// Every finite number a scene may hold.
inline constexpr Range kAnyNumber{-1e12, 1e12};
/// Lengths: anything with an extent.
inline constexpr Range kPositive{1e-9, 1e12};

/// Where a TOML text comes from, and what its errors are.
struct TomlOrigin {
  std::string file;                    ///< empty: the text is no file's
  int first_line = 1;                  ///< of the file, where the text begins
  ErrorKind kind = ErrorKind::kInput;  ///< of every error that is thrown
};

/// A value of a TOML text, and all that an error says of it: what it is called, and "file:line". It keeps the text.
class TomlValue {
 public:
  const std::string& key() const { return key_; }      ///< of an element of a list that of the list
  const std::string& title() const { return title_; }  ///< "'size' in [[object]] number 2"; of a table "[camera]"
  int line() const;                                    ///< of the file
  std::string where() const;                           ///< "file:line"; empty where the text is no file's

  /// The value, if it is a bool, std::int64_t, double (whole numbers are such, too) or std::string.
  template <class T>
  std::optional<T> as() const;
  /// The elements, if it is a list.
  std::optional<std::vector<TomlValue>> as_list() const;
  /// The table, if it is one, under its title in messages.
  std::optional<TomlTable> as_table(std::string title) const;
  /// Throws for what is no number, or out of range.
  double number(Range range) const;

  /// Makes an error that points here.
  Error error(const std::string& message) const;
  /// Makes the error that it is none of what was expected: "a string".
  Error must_be(std::string_view expected) const;

 private:
  friend class TomlTable;
  struct Document;
  TomlValue(std::shared_ptr<const Document> document, std::string title);
  TomlValue(std::shared_ptr<const Document> document, const toml::node& node, std::string key, std::string title);

  std::shared_ptr<const Document> document_;
  const toml::node* node_;
  std::string key_;
  std::string title_;
};

/// A table of a TOML text. Every getter throws with "file:line", what was expected and what is there; without a
/// fallback the key is required.
class TomlTable : public TomlValue {
 public:
  using TomlValue::error;
  using TomlValue::number;

  /// Parses a text, of which messages speak as `title`. Throws, with the line, where it is malformed.
  TomlTable(std::string_view text, std::string title, TomlOrigin origin);
  /// Takes a table that was put together.
  TomlTable(toml::table table, std::string title, TomlOrigin origin = {});

  /// Throws for the first key that is not among these, with the nearest one that is.
  void require_known_keys(std::vector<std::string> known, const std::vector<std::string>& more = {}) const;
  bool has(std::string_view key) const { return find(key).has_value(); }
  std::optional<TomlValue> find(std::string_view key) const;
  /// All that it holds, by key.
  std::vector<TomlValue> entries() const;

  double number(std::string_view key, Range range, std::optional<double> fallback = std::nullopt) const;
  float number_f(std::string_view key, Range range, std::optional<double> fallback = std::nullopt) const;
  std::int64_t whole(std::string_view key, Range range, std::optional<std::int64_t> fallback = std::nullopt) const;
  int integer(std::string_view key, Range range, std::optional<int> fallback = std::nullopt) const;
  bool boolean(std::string_view key, bool fallback) const;
  std::string string(std::string_view key, std::optional<std::string> fallback = std::nullopt) const;
  /// A string, which counts as a list of one, or a list of strings.
  std::vector<std::string> strings(std::string_view key,
                                   std::optional<std::vector<std::string>> fallback = std::nullopt) const;
  glm::dvec3 vec3(std::string_view key, Range range, std::optional<glm::dvec3> fallback = std::nullopt) const;
  glm::dvec2 vec2(std::string_view key, Range range) const;
  /// Reads a string that must be one of `choices`.
  std::string choice(std::string_view key, const std::vector<std::string>& choices,
                     std::optional<std::string> fallback = std::nullopt) const;
  /// Reads what such a string stands for.
  template <class Value>
  Value choose(std::string_view key, const std::vector<std::pair<std::string, Value>>& known,
               std::optional<std::string> fallback = std::nullopt) const {
    std::vector<std::string> names;
    for (const auto& each : known) names.push_back(each.first);
    const std::string name = choice(key, names, std::move(fallback));
    return std::ranges::find(known, name, &std::pair<std::string, Value>::first)->second;
  }
  /// Makes the error for a string of which nothing is known.
  Error unknown(std::string_view key, const std::string& value, const std::vector<std::string>& known) const;
  /// Reads the name of a file, relative to the one that the table stands in. Throws, too, where there is none.
  std::filesystem::path file(std::string_view key) const;

  /// The table under `key`, if there is one.
  std::optional<TomlTable> table(std::string_view key) const;
  /// The tables of [[key]], or the single [key]; none where the key is absent.
  std::vector<TomlTable> tables(std::string_view key) const;

  /// Makes an error that points at `key`, or at the table itself where the key is absent.
  Error error(std::string_view key, const std::string& message) const;

 private:
  friend class TomlValue;
  explicit TomlTable(TomlValue table) : TomlValue(std::move(table)) {}

  TomlValue require(std::string_view key, std::string_view expected) const;
  template <class T>
  T get(std::string_view key, std::string_view expected, std::optional<T> fallback) const;
  std::vector<double> numbers(std::string_view key, std::size_t count, Range range) const;
};

/// Parses a file. Throws kInput, with the line, where it is missing or malformed.
TomlTable read_toml(const std::filesystem::path& file, std::string title);
toml::table parse_toml_file(const std::filesystem::path& file);

/// Numbers for a file: the shortest decimals that are read back as the same floats.
double write_number(float value);
toml::array write_numbers(std::span<const float> values);

/// Writes a document for people: numbers with as few digits as are read back as the same, the values of a table before
/// the tables in it, a list on one line. Requires keys that need no quotes.
std::string write_toml(const toml::table& document);

}  // namespace shadowbench
