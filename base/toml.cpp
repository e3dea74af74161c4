#include "base/toml.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "base/files.h"
#include "base/text.h"

namespace shadowbench {

struct TomlValue::Document {
  toml::table root;
  TomlOrigin origin;
};

namespace {

/// The most names that one key may join with dots.
constexpr int kMostDots = 256;

/// Finds a key of more dots, "a.b.c", and returns its line, or 0. The parser makes a table of each name and recurses to
/// free them, which would end the program. Since the text is not parsed, dots in a string or comment may count too.
int find_too_deep_key(std::string_view text) {
  constexpr std::string_view kEndsAKey = "=,[]{}#\n";
  int line = 1;
  int dots = 0;
  for (const char c : text) {
    if (c == '\n') ++line;
    if (kEndsAKey.find(c) != std::string_view::npos) dots = 0;
    if (c == '.' && ++dots > kMostDots) return line;
  }
  return 0;
}

[[noreturn]] void fail_at(int line, const std::string& message, const TomlOrigin& origin) {
  throw Error(origin.kind, message, fmt::format("{}:{}", origin.file, origin.first_line - 1 + line));
}

toml::table parse(std::string_view text, const TomlOrigin& origin) {
  if (const int line = find_too_deep_key(text); line > 0)
    fail_at(line, fmt::format("a key has more than {} dots", kMostDots), origin);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& e) {
    fail_at(static_cast<int>(e.source().begin.line), fmt::format("not valid TOML: {}", e.description()), origin);
  }
}

std::string read_text(const std::filesystem::path& file) {
  const std::vector<unsigned char> bytes = read_file_bytes(file);
  return {bytes.begin(), bytes.end()};
}

std::string range_text(Range range) {
  const auto is = [&](Range known) { return range.min == known.min && range.max == known.max; };
  if (is(kAnyNumber) || is(kFinite)) return "a finite number";
  if (is(kPositive)) return "a number above 0";
  return fmt::format("a number from {} to {}", range.min, range.max);
}

/// Writes a value on one line. toml++ breaks long lists, and for inf in one it computes an undefined width.
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

/// What a message says that a value is.
std::string describe(const toml::node& node) {
  constexpr std::size_t kMostElements = 6, kMostCharacters = 60;
  if (node.is_table()) return "a table";
  if (const toml::array* array = node.as_array()) {
    std::vector<std::string> texts;
    for (const toml::node& element : *array) {
      if (texts.size() == kMostElements) break;
      texts.push_back(element.is_array() ? "[...]" : element.is_table() ? "{...}" : describe(element));
    }
    return fmt::format("[{}{}]", fmt::join(texts, ", "), array->size() > kMostElements ? ", ..." : "");
  }
  const std::string text = write_value(node);
  return text.size() <= kMostCharacters ? text : text.substr(0, kMostCharacters) + "...";
}

bool holds_tables(const toml::node& node) {
  const toml::array* array = node.as_array();
  return node.is_table() || (array && array->is_array_of_tables());
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

TomlValue::TomlValue(std::shared_ptr<const Document> document, const toml::node& node, std::string key,
                     std::string title)
    : document_(std::move(document)), node_(&node), key_(std::move(key)), title_(std::move(title)) {}

TomlValue::TomlValue(std::shared_ptr<const Document> document, std::string title)
    : document_(std::move(document)), node_(&document_->root), title_(std::move(title)) {}

int TomlValue::line() const {
  return document_->origin.first_line - 1 + std::max(static_cast<int>(node_->source().begin.line), 1);
}

std::string TomlValue::where() const {
  const std::string& file = document_->origin.file;
  return file.empty() ? file : fmt::format("{}:{}", file, line());
}

template <class T>
std::optional<T> TomlValue::as() const {
  if constexpr (std::is_same_v<T, double>)
    if (const auto* whole = node_->as_integer()) return static_cast<double>(whole->get());
  return node_->value_exact<T>();
}

template std::optional<bool> TomlValue::as() const;
template std::optional<std::int64_t> TomlValue::as() const;
template std::optional<double> TomlValue::as() const;
template std::optional<std::string> TomlValue::as() const;

std::optional<std::vector<TomlValue>> TomlValue::as_list() const {
  const toml::array* array = node_->as_array();
  if (!array) return std::nullopt;
  std::vector<TomlValue> elements;
  for (const toml::node& element : *array) elements.push_back({document_, element, key_, title_});
  return elements;
}

std::optional<TomlTable> TomlValue::as_table(std::string title) const {
  if (!node_->is_table()) return std::nullopt;
  return TomlTable(TomlValue(document_, *node_, key_, std::move(title)));
}

double TomlValue::number(Range range) const {
  const auto value = as<double>();
  if (value && *value >= range.min && *value <= range.max) return *value;
  throw must_be(range_text(range));
}

Error TomlValue::error(const std::string& message) const { return {document_->origin.kind, message, where()}; }

Error TomlValue::must_be(std::string_view expected) const {
  return error(fmt::format("{} must be {}, but is {}", title_, expected, describe(*node_)));
}

TomlTable::TomlTable(std::string_view text, std::string title, TomlOrigin origin)
    : TomlTable(parse(text, origin), std::move(title), origin) {}

TomlTable::TomlTable(toml::table table, std::string title, TomlOrigin origin)
    : TomlValue(std::make_shared<const Document>(Document{std::move(table), std::move(origin)}), std::move(title)) {}

void TomlTable::require_known_keys(std::vector<std::string> known, const std::vector<std::string>& more) const {
  known.insert(known.end(), more.begin(), more.end());
  for (const TomlValue& each : entries())
    if (std::ranges::find(known, each.key()) == known.end())
      throw each.error(
          fmt::format("unknown key '{}' in {}{}", each.key(), title_, did_you_mean_or_known(each.key(), known)));
}

std::optional<TomlValue> TomlTable::find(std::string_view key) const {
  const toml::node* node = node_->as_table()->get(key);
  if (!node) return std::nullopt;
  return TomlValue(document_, *node, std::string(key), fmt::format("'{}' in {}", key, title_));
}

std::vector<TomlValue> TomlTable::entries() const {
  std::vector<TomlValue> all;
  for (const auto& [key, node] : *node_->as_table()) all.push_back(*find(key.str()));
  return all;
}

TomlValue TomlTable::require(std::string_view key, std::string_view expected) const {
  if (auto value = find(key)) return *std::move(value);
  throw error(fmt::format("{} lacks '{}': expected {}", title_, key, expected));
}

template <class T>
T TomlTable::get(std::string_view key, std::string_view expected, std::optional<T> fallback) const {
  if (fallback && !has(key)) return *std::move(fallback);
  const TomlValue value = require(key, expected);
  if (auto read = value.as<T>()) return *std::move(read);
  throw value.must_be(expected);
}

double TomlTable::number(std::string_view key, Range range, std::optional<double> fallback) const {
  return fallback && !has(key) ? *fallback : require(key, range_text(range)).number(range);
}

float TomlTable::number_f(std::string_view key, Range range, std::optional<double> fallback) const {
  return static_cast<float>(number(key, range, fallback));
}

std::int64_t TomlTable::whole(std::string_view key, Range range, std::optional<std::int64_t> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const std::string expected = fmt::format("a whole number from {} to {}", range.min, range.max);
  const TomlValue value = require(key, expected);
  const double number = value.as<double>().value_or(std::nan(""));
  if (number >= range.min && number <= range.max && number == std::floor(number))
    return static_cast<std::int64_t>(number);
  throw value.must_be(expected);
}

int TomlTable::integer(std::string_view key, Range range, std::optional<int> fallback) const {
  return static_cast<int>(whole(key, range, fallback));
}

bool TomlTable::boolean(std::string_view key, bool fallback) const { return get<bool>(key, "true or false", fallback); }

std::string TomlTable::string(std::string_view key, std::optional<std::string> fallback) const {
  return get(key, "a string", std::move(fallback));
}

std::vector<std::string> TomlTable::strings(std::string_view key,
                                            std::optional<std::vector<std::string>> fallback) const {
  constexpr std::string_view kExpected = "a string or a list of strings";
  if (fallback && !has(key)) return *std::move(fallback);
  const TomlValue value = require(key, kExpected);
  std::vector<std::string> texts;
  for (const TomlValue& each : value.as_list().value_or(std::vector{value})) {
    const auto text = each.as<std::string>();
    if (!text) throw each.must_be(kExpected);
    texts.push_back(*text);
  }
  return texts;
}

glm::dvec3 TomlTable::vec3(std::string_view key, Range range, std::optional<glm::dvec3> fallback) const {
  if (fallback && !has(key)) return *fallback;
  const std::vector<double> v = numbers(key, 3, range);
  return {v[0], v[1], v[2]};
}

glm::dvec2 TomlTable::vec2(std::string_view key, Range range) const {
  const std::vector<double> v = numbers(key, 2, range);
  return {v[0], v[1]};
}

std::string TomlTable::choice(std::string_view key, const std::vector<std::string>& choices,
                              std::optional<std::string> fallback) const {
  std::string value = string(key, std::move(fallback));
  if (std::ranges::find(choices, value) != choices.end()) return value;
  throw unknown(key, value, choices);
}

Error TomlTable::unknown(std::string_view key, const std::string& value, const std::vector<std::string>& known) const {
  return error(key, fmt::format("unknown {} '{}' in {}; expected one of: {}{}", key, value, title_,
                                fmt::join(known, ", "), did_you_mean(value, known)));
}

std::filesystem::path TomlTable::file(std::string_view key) const {
  std::filesystem::path named = std::filesystem::path(document_->origin.file).parent_path() / string(key);
  std::error_code ignored;
  if (std::filesystem::exists(named, ignored)) return named;
  throw error(key, fmt::format("'{}' in {}: there is no file {}", key, title_, named.string()));
}

std::optional<TomlTable> TomlTable::table(std::string_view key) const {
  const auto value = find(key);
  if (!value) return std::nullopt;
  const std::string title = fmt::format("[{}]", key);
  if (auto table = value->as_table(title)) return table;
  throw value->must_be("a table, " + title);
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  const auto value = find(key);
  if (!value) return {};
  if (auto single = value->as_table(fmt::format("[{}]", key))) return {*std::move(single)};
  std::vector<TomlTable> all;
  for (const TomlValue& each : value->as_list().value_or(std::vector<TomlValue>()))
    if (auto table = each.as_table(fmt::format("[[{}]] number {}", key, all.size() + 1)))
      all.push_back(*std::move(table));
    else
      throw value->must_be(fmt::format("tables, [[{}]]", key));
  if (all.empty()) throw value->must_be(fmt::format("tables, [[{}]]", key));
  return all;
}

Error TomlTable::error(std::string_view key, const std::string& message) const {
  const auto value = find(key);
  return value ? value->error(message) : error(message);
}

std::vector<double> TomlTable::numbers(std::string_view key, std::size_t count, Range range) const {
  const std::string expected = fmt::format("{} numbers, each {}", count, range_text(range));
  const TomlValue value = require(key, expected);
  const auto list = value.as_list();
  if (!list || list->size() != count) throw value.must_be(expected);
  std::vector<double> values;
  for (const TomlValue& element : *list) values.push_back(element.number(range));
  return values;
}

TomlTable read_toml(const std::filesystem::path& file, std::string title) {
  return TomlTable(read_text(file), std::move(title), {.file = file.string()});
}

toml::table parse_toml_file(const std::filesystem::path& file) {
  return parse(read_text(file), {.file = file.string()});
}

double write_number(float value) {
  const std::string text = fmt::format("{}", value);
  double number = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

toml::array write_numbers(std::span<const float> values) {
  toml::array array;
  for (const float value : values) array.push_back(write_number(value));
  return array;
}

std::string write_toml(const toml::table& document) {
  std::string text;
  write_table(text, document, {});
  return text;
}

}  // namespace shadowbench
