#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "harness/engines/score_run.h"
#include "report/records/json_values.h"

namespace shadowbench::engines {
namespace {

using nlohmann::json;

/// What a key may hold: texts, and numbers as they are written.
std::string read_text(const std::string& key, const json& value, const std::string& where) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number() || value.is_boolean()) return value.dump();
  fail_input(fmt::format("'{}' must be a text or a number", key), where);
}

double read_milliseconds(const json& value, const std::string& where) {
  if (value.is_number() && value.get<double>() >= 0.0 && std::isfinite(value.get<double>())) return value.get<double>();
  fail_input("'ms' must be a number of milliseconds, 0 or more", where);
}

glm::dmat4 read_matrix(const json& value, const std::string& where) {
  glm::dmat4 matrix(0.0);
  const bool is_list = value.is_array() && value.size() == 16;
  for (int i = 0; i < 16; ++i) {
    const bool is_number = is_list && value[static_cast<std::size_t>(i)].is_number();
    if (is_number) matrix[i / 4][i % 4] = value[static_cast<std::size_t>(i)].get<double>();
    if (!is_number || !std::isfinite(matrix[i / 4][i % 4]))
      fail_input("'map_from_world' must be 16 numbers, columns first", where);
  }
  if (glm::determinant(matrix) == 0.0) fail_input("'map_from_world' leads all points to one plane of the map", where);
  return matrix;
}

}  // namespace

Meta read_meta(const std::filesystem::path& file) {
  const std::string where = file.string();
  json read;
  try {
    const std::vector<unsigned char> bytes = read_file_bytes(file, kMebibyte);
    std::istringstream text(std::string(bytes.begin(), bytes.end()));
    read = records::parse_json(text);
  } catch (const json::exception& e) {
    fail_input(fmt::format("this is no JSON ({})", e.what()), where);
  } catch (const std::invalid_argument& e) {
    fail_input(e.what(), where);
  }
  if (!read.is_object())
    fail_input("a meta.json is one object, such as {\"engine\": \"three.js\", \"version\": \"r187\"}", where);
  Meta meta;
  records::ExternalRecord& external = meta.external;
  const std::vector<std::pair<std::string, std::optional<std::string>*>> texts = {
      {"engine", &external.engine}, {"version", &external.version}, {"driver", &external.driver},
      {"map", &external.map},       {"bias", &external.bias},       {"fit", &external.fit},
      {"timed", &external.timed}};
  std::vector<std::string> known = {"ms", "truth", "map_from_world"};
  for (const auto& [key, member] : texts) known.push_back(key);
  for (const auto& [key, value] : read.items()) {
    const auto text = std::ranges::find(texts, key, &std::pair<std::string, std::optional<std::string>*>::first);
    if (text != texts.end())
      *text->second = read_text(key, value, where);
    else if (key == "ms")
      external.ms = read_milliseconds(value, where);
    else if (key == "map_from_world")
      meta.map_from_world = read_matrix(value, where);
    else if (key == "truth")
      meta.truth = read_text(key, value, where);
    else
      fail_input(fmt::format("there is no key '{}'{}; keys: {}", key, did_you_mean(key, known), fmt::join(known, ", ")),
                 where);
  }
  return meta;
}

}  // namespace shadowbench::engines
