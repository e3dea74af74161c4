#include "filters/format/front_matter_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "filters/base/error.h"
#include "filters/base/nearest_name.h"
#include "filters/format/glsl_words.h"

namespace shadowbench::filters {

Ends ends_of(const ParamSpec& param) {
  if (param.choices.empty()) return {*param.min, *param.max};
  Ends ends{std::get<double>(param.choices.front()), std::get<double>(param.choices.front())};
  for (const ParamValue& choice : param.choices) {
    ends.smallest = std::min(ends.smallest, std::get<double>(choice));
    ends.largest = std::max(ends.largest, std::get<double>(choice));
  }
  return ends;
}

int FrontMatterReader::line_of(const toml::node* node) const {
  const int line = node ? static_cast<int>(node->source().begin.line) : 1;
  return first_line_ - 1 + std::max(line, 1);
}

void FrontMatterReader::fail(const toml::node* node, const std::string& message) const {
  throw Error(ErrorKind::kFilter, message, fmt::format("{}:{}", path_, line_of(node)));
}

void FrontMatterReader::fail_at(int toml_line, const std::string& message) const {
  throw Error(ErrorKind::kFilter, message, fmt::format("{}:{}", path_, first_line_ - 1 + toml_line));
}

void FrontMatterReader::fail_unknown(const toml::node* node, const std::string& key, const std::string& value,
                                     const std::vector<std::string>& known) const {
  fail(node, fmt::format("{} '{}' is unknown; known: {}", key, value, fmt::join(known, ", ")));
}

void FrontMatterReader::check_keys(const toml::table& table, const std::vector<std::string>& known,
                                   const std::string& place) const {
  for (const auto& [key, node] : table) {
    const std::string name(key.str());
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    fail_at(static_cast<int>(key.source().begin.line),
            fmt::format("unknown key '{}' in {}{}", name, place, did_you_mean_or_known(name, known)));
  }
}

std::string FrontMatterReader::text(const toml::table& table, const std::string& key, bool required) const {
  const toml::node* node = table.get(key);
  if (!node) {
    if (required) fail(&table, fmt::format("the front matter lacks '{}', a text", key));
    return {};
  }
  const auto value = node->value_exact<std::string>();
  if (!value) fail(node, fmt::format("'{}' must be a text in quotes", key));
  return *value;
}

bool FrontMatterReader::flag(const toml::table& table, const std::string& key) const {
  const toml::node* node = table.get(key);
  if (!node) return false;
  const auto value = node->value_exact<bool>();
  if (!value) fail(node, fmt::format("'{}' must be true or false", key));
  return *value;
}

std::optional<double> FrontMatterReader::finite(const toml::table& table, const std::string& key) const {
  const toml::node* node = table.get(key);
  if (!node) return std::nullopt;
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) fail(node, fmt::format("'{}' must be a finite number", key));
  return value;
}

unsigned FrontMatterReader::whole(const toml::table& table, const std::string& key, unsigned least,
                                  unsigned most) const {
  const double value = finite(table, key).value_or(1.0);
  if (!(value >= least && value <= most) || value != std::floor(value))
    fail(table.get(key), fmt::format("'{}' must be a whole number from {} to {}", key, least, most));
  return static_cast<unsigned>(value);
}

std::vector<std::string> FrontMatterReader::texts(const toml::table& table, const std::string& key) const {
  const toml::node* node = table.get(key);
  if (!node) return {};
  if (const auto one = node->value_exact<std::string>()) return {*one};
  const toml::array* list = node->as_array();
  if (!list) fail(node, fmt::format("'{}' must be a text or a list of texts", key));
  std::vector<std::string> result;
  for (const toml::node& item : *list) {
    const auto value = item.value_exact<std::string>();
    if (!value) fail(&item, fmt::format("'{}' must hold texts only", key));
    result.push_back(*value);
  }
  return result;
}

ParamValue FrontMatterReader::value(const toml::node& node, const std::string& what) const {
  if (const auto flag_value = node.value_exact<bool>()) return *flag_value;
  if (const auto text_value = node.value_exact<std::string>()) return *text_value;
  if (node.is_number() && std::isfinite(*node.value<double>())) return *node.value<double>();
  fail(&node, fmt::format("{} must be a finite number, a text, true or false", what));
}

std::vector<std::pair<std::string, const toml::table*>> FrontMatterReader::named_tables(
    const toml::table& root, const std::string& key, std::vector<std::string>& taken) const {
  std::vector<std::pair<std::string, const toml::table*>> found;
  const toml::node* node = root.get(key);
  if (!node) return found;
  if (!node->as_table()) fail(node, fmt::format("'{0}' must hold tables: [{0}.NAME]", key));
  for (const auto& [name, value] : *node->as_table()) {
    if (!value.as_table()) fail(&value, fmt::format("'{0}' must hold tables: [{0}.NAME]", key));
    found.emplace_back(std::string(name.str()), value.as_table());
  }
  std::ranges::sort(found, {}, [](const auto& each) { return each.second->source().begin.line; });
  for (const auto& [name, table] : found) {
    if (!is_identifier(name)) fail(table, fmt::format("[{}.{}]: '{}' cannot be a name in GLSL", key, name, name));
    if (std::ranges::find(taken, name) != taken.end())
      fail(table, fmt::format("[{}.{}]: '{}' is the name of something else; choose another", key, name, name));
    taken.push_back(name);
  }
  return found;
}

}  // namespace shadowbench::filters
