#include "filters/filter_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace shadowbench::filters {
namespace {

double find_reach(const std::variant<double, std::string>& half_width, const ParamValues& values) {
  constexpr double kOwnTexel = 0.5, kReconstruction = 1.0;
  const double taps = number_or_param(half_width, values);
  const bool is_whole = std::holds_alternative<double>(half_width);
  return std::max(is_whole ? taps : taps + kReconstruction, kOwnTexel);
}

}  // namespace

const ParamSpec* FilterSpec::find_param(const std::string& name) const {
  const auto found = std::ranges::find(params, name, &ParamSpec::name);
  return found == params.end() ? nullptr : &*found;
}

Ends ends_of(const ParamSpec& param) {
  if (param.choices.empty()) return {*param.min, *param.max};
  Ends ends{std::get<double>(param.choices.front()), std::get<double>(param.choices.front())};
  for (const ParamValue& choice : param.choices) {
    ends.smallest = std::min(ends.smallest, std::get<double>(choice));
    ends.largest = std::max(ends.largest, std::get<double>(choice));
  }
  return ends;
}

std::string to_string(const ParamValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return fmt::format("{}", std::get<double>(value));
}

double number(const ParamValues& values, const std::string& name) {
  const auto found = values.find(name);
  assert(found != values.end());
  return std::get<double>(found->second);
}

double number_or_param(const std::variant<double, std::string>& value, const ParamValues& values) {
  if (const auto* name = std::get_if<std::string>(&value)) return number(values, *name);
  return std::get<double>(value);
}

std::string text_or(const ParamValues& values, const std::string& name, const std::string& fallback) {
  const auto found = values.find(name);
  return found == values.end() ? fallback : to_string(found->second);
}

double radius_texels(const FilterSpec& spec, const ParamValues& values) {
  return number_or_param(spec.radius_texels, values);
}

bool promises_bound(const FilterSpec& spec, const ParamValues& values) {
  return spec.kind == FilterKind::kBound && (spec.bound_at_zero.empty() || number(values, spec.bound_at_zero) == 0.0);
}

double reach_texels(const FilterSpec& spec, const ParamValues& values) {
  return find_reach(spec.radius_texels, values);
}

double bias_reach_texels(const FilterSpec& spec, const ParamValues& values) {
  return find_reach(spec.bias_texels, values);
}

bool combines_logs(const ParamValues& values) { return text_or(values, "combine", "linear") == "log"; }

bool reads_nearest(const ParamValues& values) {
  return combines_logs(values) || text_or(values, "sample", "linear") == "nearest";
}

std::vector<ScreenSpec> list_screens(const FilterSpec& spec, const ParamValues& values) {
  std::vector<ScreenSpec> screens = spec.screens;
  if (spec.find_param("screen"))
    std::erase_if(screens, [&](const ScreenSpec& each) { return each.name != text_or(values, "screen", ""); });
  return screens;
}

int reach_pixels(const ScreenSpec& screen, const ParamValues& values) {
  return static_cast<int>(number_or_param(screen.reach, values));
}

int depth_samples(const ParamValues& values) {
  return values.contains("samples") ? static_cast<int>(number(values, "samples")) : 1;
}

int prefilter_radius_texels(const FilterSpec& spec, const ParamValues& values) {
  return spec.has_prefilter ? static_cast<int>(radius_texels(spec, values)) : 0;
}

}  // namespace shadowbench::filters
