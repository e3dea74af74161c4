#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "filters/base/error.h"

namespace shadowbench::scene {

/// The values a number may take, both ends included.
struct Range {
  double min;
  double max;
};

/// Every finite number a scene may hold.
inline constexpr Range kAnyNumber{-1e12, 1e12};
/// A part of a linear colour.
inline constexpr Range kColor{0.0, 1.0};
/// Lengths: anything with an extent.
inline constexpr Range kPositive{1e-9, 1e12};

/// Parses a TOML file. Throws kInput, with the line, where it is missing or malformed.
toml::table parse_toml_file(const std::filesystem::path& file);

/// Reads one TOML table and says where and why a value does not fit.
/// Every getter throws kInput with "file:line", what was expected and what is there; without a fallback the key is
/// required.
class TomlTable {
 public:
  /// `title` names the table in messages, e.g. "[camera]"; `table` must outlive this object.
  TomlTable(const toml::table& table, std::string title, std::string file);

  /// Throws for the first key that is not in `known`, with the nearest one that is.
  void require_known_keys(const std::vector<std::string>& known) const;
  bool has(std::string_view key) const { return table_->contains(key); }
  bool is_number(std::string_view key) const { return has(key) && table_->get(key)->is_number(); }

  double number(std::string_view key, Range range, std::optional<double> fallback = std::nullopt) const;
  float number_f(std::string_view key, Range range, std::optional<double> fallback = std::nullopt) const;
  int integer(std::string_view key, Range range, std::optional<int> fallback = std::nullopt) const;
  bool boolean(std::string_view key, bool fallback) const;
  std::string string(std::string_view key, std::optional<std::string> fallback = std::nullopt) const;
  /// A list of strings, of one at least.
  std::vector<std::string> strings(std::string_view key) const;
  glm::dvec3 vec3(std::string_view key, Range range, std::optional<glm::dvec3> fallback = std::nullopt) const;
  glm::dvec2 vec2(std::string_view key, Range range) const;
  /// Reads a string that must be one of `choices`.
  std::string choice(std::string_view key, const std::vector<std::string>& choices,
                     std::optional<std::string> fallback = std::nullopt) const;
  /// Reads the name of a file, relative to the one that the table stands in. Throws, too, where there is none.
  std::filesystem::path file(std::string_view key) const;

  /// The table under `key`, if there is one.
  std::optional<TomlTable> table(std::string_view key) const;
  /// The tables of [[key]], or the single [key]; none where the key is absent.
  std::vector<TomlTable> tables(std::string_view key) const;

  /// Makes an error that points at `key`, or at the table itself where the key is absent.
  Error error(std::string_view key, const std::string& message) const;
  const std::string& title() const { return title_; }

 private:
  std::vector<double> numbers(std::string_view key, std::size_t count, Range range) const;
  double checked(const toml::node& node, std::string_view key, Range range) const;
  [[noreturn]] void fail_missing(std::string_view key, std::string_view expected) const;
  [[noreturn]] void fail_type(std::string_view key, const toml::node& node, std::string_view expected) const;

  const toml::table* table_;
  std::string title_;
  std::string file_;
};

}  // namespace shadowbench::scene
