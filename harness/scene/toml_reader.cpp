#include "harness/scene/toml_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>

#include "filters/base/nearest_name.h"
#include "filters/base/toml_depth.h"
#include "harness/scene/files/file_bytes.h"

namespace shadowbench::scene {
namespace {

std::string range_text(Range range) {
  if (range.min == kAnyNumber.min && range.max == kAnyNumber.max) return "a finite number";
  if (range.min == kPositive.min && range.max == kPositive.max) return "a number above 0";
  return fmt::format("a number from {} to {}", range.min, range.max);
}

std::string text_of_scalar(const toml::node& node) {
  constexpr std::size_t kMostCharacters = 60;
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  std::ostringstream text;
  node.visit([&](const auto& value) {
    if constexpr (toml::is_value<decltype(value)>) text << value;
  });
  const std::string all = text.str();
  return all.size() <= kMostCharacters ? all : all.substr(0, kMostCharacters) + "...";
}

/// What a message says that a value is. Lists are put together here: toml++ breaks long ones into lines, and for inf in
/// a list it computes an undefined width.
std::string text_of(const toml::node& node) {
  constexpr std::size_t kMostElements = 6;
  if (node.is_table()) return "a table";
  const toml::array* array = node.as_array();
  if (!array) return text_of_scalar(node);
  std::vector<std::string> texts;
  for (const toml::node& element : *array) {
    if (texts.size() == kMostElements) break;
    texts.push_back(element.is_array() ? "[...]" : element.is_table() ? "{...}" : text_of_scalar(element));
  }
  return fmt::format("[{}{}]", fmt::join(texts, ", "), array->size() > kMostElements ? ", ..." : "");
}

}  // namespace

toml::table parse_toml_file(const std::filesystem::path& file) {
  const std::vector<unsigned char> bytes = read_file_bytes(file);
  const std::string text(bytes.begin(), bytes.end());
  if (const int line = find_too_deep_key(text); line > 0)
    fail_input(fmt::format("a key has more than {} dots", kMostDots), fmt::format("{}:{}", file.string(), line));
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& e) {
    const auto line = e.source().begin.line;
    fail_input(fmt::format("not valid TOML: {}", e.description()), fmt::format("{}:{}", file.string(), line));
  }
}

TomlTable::TomlTable(const toml::table& table, std::string title, std::string file)
    : table_(&table), title_(std::move(title)), file_(std::move(file)) {}

void TomlTable::require_known_keys(const std::vector<std::string>& known) const {
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::ranges::find(known, name) != known.end()) continue;
    fail_input(fmt::format("unknown key '{}' in {}{}", name, title_, did_you_mean_or_known(name, known)),
               fmt::format("{}:{}", file_, key.source().begin.line));
  }
}

double TomlTable::number(std::string_view key, Range range, std::optional<double> fallback) const {
  const toml::node* node = table_->get(key);
  if (node) return checked(*node, key, range);
  if (!fallback) fail_missing(key, range_text(range));
  return *fallback;
}

float TomlTable::number_f(std::string_view key, Range range, std::optional<double> fallback) const {
  return static_cast<float>(number(key, range, fallback));
}

int TomlTable::integer(std::string_view key, Range range, std::optional<int> fallback) const {
  const std::string expected = fmt::format("a whole number from {} to {}", range.min, range.max);
  const toml::node* node = table_->get(key);
  if (!node && !fallback) fail_missing(key, expected);
  if (!node) return *fallback;
  if (!node->is_integer()) fail_type(key, *node, expected);
  return static_cast<int>(checked(*node, key, range));
}

bool TomlTable::boolean(std::string_view key, bool fallback) const {
  const toml::node* node = table_->get(key);
  if (!node) return fallback;
  if (!node->is_boolean()) fail_type(key, *node, "true or false");
  return node->as_boolean()->get();
}

std::string TomlTable::string(std::string_view key, std::optional<std::string> fallback) const {
  const toml::node* node = table_->get(key);
  if (!node && !fallback) fail_missing(key, "a string");
  if (!node) return *fallback;
  if (!node->is_string()) fail_type(key, *node, "a string");
  return node->as_string()->get();
}

std::vector<std::string> TomlTable::strings(std::string_view key) const {
  constexpr std::string_view kExpected = "a list of strings, such as [\"a\"]";
  const toml::node* node = table_->get(key);
  if (!node) fail_missing(key, kExpected);
  const toml::array* list = node->as_array();
  if (!list || list->empty() || !list->is_homogeneous(toml::node_type::string)) fail_type(key, *node, kExpected);
  std::vector<std::string> texts;
  for (const toml::node& each : *list) texts.push_back(each.as_string()->get());
  return texts;
}

glm::dvec3 TomlTable::vec3(std::string_view key, Range range, std::optional<glm::dvec3> fallback) const {
  if (!has(key) && fallback) return *fallback;
  const std::vector<double> v = numbers(key, 3, range);
  return {v[0], v[1], v[2]};
}

glm::dvec2 TomlTable::vec2(std::string_view key, Range range) const {
  const std::vector<double> v = numbers(key, 2, range);
  return {v[0], v[1]};
}

std::string TomlTable::choice(std::string_view key, const std::vector<std::string>& choices,
                              std::optional<std::string> fallback) const {
  const std::string value = string(key, std::move(fallback));
  if (std::ranges::find(choices, value) != choices.end()) return value;
  throw error(key, fmt::format("unknown {} '{}' in {}; expected one of: {}{}", key, value, title_,
                               fmt::join(choices, ", "), did_you_mean(value, choices)));
}

std::filesystem::path TomlTable::file(std::string_view key) const {
  std::filesystem::path named = std::filesystem::path(file_).parent_path() / string(key);
  std::error_code ignored;
  if (std::filesystem::exists(named, ignored)) return named;
  throw error(key, fmt::format("'{}' in {}: there is no file {}", key, title_, named.string()));
}

std::optional<TomlTable> TomlTable::table(std::string_view key) const {
  const toml::node* node = table_->get(key);
  if (!node) return std::nullopt;
  if (!node->is_table()) fail_type(key, *node, fmt::format("a table, [{}]", key));
  return TomlTable(*node->as_table(), fmt::format("[{}]", key), file_);
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  const toml::node* node = table_->get(key);
  if (!node) return {};
  if (node->is_table()) return {*table(key)};
  if (!node->is_array_of_tables()) fail_type(key, *node, fmt::format("tables, [[{}]]", key));
  std::vector<TomlTable> all;
  for (const toml::node& element : *node->as_array())
    all.emplace_back(*element.as_table(), fmt::format("[[{}]] number {}", key, all.size() + 1), file_);
  return all;
}

Error TomlTable::error(std::string_view key, const std::string& message) const {
  const toml::node* node = table_->get(key);
  const auto line = node ? node->source().begin.line : table_->source().begin.line;
  return Error(ErrorKind::kInput, message, line > 0 ? fmt::format("{}:{}", file_, line) : file_);
}

std::vector<double> TomlTable::numbers(std::string_view key, std::size_t count, Range range) const {
  const std::string expected = fmt::format("{} numbers, each {}", count, range_text(range));
  const toml::node* node = table_->get(key);
  if (!node) fail_missing(key, expected);
  const toml::array* array = node->as_array();
  if (!array || array->size() != count) fail_type(key, *node, expected);
  std::vector<double> values;
  for (const toml::node& element : *array) values.push_back(checked(element, key, range));
  return values;
}

double TomlTable::checked(const toml::node& node, std::string_view key, Range range) const {
  if (!node.is_number()) fail_type(key, node, range_text(range));
  const double value = *node.value<double>();
  if (value >= range.min && value <= range.max) return value;
  throw error(key, fmt::format("'{}' in {} must be {}, but is {}", key, title_, range_text(range), text_of(node)));
}

void TomlTable::fail_missing(std::string_view key, std::string_view expected) const {
  throw error(key, fmt::format("{} lacks '{}': expected {}", title_, key, expected));
}

void TomlTable::fail_type(std::string_view key, const toml::node& node, std::string_view expected) const {
  throw error(key, fmt::format("'{}' in {} must be {}, but is {}", key, title_, expected, text_of(node)));
}

}  // namespace shadowbench::scene
