#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "filters/filter_spec.h"

namespace shadowbench::filters {

/// The least and the greatest value that a numeric parameter may take, by its range or by its choices.
struct Ends {
  double smallest;
  double largest;
};
Ends ends_of(const ParamSpec& param);

/// Walks the TOML of one front matter. What is wrong ends it with Error(kFilter), which names the line of the whole
/// file.
class FrontMatterReader {
 public:
  FrontMatterReader(std::string path, int first_line) : path_(std::move(path)), first_line_(first_line) {}

  /// The line of the whole file at which a node begins.
  int line_of(const toml::node* node) const;

  [[noreturn]] void fail(const toml::node* node, const std::string& message) const;
  [[noreturn]] void fail_at(int toml_line, const std::string& message) const;
  [[noreturn]] void fail_unknown(const toml::node* node, const std::string& key, const std::string& value,
                                 const std::vector<std::string>& known) const;

  /// Refuses keys that are not known, with a suggestion.
  void check_keys(const toml::table& table, const std::vector<std::string>& known, const std::string& place) const;

  /// Empty without the key.
  std::string text(const toml::table& table, const std::string& key, bool required) const;
  bool flag(const toml::table& table, const std::string& key) const;  ///< false without the key
  std::optional<double> finite(const toml::table& table, const std::string& key) const;
  unsigned whole(const toml::table& table, const std::string& key, unsigned least, unsigned most) const;  ///< or 1

  /// The value that a text stands for; without the key the first one.
  template <class Value>
  Value choose(const toml::table& table, const std::string& key,
               const std::vector<std::pair<std::string, Value>>& known) const {
    const std::string name = text(table, key, false);
    if (name.empty()) return known.front().second;
    std::vector<std::string> names;
    for (const auto& [each, value] : known) {
      if (each == name) return value;
      names.push_back(each);
    }
    fail_unknown(table.get(key), key, name, names);
  }

  /// A list of texts; one text counts as a list of one.
  std::vector<std::string> texts(const toml::table& table, const std::string& key) const;

  ParamValue value(const toml::node& node, const std::string& what) const;

  /// The tables `[key.NAME]` in the order of the file: TOML sorts them by name, and the author's order is the one that
  /// people read. A name must be one that GLSL takes, and not among those taken, to which it is added.
  std::vector<std::pair<std::string, const toml::table*>> named_tables(const toml::table& root, const std::string& key,
                                                                       std::vector<std::string>& taken) const;

 private:
  std::string path_;
  int first_line_;
};

}  // namespace shadowbench::filters
