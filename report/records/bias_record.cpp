#include "report/records/bias_record.h"

#include <fmt/format.h>

#include <fstream>

#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

constexpr const char* kBiasSchema = "shadowbench bias 2";

}  // namespace

void visit_fields(Is<BiasToShip> auto& ship, auto&& visit) {
  visit("scene", ship.scene);
  visit("light", ship.light);
  visit("map_size", ship.map_size);
  visit("fit", ship.fit);
  visit("label", ship.filter);
  visit("filter", ship.id);
  visit("params", ship.params);
  visit("bias", ship.bias);
  visit("contact_gap", ship.contact_gap);
}

std::string make_bias_json(const std::vector<BiasToShip>& ships) {
  return dump_file({{"schema", kBiasSchema}, {"bias_to_ship", value_json(ships)}});
}

std::vector<BiasToShip> list_bias_to_ship(const std::filesystem::path& report, std::vector<std::string>& warnings) {
  const std::filesystem::path file = report / "bias" / "bias.json";
  std::ifstream stream;
  if (std::error_code ignored; std::filesystem::is_regular_file(file, ignored)) stream.open(file, std::ios::binary);
  if (!stream.is_open()) return {};
  try {
    const nlohmann::json written = parse_json(stream);
    require(written.at("schema") == kBiasSchema, fmt::format("the schema \"{}\"", kBiasSchema));
    return read_value<std::vector<BiasToShip>>(written.at("bias_to_ship"));
  } catch (const std::exception&) {
    warnings.push_back(fmt::format("{}: not what 'bias' writes, and left out; sweep the bias again", file.string()));
    return {};
  }
}

}  // namespace shadowbench::records
