#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "report/records/record_fields.h"

namespace shadowbench::records {

/// Reads a file of JSON. Throws Error(kInput), which ends in `advice`, where it is missing, cut off, or nested more
/// than 100 deep: copying or writing such a value recurses, and would end the program. `keep` is told of every value
/// once it is read, and says whether it stays; see nlohmann::json::parser_callback_t.
nlohmann::json read_json_file(const std::filesystem::path& file, std::uintmax_t most_bytes, std::string_view advice,
                              const nlohmann::json::parser_callback_t& keep = {});

/// Writes a number: integral values as integers, so that 4 and 4.0 are one text.
nlohmann::json number_json(double value);

/// Writes JSON on one line; bytes that are not UTF-8 become U+FFFD.
std::string dump_line(const nlohmann::json& value);

/// Writes JSON as the text of a file, indented; likewise.
std::string dump_file(const nlohmann::json& value);

/// The place in an object that a dotted path names.
nlohmann::json::json_pointer make_pointer(std::string path);

/// Whether a type is made by a template, such as std::optional.
template <class T, template <class...> class Of>
inline constexpr bool kIsA = false;
template <class... Parts, template <class...> class Of>
inline constexpr bool kIsA<Of<Parts...>, Of> = true;

/// Whether a value is a text or several.
template <class T>
inline constexpr bool kIsText = std::is_same_v<T, std::string> || std::is_same_v<T, std::vector<std::string>> ||
                                std::is_same_v<T, std::map<std::string, std::string>>;

/// Writes a value as JSON. Numbers within records and lists are written as they are, and alone as number_json() does.
template <class T>
nlohmann::json value_json(const T& value);

/// Writes a value that is within a record or a list.
template <class T>
nlohmann::json member_json(const T& value) {
  if constexpr (std::is_same_v<T, double>) return value;
  if constexpr (std::is_same_v<T, std::optional<double>>) return value ? nlohmann::json(*value) : nlohmann::json();
  return value_json(value);
}

/// Writes the fields of a record into an object.
struct MemberWriter {
  nlohmann::json& root;

  void operator()(const std::string&, const Group&, const About& = {}) const {}
  template <class T>
  void operator()(const std::string& path, const T& value, const About& = {}) const {
    root[make_pointer(path)] = member_json(value);
  }
};

template <class T>
nlohmann::json value_json(const T& value) {
  using nlohmann::json;
  json result;
  if constexpr (std::is_same_v<T, double>) {
    result = number_json(value);
  } else if constexpr (std::is_enum_v<T>) {
    result = name_of(value);
  } else if constexpr (std::is_arithmetic_v<T> || kIsText<T> || std::is_same_v<T, json>) {
    result = value;
  } else if constexpr (kIsA<T, std::optional>) {
    if (value) result = value_json(*value);
  } else if constexpr (kIsA<T, std::variant>) {
    std::visit([&](const auto& held) { result = value_json(held); }, value);
  } else if constexpr (kIsA<T, std::map>) {
    result = json::object();
    for (const auto& [name, each] : value) result[name] = value_json(each);
  } else if constexpr (kIsA<T, std::vector>) {
    result = json::array();
    for (const auto& each : value) result.push_back(member_json(each));
  } else if constexpr (std::is_same_v<T, Interval>) {
    result = {value.low, value.high};
  } else {
    result = json::object();
    visit_fields(value, MemberWriter{result});
  }
  return result;
}

/// Throws std::invalid_argument, which says what was expected, where that does not hold.
inline void require(bool holds, const std::string& expected) {
  if (!holds) throw std::invalid_argument(expected);
}

/// Reads a value from JSON, strictly: no number becomes a text, no fraction an integer.
/// Throws nlohmann::json::exception or std::invalid_argument where the JSON holds something else.
template <class T>
T read_value(const nlohmann::json& json);

/// Reads the fields of a record from an object.
struct MemberReader {
  const nlohmann::json& root;

  void operator()(const std::string&, const Group&, const About& = {}) const {}
  template <class T>
  void operator()(const std::string& path, T& value, const About& about = {}) const {
    if (about.may_lack && !root.contains(make_pointer(path))) return;
    value = read_value<T>(root.at(make_pointer(path)));
  }
};

/// Reads the name of an enumeration's value; likewise.
template <class Enum>
Enum read_enum(const nlohmann::json& json) {
  const std::vector<std::string> names = list_names<Enum>();
  const auto found = std::ranges::find_if(names, [&](const std::string& name) { return json == name; });
  require(found != names.end(), fmt::format("{} or {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back()));
  return static_cast<Enum>(found - names.begin());
}

template <class T>
T read_value(const nlohmann::json& json) {
  T value{};
  if constexpr (std::is_enum_v<T>) {
    value = read_enum<T>(json);
  } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
    if constexpr (std::is_floating_point_v<T>) require(json.is_number(), "a number");
    if constexpr (std::is_signed_v<T> && std::is_integral_v<T>) require(json.is_number_integer(), "an integer");
    if constexpr (std::is_unsigned_v<T>) require(json.is_number_unsigned(), "an integer that is not negative");
    value = json.get<T>();
  } else if constexpr (kIsA<T, std::optional>) {
    if (!json.is_null()) value = read_value<typename T::value_type>(json);
  } else if constexpr (std::is_same_v<T, ParamValue>) {
    if (json.is_boolean())
      value = json.get<bool>();
    else if (json.is_string())
      value = json.get<std::string>();
    else
      value = read_value<double>(json);
  } else if constexpr (std::is_same_v<T, bool> || kIsText<T>) {
    value = json.get<T>();
  } else if constexpr (kIsA<T, std::map>) {
    require(json.is_object(), "an object");
    for (const auto& [name, each] : json.items()) value[name] = read_value<typename T::mapped_type>(each);
  } else if constexpr (kIsA<T, std::vector>) {
    require(json.is_array(), "an array");
    for (const auto& each : json) value.push_back(read_value<typename T::value_type>(each));
  } else if constexpr (std::is_same_v<T, Interval>) {
    require(json.is_array() && json.size() == 2, "two numbers");
    value = {read_value<double>(json[0]), read_value<double>(json[1])};
  } else {
    visit_fields(value, MemberReader{json});
  }
  return value;
}

/// Reads the fields of a file's record from an object.
/// Throws Error(kInput), with file and field, where one is missing or holds another type, or a path leaves the folder.
struct FieldReader {
  const nlohmann::json& root;
  const std::string& where;
  const char* advice;      ///< the end of a message: what to do
  std::string place = {};  ///< of the object in the file: "filters[0]."

  void operator()(const std::string&, const Group&, const About& = {}) const {}
  template <class T>
  void operator()(const std::string& path, T& value, const About& about = {}) const {
    const auto pointer = make_pointer(path);
    const bool is_there = root.is_object() && root.contains(pointer);
    if (!is_there && about.may_lack && root.is_object()) return;
    if (!is_there) fail(fmt::format("the field '{}{}' is missing", place, path));
    const nlohmann::json& written = root.at(pointer);
    const std::string held = fmt::format("the field '{}{}' holds {}", place, path, dump_line(written).substr(0, 60));
    try {
      value = read_value<T>(written);
    } catch (const std::exception& problem) {
      fail(fmt::format("{}, which is not what belongs there ({})", held, problem.what()));
    }
    // Reports come from elsewhere, and `merge` copies what they name.
    if (about.is_path && written.is_string() && !stays_inside(written.get<std::string>()))
      fail(held + ", which is outside the report's folder");
  }

  [[noreturn]] void fail(const std::string& fault) const;

 private:
  static bool stays_inside(const std::string& path);
};

}  // namespace shadowbench::records
