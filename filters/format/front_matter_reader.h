#pragma once

#include <toml++/toml.h>

#include <optional>
#include <string>
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

  [[noreturn]] void fail(const toml::node* node, const std::string& message) const;
  [[noreturn]] void fail_at(int toml_line, const std::string& message) const;

  /// Refuses keys that are not known, with a suggestion.
  void check_keys(const toml::table& table, const std::vector<std::string>& known, const std::string& place) const;

  /// Empty without the key.
  std::string text(const toml::table& table, const std::string& key, bool required) const;
  bool flag(const toml::table& table, const std::string& key) const;  ///< false without the key
  std::optional<double> finite(const toml::table& table, const std::string& key) const;

  /// A list of texts; one text counts as a list of one.
  std::vector<std::string> texts(const toml::table& table, const std::string& key) const;

  ParamValue value(const toml::node& node, const std::string& what) const;

 private:
  std::string path_;
  int first_line_;
};

}  // namespace shadowbench::filters
