#include "harness/run/bias_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "filters/error.h"
#include "filters/nearest_name.h"

namespace shadowbench::run {
namespace {

using Amount = double BiasRule::*;

/// Which amounts each mode takes.
const std::map<std::string, std::map<std::string, Amount>>& modes() {
  static const std::map<std::string, std::map<std::string, Amount>> table = {
      {"none", {}},
      {"constant", {{"depth", &BiasRule::constant_depth}}},
      {"slope",
       {{"kernels", &BiasRule::slope_kernels}, {"texels", &BiasRule::slope_texels}, {"depth", &BiasRule::constant_depth}}},
      {"normal-offset", {{"texels", &BiasRule::normal_offset_texels}}}};
  return table;
}

template <class Table>
[[noreturn]] void fail_unknown(const char* what, const std::string& name, const Table& table) {
  std::vector<std::string> known;
  for (const auto& [key, value] : table) known.push_back(key);
  const auto near = nearest_name(name, known);
  std::string list;
  for (const std::string& key : known) list += (list.empty() ? "" : ", ") + key;
  throw Error(ErrorKind::kUsage, fmt::format("--bias: unknown {} '{}'{}", what, name,
                                             near ? fmt::format("; did you mean '{}'?", *near) : "; known: " + list));
}

double parse_amount(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value) || value < 0.0) {
    throw Error(ErrorKind::kUsage, fmt::format("--bias: '{}' must be a finite number, 0 or more", text));
  }
  return value;
}

void add(BiasRule& rule, const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string mode = text.substr(0, colon);
  const auto found = modes().find(mode);
  if (found == modes().end()) fail_unknown("mode", mode, modes());
  std::stringstream assignments(colon == std::string::npos ? std::string() : text.substr(colon + 1));
  bool any = false;
  for (std::string item; std::getline(assignments, item, ','); any = true) {
    const std::size_t equals = item.find('=');
    const std::string key = item.substr(0, equals);
    const auto amount = found->second.find(key);
    if (amount == found->second.end() || equals == std::string::npos) fail_unknown("amount", key, found->second);
    rule.*(amount->second) += parse_amount(item.substr(equals + 1));
  }
  if (!any && !found->second.empty()) {
    throw Error(ErrorKind::kUsage, fmt::format("--bias {}: no amount given, write {}:{}=VALUE", mode, mode,
                                               found->second.begin()->first));
  }
}

render::Bias resolve_bias(const BiasRule& rule, double half_width_texels) {
  render::Bias bias;
  bias.constant_depth = rule.constant_depth;
  bias.slope_texels = rule.slope_texels + rule.slope_kernels * (half_width_texels + 1.0);
  bias.normal_offset_texels = rule.normal_offset_texels;
  return bias;
}

}  // namespace

BiasRule parse_bias(const std::vector<std::string>& texts) {
  if (texts.empty()) return {};
  BiasRule rule{0.0, 0.0, 0.0, 0.0};
  for (const std::string& text : texts) add(rule, text);
  return rule;
}

render::Bias resolve_bias(const BiasRule& rule, const filters::FilterSpec& spec, const filters::ParamValues& values) {
  return resolve_bias(rule, filters::bias_texels(spec, values));
}

render::Bias resolve_comparison_bias(const BiasRule& rule, const filters::FilterSpec& spec,
                                     const filters::ParamValues& values) {
  return resolve_bias(rule, std::max(filters::bias_texels(spec, values), filters::radius_texels(spec, values)));
}

}  // namespace shadowbench::run
