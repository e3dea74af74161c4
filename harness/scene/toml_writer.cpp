#include "harness/scene/toml_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>
#include <vector>

namespace shadowbench::scene {
namespace {

bool holds_tables(const toml::node& node) {
  const toml::array* array = node.as_array();
  return node.is_table() || (array && array->is_array_of_tables());
}

std::string write_value(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  if (const toml::array* array = node.as_array()) {
    std::vector<std::string> values;
    for (const toml::node& each : *array) values.push_back(write_value(each));
    return fmt::format("[{}]", fmt::join(values, ", "));
  }
  std::ostringstream text;
  text << toml::toml_formatter(node);
  return text.str();
}

/// Writes what a table holds; `title` is its name, empty for the document.
void write_table(std::string& text, const toml::table& table, const std::string& title) {
  for (const auto& [key, node] : table)
    if (!holds_tables(node)) text += fmt::format("{} = {}\n", key.str(), write_value(node));
  for (const auto& [key, node] : table) {
    if (!holds_tables(node)) continue;
    const std::string name = title.empty() ? std::string(key.str()) : fmt::format("{}.{}", title, key.str());
    if (const toml::table* single = node.as_table()) {
      text += fmt::format("\n[{}]\n", name);
      write_table(text, *single, name);
      continue;
    }
    for (const toml::node& each : *node.as_array()) {
      text += fmt::format("\n[[{}]]\n", name);
      write_table(text, *each.as_table(), name);
    }
  }
}

}  // namespace

std::string write_toml(const toml::table& document) {
  std::string text;
  write_table(text, document, {});
  return text;
}

}  // namespace shadowbench::scene
