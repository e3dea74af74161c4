#include "report/records/json_values.h"

#include <cmath>

namespace shadowbench::records {

using nlohmann::json;

namespace {

constexpr int kDeepest = 100;

void require_shallow(int depth) {
  if (depth > kDeepest) throw std::invalid_argument("nested more than 100 deep");
}

void check_depth(const json& value, int depth = 0) {
  if (!value.is_structured()) return;
  require_shallow(depth);
  for (const json& each : value) check_depth(each, depth + 1);
}

}  // namespace

json parse_json(std::istream& stream, const json::parser_callback_t& keep) {
  if (keep) {
    return json::parse(
        stream,
        [&](int depth, json::parse_event_t event, json& value) {
          require_shallow(depth);
          return keep(depth, event, value);
        });
  }
  // With a callback, the parser goes through all that an object holds whenever one of its members ends.
  json value = json::parse(stream);
  check_depth(value);
  return value;
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
