#include "harness/scene/lights/fit_rule.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <iterator>

#include "base/error.h"
#include "base/split_list.h"

namespace shadowbench::scene {
namespace {

constexpr std::array<std::string_view, 10> kFitNames = {"sphere", "tight", "view",   "cascades",  "focused", "lispsm",
                                                        "psm",    "tsm",   "logpsm", "paraboloid"};  // as FitMode

constexpr int kMostCascades = 4;
constexpr double kLeastMetres = 1e-3, kMostMetres = 1e6;

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::kUsage, "--fit: " + message); }

double read_number(std::string_view key, std::string_view text, double least, double most, const char* words = "") {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && number >= least && number <= most) return number;
  refuse(fmt::format("{} is '{}' and must be {} .. {}{}", key, text, least, most, words));
}

double read_split(std::string_view text) {
  if (text == "uniform") return 0.0;
  if (text == "practical") return 0.5;
  if (text == "logarithmic") return 1.0;
  return read_number("split", text, 0.0, 1.0, ", or uniform (0), practical (0.5) or logarithmic (1)");
}

double read_metres(std::string_view key, std::string_view text) {
  return read_number(key, text, kLeastMetres, kMostMetres, " metres");
}

std::vector<double> read_splits(std::string_view text) {
  std::vector<double> splits;
  for (const std::string& each : split_list(std::string(text), "/")) splits.push_back(read_metres("splits", each));
  if (splits.empty() || splits.size() + 1 > kMostCascades)
    refuse(
        fmt::format("splits is '{}' and must be 1 to {} depths in metres, as in splits=5/20", text, kMostCascades - 1));
  return splits;
}

void set_key(CascadeRule& rule, std::string_view key, std::string_view value) {
  if (key == "count") {
    const double count = read_number(key, value, 2.0, kMostCascades);
    rule.count = static_cast<int>(count);
    if (rule.count != count) refuse(fmt::format("count is '{}' and must be a whole number", value));
  } else if (key == "split") {
    rule.split = read_split(value);
  } else if (key == "splits") {
    rule.splits = read_splits(value);
  } else if (key == "near") {
    rule.near_m = read_metres(key, value);
  } else if (key == "far") {
    rule.far_m = read_metres(key, value);
  } else if (key == "blend") {
    rule.blend = read_number(key, value, 0.0, 0.5);
  } else if (key == "depths") {
    if (value != "all" && value != "seen") refuse(fmt::format("depths is '{}' and must be all or seen", value));
    rule.seen = value == "seen";
  } else {
    refuse(
        fmt::format("cascades have no '{}'; they have count, split, splits, near, far, blend and depths, e.g. "
                    "cascades:count=3,split=logarithmic or cascades:splits=5/20,far=80",
                    key));
  }
}

void require_ascent(const CascadeRule& rule) {
  std::vector<double> depths = rule.splits;
  if (rule.near_m > 0.0) depths.insert(depths.begin(), rule.near_m);
  if (rule.far_m > 0.0) depths.push_back(rule.far_m);
  const auto fall = std::ranges::adjacent_find(depths, std::greater_equal());
  if (fall != depths.end())
    refuse(fmt::format("{} m follows {} m: near, splits and far must ascend", *std::next(fall), *fall));
}

/// Holds splits in metres against the keys that say how many slices there are, and in which ratio.
void take_splits(CascadeRule& rule, const std::set<std::string>& keys) {
  if (keys.contains("split")) refuse("split and splits are both given: splits are metres, and leave nothing to split");
  const int count = static_cast<int>(rule.splits.size()) + 1;
  if (keys.contains("count") && rule.count != count)
    refuse(fmt::format("{} splits make {} cascades, not {}: leave count out", count - 1, count, rule.count));
  rule.count = count;
}

CascadeRule parse_cascades(std::string_view text) {
  CascadeRule rule;
  std::set<std::string> keys;
  for (const auto& [key, value] : split_assignments(text, "--fit")) {
    set_key(rule, key, value);
    keys.insert(key);
  }
  if (!rule.splits.empty()) take_splits(rule, keys);
  require_ascent(rule);
  return rule;
}

}  // namespace

std::vector<std::string> list_fit_names() { return {kFitNames.begin(), kFitNames.end()}; }

std::string_view name_of(FitMode mode) { return kFitNames[static_cast<std::size_t>(mode)]; }

std::string describe_fit(const FitRule& rule) {
  if (rule.mode != FitMode::kCascades) return std::string(name_of(rule.mode));
  const CascadeRule& cascades = rule.cascades;
  const std::string split = cascades.splits.empty() ? fmt::format("split={}", cascades.split)
                                                    : fmt::format("splits={}", fmt::join(cascades.splits, "/"));
  std::string text = fmt::format("cascades:count={},{},blend={},depths={}", cascades.count, split, cascades.blend,
                                 cascades.seen ? "seen" : "all");
  if (cascades.near_m > 0.0) text += fmt::format(",near={}", cascades.near_m);
  if (cascades.far_m > 0.0) text += fmt::format(",far={}", cascades.far_m);
  return text;
}

std::set<std::string> describe_fits(const std::vector<FitRule>& rules) {
  std::set<std::string> all;
  for (const FitRule& rule : rules) all.insert(describe_fit(rule));
  return all;
}

FitRule parse_fit_rule(std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  const auto found = std::find(kFitNames.begin(), kFitNames.end(), name);
  if (found == kFitNames.end()) refuse(fmt::format("unknown fit '{}'; there are {}", name, fmt::join(kFitNames, ", ")));
  FitRule rule{static_cast<FitMode>(found - kFitNames.begin()), {}};
  if (name.size() == text.size()) return rule;
  if (rule.mode != FitMode::kCascades) refuse(fmt::format("'{}' takes no values; only cascades do", name));
  rule.cascades = parse_cascades(text.substr(name.size() + 1));
  return rule;
}

}  // namespace shadowbench::scene
