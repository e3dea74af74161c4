#include "report/records/cell_key.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "filters/kernel.h"
#include "report/files/file_name.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

using nlohmann::json;

json canonical(const json& value) {
  if (value.is_number_float()) return number_json(value.get<double>());
  json result = value;
  if (result.is_structured())
    for (json& child : result) child = canonical(child);
  return result;
}

}  // namespace

ParamMap named_params(const CellRecord& cell) {
  ParamMap params = cell.params;
  if (cell.kernel.by_light) params[*cell.kernel.by_light] = std::string(filters::kLightWidth);
  return params;
}

json cell_settings(const CellRecord& cell) {
  return canonical({{"scene", cell.scene},
                    {"view", cell.view},
                    {"filter", cell.filter},
                    {"params", value_json(named_params(cell))},
                    {"map_size", cell.map_size},
                    {"map_format", cell.map_format},
                    {"bias", value_json(cell.bias)},
                    {"size", {cell.width, cell.height}},
                    {"fit", cell.fit},
                    {"light", cell.light},
                    {"range", {cell.range.border, cell.range.far_test, cell.range.behind_test}}});
}

std::string cell_key(const json& settings) {
  return fmt::format("{:016x}", files::hash_text(dump_line(canonical(settings))));
}

std::string cell_key(const CellRecord& cell) {
  json settings = cell_settings(cell);
  if (cell.external) settings["external"] = true;
  return cell_key(settings);
}

bool is_cell_key(std::string_view text) {
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return text.size() == 16 && std::all_of(text.begin(), text.end(), is_digit);
}

}  // namespace shadowbench::records
