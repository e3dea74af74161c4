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

json parse_json(std::istream& stream, const json::parser_callback_t& keep) {
  constexpr int kDeepest = 100;
  return json::parse(stream, [&](int depth, json::parse_event_t event, json& value) {
    if (depth > kDeepest) throw std::invalid_argument("nested more than 100 deep");
    return !keep || keep(depth, event, value);
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

json value_json(const MachineKind& value) {
  return {{"cpu", value.cpu},
          {"cores", value.cores},
          {"renderer", value.renderer},
          {"software", value.software},
          {"timer", value_json(value.timer)}};
}

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

json value_json(const GpuEstimateRecord& value) {
  json parts = {{"lookup", value.lookup_us},
                {"prefilter", value.prefilter_us},
                {"arithmetic", value.arithmetic_us},
                {"sampling", value.sampling_us},
                {"memory", nullptr}};
  if (value.memory_us) parts["memory"] = *value.memory_us;
  return parts;
}

json value_json(const GpuRecords& value) {
  json result = json::object();
  for (const auto& [name, gpu] : value) {
    json& written = result[name] = {{"facts", json::array()},
                                    {"estimate_us", nullptr},
                                    {"parts_us", nullptr},
                                    {"bound_by", nullptr},
                                    {"refused", nullptr}};
    for (const GpuPassRecord& pass : gpu.facts) {
      json facts = {{"pass", pass.pass}, {"draws", pass.draws}};
      visit_facts(pass.facts, [&](const char* key, int count) { facts[key] = count; });
      written["facts"].push_back(std::move(facts));
    }
    if (!gpu.refused.empty()) written["refused"] = gpu.refused;
    if (!gpu.estimate) continue;
    written["estimate_us"] = gpu.estimate->total_us;
    written["parts_us"] = value_json(*gpu.estimate);
    written["bound_by"] = gpu.estimate->bound_by;
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
MachineKind read_value(const json& json) {
  return {read_value<std::string>(json.at("cpu")), read_value<int>(json.at("cores")),
          read_value<std::string>(json.at("renderer")), read_value<bool>(json.at("software")),
          read_value<TimerKind>(json.at("timer"))};
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

GpuEstimateRecord read_estimate(const json& gpu) {
  const json& parts = gpu.at("parts_us");
  GpuEstimateRecord estimate;
  estimate.total_us = read_value<double>(gpu.at("estimate_us"));
  estimate.lookup_us = read_value<double>(parts.at("lookup"));
  estimate.prefilter_us = read_value<double>(parts.at("prefilter"));
  estimate.arithmetic_us = read_value<double>(parts.at("arithmetic"));
  estimate.sampling_us = read_value<double>(parts.at("sampling"));
  if (!parts.at("memory").is_null()) estimate.memory_us = read_value<double>(parts.at("memory"));
  estimate.bound_by = read_value<std::string>(gpu.at("bound_by"));
  return estimate;
}

template <>
GpuRecords read_value(const json& json) {
  require(json.is_object(), "an object");
  GpuRecords records;
  for (const auto& [name, gpu] : json.items()) {
    GpuRecord& record = records[name];
    require(gpu.at("facts").is_array(), "an array");
    for (const auto& each : gpu.at("facts")) {
      GpuPassRecord pass{read_value<std::string>(each.at("pass")), read_value<int>(each.at("draws")), {}};
      visit_facts(pass.facts, [&](const char* key, int& count) { count = read_value<int>(each.at(key)); });
      record.facts.push_back(std::move(pass));
    }
    if (!gpu.at("refused").is_null()) record.refused = read_value<std::string>(gpu.at("refused"));
    if (!gpu.at("estimate_us").is_null()) record.estimate = read_estimate(gpu);
  }
  return records;
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
