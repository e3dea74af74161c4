#include "report/records/bias_record.h"

#include <fmt/format.h>

#include "base/files.h"
#include "report/records/csv_tables.h"
#include "report/records/json_values.h"

namespace shadowbench::records {
namespace {

constexpr const char* kBiasSchema = "shadowbench bias 3";

}  // namespace

void visit_fields(Is<BiasCell> auto& cell, auto&& visit) {
  visit("scene", cell.scene);
  visit("light", cell.light);
  visit("view", cell.view);
  visit("map_size", cell.map_size);
  visit("fit", cell.fit);
  visit("label", cell.filter);
  visit("filter", cell.id);
  visit("params", cell.params);
  visit("bias", cell.bias);
  visit("acne", cell.acne);
  visit("contact_gap", cell.contact_gap);
}

std::string make_bias_csv(const std::vector<BiasSweepRecord>& sweeps) {
  const auto write = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string();
  };
  TextTable table{{"scene", "view", "map_size", "mode", "key", "filter", "factor", "setting", "lift_depth",
                   "lift_texels", "lift_m", "acne", "contact_gap"},
                  {}};
  for (const BiasSweepRecord& sweep : sweeps)
    for (const BiasCell& cell : sweep.cells)
      table.rows.push_back({cell.scene, cell.view, fmt::to_string(cell.map_size), cell.mode, cell.key, cell.filter,
                            write(cell.factor), write(cell.setting), write(cell.lift_depth), write(cell.lift_texels),
                            write(cell.lift_m), write(cell.acne), write(cell.contact_gap)});
  return make_csv(table);
}

std::string make_bias_json(const std::vector<BiasCell>& recommended) {
  return dump_file({{"schema", kBiasSchema}, {"bias_to_ship", value_json(recommended)}});
}

std::vector<BiasCell> read_recommended_biases(const std::filesystem::path& report, std::vector<std::string>& warnings) {
  const std::filesystem::path file = report / "bias" / "bias.json";
  if (std::error_code ignored; !std::filesystem::is_regular_file(file, ignored)) return {};
  try {
    const nlohmann::json written = read_json_file(file, 64 * kMebibyte, "");
    require(written.at("schema") == kBiasSchema, fmt::format("the schema \"{}\"", kBiasSchema));
    return read_value<std::vector<BiasCell>>(written.at("bias_to_ship"));
  } catch (const std::exception&) {
    warnings.push_back(fmt::format("{}: not what 'bias' writes, and left out; sweep the bias again", file.string()));
    return {};
  }
}

}  // namespace shadowbench::records
