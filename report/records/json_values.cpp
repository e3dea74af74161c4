#include "report/records/json_values.h"

#include <cmath>

namespace shadowbench::records {

using nlohmann::json;

json parse_json(std::istream& stream, const json::parser_callback_t& keep) {
  constexpr int kDeepest = 100;
  return json::parse(stream, [&](int depth, json::parse_event_t event, json& value) {
    if (depth > kDeepest) throw std::invalid_argument("nested more than 100 deep");
    return !keep || keep(depth, event, value);
  });
}

json number_json(double value) {
  constexpr double kLargestExactInteger = 9007199254740992.0;  // 2^53
  if (std::nearbyint(value) == value && std::abs(value) <= kLargestExactInteger)
    return static_cast<std::int64_t>(value);
  return value;
}

std::string dump_line(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

std::string dump_file(const json& value) { return value.dump(1, ' ', false, json::error_handler_t::replace) + "\n"; }

json::json_pointer make_pointer(std::string path) {
  std::replace(path.begin(), path.end(), '.', '/');
  return json::json_pointer("/" + path);
}

}  // namespace shadowbench::records
