#include "report/records/cell_key.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/files.h"
#include "base/text.h"
#include "filters/kernel.h"
#include "report/records/format.h"
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

constexpr std::string_view kSnapped = " snapped";

struct Fit {
  std::string kind;
  std::map<std::string, std::string> options;  // of cascades: "split" to "0.5"
  bool snapped = false;
};

Fit parse_fit(std::string text) {
  Fit fit;
  fit.snapped = text.ends_with(kSnapped);
  if (fit.snapped) text.resize(text.size() - kSnapped.size());
  const std::size_t colon = text.find(':');
  fit.kind = text.substr(0, colon);
  if (colon == std::string::npos) return fit;
  for (auto& [option, value] : split_assignments(text.substr(colon + 1), "fit")) fit.options[option] = value;
  return fit;
}

std::string param_key(const CellRecord& cell, const std::string& name) { return cell.filter + " " + name; }

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
                    {"range", {name_of(cell.range.border), cell.range.far_test, cell.range.behind_test}}});
}

std::string cell_key(const json& settings) { return fmt::format("{:016x}", hash_text(dump_line(canonical(settings)))); }

std::string cell_key(const CellRecord& cell) {
  json settings = cell_settings(cell);
  if (cell.external) settings["external"] = true;
  return cell_key(settings);
}

bool is_cell_key(std::string_view text) {
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return text.size() == 16 && std::all_of(text.begin(), text.end(), is_digit);
}

std::string name_fit(const std::string& fit, const std::set<std::string>& fits) {
  const Fit own = parse_fit(fit);
  const auto count = own.options.find("count");
  std::string name = count == own.options.end() ? own.kind + " fit" : fmt::format("{} {}", count->second, own.kind);
  const auto differs = [&](const auto& read) {
    for (const std::string& each : fits) {
      const Fit other = parse_fit(each);
      if (other.kind == own.kind && read(other) != read(own)) return true;
    }
    return false;
  };
  for (const auto& [option, value] : own.options) {
    const auto read = [&, &option = option](const Fit& each) {
      const auto found = each.options.find(option);
      return found == each.options.end() ? std::string() : found->second;
    };
    if (option != "count" && differs(read)) name += fmt::format(", {} {}", option, value);
  }
  if (own.snapped && differs([](const Fit& each) { return each.snapped; })) name += kSnapped;
  return name;
}

std::string make_fit_stem(const std::string& fit, const std::set<std::string>& fits) {
  std::string stem = name_fit(fit, fits);
  std::erase(stem, ',');
  std::ranges::replace(stem, ' ', '-');
  std::ranges::replace(stem, '/', '+');
  return stem;
}

CellNames::CellNames(const std::vector<const CellRecord*>& cells) {
  for (const CellRecord* cell : cells) fits_.insert(cell->fit);
  for (const CellRecord* cell : cells) {
    for (const auto& [name, value] : named_params(*cell))
      params_[param_key(*cell, name)].insert(describe_params({{name, value}}));
    for (const auto& [name, value] : list_settings(*cell)) values_[name].insert(value);
  }
}

CellNames::Settings CellNames::list_settings(const CellRecord& cell) const {
  return {{"map", fmt::format("map {}", cell.map_size)},
          {"format", cell.map_format},
          {"fit", name_fit(cell.fit, fits_)},
          {"light", cell.light == CellRecord().light ? "light of the scene" : "light at " + cell.light},
          {"picture", fmt::format("picture {} × {}", cell.width, cell.height)},
          {"bias", "bias: " + describe_bias(cell.bias)},
          {"range", describe_range(cell.range)}};
}

std::string CellNames::name_filter(const CellRecord& cell) const {
  ParamMap telling = named_params(cell);
  std::erase_if(telling, [&](const auto& param) {
    const auto values = params_.find(param_key(cell, param.first));
    return values == params_.end() || values->second.size() < 2;
  });
  return telling.empty() ? cell.filter : fmt::format("{} ({})", cell.filter, describe_params(telling));
}

std::string CellNames::name(const CellRecord& cell) const {
  std::string text = name_filter(cell);
  for (const auto& [name, value] : list_settings(cell)) {
    const auto values = values_.find(name);
    if (values != values_.end() && values->second.size() > 1 && !value.empty()) text += ", " + value;
  }
  return text;
}

}  // namespace shadowbench::records
