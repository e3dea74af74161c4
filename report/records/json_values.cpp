#include "report/records/json_values.h"

#include <cassert>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "report/records/record_fields.h"

namespace shadowbench::records {
namespace {

using nlohmann::json;

constexpr double kLargestExactInteger = 9007199254740992.0;  // 2^53

void require(bool holds, const char* expected) {
  if (!holds) throw std::invalid_argument(expected);
}

}  // namespace

json parse_json(std::istream& stream) {
  constexpr int kDeepest = 100;
  return json::parse(stream, [](int depth, json::parse_event_t, json&) {
    if (depth > kDeepest) throw std::invalid_argument("nested more than 100 deep");
    return true;
  });
}

json number_json(double value) {
  assert(std::isfinite(value));
  if (std::nearbyint(value) == value && std::abs(value) <= kLargestExactInteger)
    return static_cast<std::int64_t>(value);
  return value;
}

std::string dump_line(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json value_json(const std::string& value) { return value; }
json value_json(int value) { return value; }
json value_json(std::int64_t value) { return value; }
json value_json(std::uint64_t value) { return value; }
json value_json(bool value) { return value; }
json value_json(double value) { return number_json(value); }

NLOHMANN_JSON_SERIALIZE_ENUM(CellStatus, {{CellStatus::kOk, "ok"},
                                          {CellStatus::kSuspect, "suspect"},
                                          {CellStatus::kTimeout, "timeout"},
                                          {CellStatus::kCrashed, "crashed"},
                                          {CellStatus::kError, "error"}})
NLOHMANN_JSON_SERIALIZE_ENUM(TimerKind,
                             {{TimerKind::kWallClock, "wall_clock"}, {TimerKind::kTimerQuery, "timer_query"}})

json value_json(CellStatus value) { return value; }
json value_json(TimerKind value) { return value; }

json value_json(const Quartiles& value) {
  return {{"median", value.median}, {"q1", value.q1}, {"q3", value.q3}, {"n", value.n}};
}

json value_json(const Interval& value) { return json::array({value.low, value.high}); }

json value_json(const OwnTime& value) {
  json result = value_json(static_cast<const Quartiles&>(value));
  result["ci95"] = value_json(value.ci95);
  return result;
}

json value_json(const Ratio& value) { return {{"median", value.median}, {"ci95", value_json(value.ci95)}}; }

json value_json(const std::vector<LightCountRecord>& value) {
  json result = json::array();
  for (const LightCountRecord& each : value) {
    result.push_back(
        {{"count", each.count},
         {"still_ms", value_json(each.still_ms)},
         {"moving_ms", value_json(each.moving_ms)},
         {"ratio_to_none", {{"still", value_json(each.still_ratio)}, {"moving", value_json(each.moving_ratio)}}},
         {"maps_bytes", each.maps_bytes}});
  }
  return result;
}

json value_json(const ParamMap& value) {
  json result = json::object();
  for (const auto& [name, param] : value)
    result[name] = std::visit([](const auto& held) { return value_json(held); }, param);
  return result;
}

json value_json(const BiasRecord& value) {
  json result;
  visit_bias_fields(value, [&](const char* name, const auto& field) { result[name] = value_json(field); });
  return result;
}

json value_json(const std::map<std::string, std::string>& value) { return json(value); }
json value_json(const std::vector<std::string>& value) { return json(value); }

json value_json(const std::vector<SceneRecord>& value) {
  json result = json::array();
  for (const SceneRecord& scene : value) result.push_back({{"name", scene.name}, {"title", scene.title}});
  return result;
}

template <>
std::string read_value(const json& json) {
  return json.get<std::string>();
}

template <>
bool read_value(const json& json) {
  return json.get<bool>();
}

template <>
double read_value(const json& json) {
  require(json.is_number(), "a number");
  return json.get<double>();
}

template <>
std::int64_t read_value(const json& json) {
  require(json.is_number_integer(), "an integer");
  return json.get<std::int64_t>();
}

template <>
std::uint64_t read_value(const json& json) {
  require(json.is_number_unsigned(), "an integer that is not negative");
  return json.get<std::uint64_t>();
}

template <>
int read_value(const json& json) {
  require(json.is_number_integer(), "an integer");
  return json.get<int>();
}

template <>
CellStatus read_value(const json& value) {
  const auto status = value.get<CellStatus>();
  require(value == json(status), "ok, suspect, timeout, crashed or error");
  return status;
}

template <>
TimerKind read_value(const json& value) {
  const auto kind = value.get<TimerKind>();
  require(value == json(kind), "wall_clock or timer_query");
  return kind;
}

template <>
Quartiles read_value(const json& json) {
  return {read_value<double>(json.at("median")), read_value<double>(json.at("q1")), read_value<double>(json.at("q3")),
          read_value<int>(json.at("n"))};
}

template <>
Interval read_value(const json& json) {
  require(json.is_array() && json.size() == 2, "two numbers");
  return {read_value<double>(json[0]), read_value<double>(json[1])};
}

template <>
OwnTime read_value(const json& json) {
  return {read_value<Quartiles>(json), read_value<Interval>(json.at("ci95"))};
}

template <>
Ratio read_value(const json& json) {
  return {read_value<double>(json.at("median")), read_value<Interval>(json.at("ci95"))};
}

template <>
std::vector<LightCountRecord> read_value(const json& json) {
  require(json.is_array(), "an array");
  std::vector<LightCountRecord> lights;
  for (const auto& each : json) {
    const auto& ratio = each.at("ratio_to_none");
    lights.push_back({read_value<int>(each.at("count")), read_value<Quartiles>(each.at("still_ms")),
                      read_value<Quartiles>(each.at("moving_ms")), read_value<Ratio>(ratio.at("still")),
                      read_value<Ratio>(ratio.at("moving")), read_value<std::int64_t>(each.at("maps_bytes"))});
  }
  return lights;
}

template <>
ParamMap read_value(const json& json) {
  require(json.is_object(), "an object");
  ParamMap params;
  for (const auto& [name, value] : json.items())
    if (value.is_boolean())
      params[name] = value.get<bool>();
    else if (value.is_string())
      params[name] = value.get<std::string>();
    else
      params[name] = read_value<double>(value);
  return params;
}

template <>
BiasRecord read_value(const json& json) {
  BiasRecord bias;
  visit_bias_fields(bias, [&](const char* name, auto& field) {
    field = read_value<std::remove_reference_t<decltype(field)>>(json.at(name));
  });
  return bias;
}

template <>
std::map<std::string, std::string> read_value(const json& json) {
  return json.get<std::map<std::string, std::string>>();
}

template <>
std::vector<std::string> read_value(const json& json) {
  return json.get<std::vector<std::string>>();
}

template <>
std::vector<SceneRecord> read_value(const json& json) {
  require(json.is_array(), "an array");
  std::vector<SceneRecord> scenes;
  for (const auto& scene : json)
    scenes.push_back({read_value<std::string>(scene.at("name")), read_value<std::string>(scene.at("title"))});
  return scenes;
}

}  // namespace shadowbench::records
