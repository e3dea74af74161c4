#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::records {

/// Parses JSON. Throws nlohmann::json::exception, or std::invalid_argument where it is nested more than 100 deep:
/// copying or writing such a value recurses, and would end the program.
/// `keep` is told of every value once it is read, and says whether it stays; see nlohmann::json::parser_callback_t.
nlohmann::json parse_json(std::istream& stream, const nlohmann::json::parser_callback_t& keep = {});

/// Writes a number: integral values as integers, so that 4 and 4.0 are one text. Requires a finite value.
nlohmann::json number_json(double value);

/// Writes JSON on one line; bytes that are not UTF-8 become U+FFFD.
std::string dump_line(const nlohmann::json& value);

/// Writes an array of records, each as `write` has it.
template <class T>
nlohmann::json list_json(const std::vector<T>& records, nlohmann::json (*write)(const std::type_identity_t<T>&)) {
  nlohmann::json result = nlohmann::json::array();
  for (const T& record : records) result.push_back(write(record));
  return result;
}

/// Writes one value of a record as JSON.
nlohmann::json value_json(const std::string& value);
nlohmann::json value_json(int value);
nlohmann::json value_json(std::int64_t value);
nlohmann::json value_json(std::uint64_t value);
nlohmann::json value_json(bool value);
nlohmann::json value_json(double value);
nlohmann::json value_json(CellStatus value);
nlohmann::json value_json(TimerKind value);
nlohmann::json value_json(const MachineKind& value);
nlohmann::json value_json(const Quartiles& value);
nlohmann::json value_json(const Interval& value);
nlohmann::json value_json(const OwnTime& value);
nlohmann::json value_json(const Ratio& value);
nlohmann::json value_json(const std::vector<LightCountRecord>& value);
nlohmann::json value_json(const GpuRecords& value);
nlohmann::json value_json(const ParamMap& value);
nlohmann::json value_json(const BiasRecord& value);
nlohmann::json value_json(const std::map<std::string, std::string>& value);
nlohmann::json value_json(const std::vector<std::string>& value);
nlohmann::json value_json(const std::vector<SceneRecord>& value);

/// Reads one value of a record from JSON, strictly: no number becomes a text, no fraction an integer.
/// Throws nlohmann::json::exception or std::invalid_argument where the JSON holds something else.
template <class T>
T read_value(const nlohmann::json& json);

/// An array of records, each as `write` makes it.
template <class T>
nlohmann::json list_json(const std::vector<T>& items, nlohmann::json (*write)(const T&)) {
  nlohmann::json result = nlohmann::json::array();
  for (const T& item : items) result.push_back(write(item));
  return result;
}

}  // namespace shadowbench::records
