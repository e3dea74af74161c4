#include "harness/render/bias.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <ranges>
#include <tuple>

#include "base/error.h"
#include "base/text.h"

namespace shadowbench::render {
namespace {

/// The amounts of a part of the bias, one for each unit.
template <BiasAmount records::BiasRecord::*kPart>
std::map<std::string, BiasMode::Target> list_units() {
  return {{"depth", [](BiasRule& r) -> double& { return (r.*kPart).depth; }},
          {"texels", [](BiasRule& r) -> double& { return (r.*kPart).texels; }},
          {"world", [](BiasRule& r) -> double& { return (r.*kPart).world; }}};
}

/// The tangent of 89.99 degrees.
constexpr double kAnySlope = 5730.0;

/// The slack that rounding needs, unless the user gives one.
constexpr double kRoundingDepth = 2e-5;

std::vector<BiasMode> make_modes() {
  using Record = records::BiasRecord;
  const auto depth = [](const BiasTheory& t) { return t.depth(); };
  const auto slack = [](const BiasTheory&) { return BiasRule().constant.depth; };
  const BiasMode::Target constant_depth = [](BiasRule& r) -> double& { return r.constant.depth; };
  std::map<std::string, BiasMode::Target> lengths = list_units<&Record::normal_offset>();
  lengths.erase("depth");
  return {
      {.name = "none"},
      {.name = "constant",
       .keys = list_units<&Record::constant>(),
       .key = "depth",
       .meaning = "One depth for every receiver.",
       .amount = depth,
       .lift_depth = depth},
      {.name = "slope",
       .keys = list_units<&Record::slope>(),
       .key = "depth",
       .meaning = "An amount times 1 - n.l.",
       .amount = [](const BiasTheory& t) { return t.depth() / (1.0 - t.n_dot_l); },
       .lift_depth = depth},
      {.name = "plane",
       .keys = {{"kernels", [](BiasRule& r) -> double& { return r.plane_kernels; }},
                {"texels", [](BiasRule& r) -> double& { return r.plane_texels; }},
                {"depth", constant_depth}},
       .key = "texels",
       .meaning =
           "The depth that the receiver's own plane gains over so many texels: theory holds at every slope up to 10:1.",
       .amount = [](const BiasTheory& t) { return t.reach_texels; },
       .lift_depth = depth},
      {.name = "normal-offset",
       .keys = lengths,
       .key = "texels",
       .meaning = "The receiver is moved along its normal, by an amount times the sine of its angle to the light.",
       // Moved along the normal by s r sin(theta), a point lies s r tan(theta) above the plane, measured along the
       // light.
       .amount =
           [](const BiasTheory& t) {
             return t.depth() / std::hypot(t.larger_slope, t.slope_per_texel - t.larger_slope);
           },
       .lift_depth = depth},
      {.name = "polygon-offset",
       .keys = {{"factor", [](BiasRule& r) -> double& { return r.map.polygon_factor; }},
                {"units", [](BiasRule& r) -> double& { return r.map.polygon_units; }}},
       .key = "factor",
       .meaning =
           "glPolygonOffset while the map is drawn: an amount times the larger of the caster's two depth slopes.",
       .amount = [](const BiasTheory& t) { return t.depth() / t.larger_slope; },
       .lift_depth = depth},
      {.name = "receiver-plane",
       .keys = {{"depth", constant_depth}},
       .begin = [](BiasRule& r) { r.receiver_plane = true; },
       .key = "depth",
       .meaning =
           "Every tap is compared with the depth of the receiver's plane there; theory asks for no more than the "
           "slack that rounding needs.",
       .amount = slack,
       .lift_depth = slack},
      {.name = "front-cull",
       .keys = {{"depth", constant_depth}},
       .begin = [](BiasRule& r) { r.map.cull_front = true; },
       .meaning = "The map holds the faces turned away from the light, of objects that allow it; with the slack that "
                  "rounding needs."},
      {.name = "midpoint",
       .keys = {{"depth", constant_depth}},
       .begin = [](BiasRule& r) { r.map.midpoint = true; },
       .meaning = "The map holds what lies half-way between the first and the second surface; with the slack that "
                  "rounding needs."}};
}

[[noreturn]] void fail_unknown(const char* what, const std::string& name, std::vector<std::string> known) {
  std::ranges::sort(known);
  const std::string hint = known.empty() ? "; this mode takes none" : did_you_mean_or_known(name, known);
  throw Error(ErrorKind::kUsage, fmt::format("--bias: unknown {} '{}'{}", what, name, hint));
}

double parse_amount(const std::string& text) {
  const std::optional<double> value = parse_number(text);
  if (value && *value >= 0.0) return *value;
  throw Error(ErrorKind::kUsage,
              fmt::format("--bias: '{}' must be a finite number, 0 or more, without a unit: the unit "
                          "is in the key (depth, texels, world)",
                          text));
}

void add(BiasRule& rule, const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string name = text.substr(0, colon);
  const auto mode = std::ranges::find(bias_modes(), name, &BiasMode::name);
  if (mode == bias_modes().end()) {
    const auto names = bias_modes() | std::views::transform(&BiasMode::name);
    fail_unknown("mode", name, {names.begin(), names.end()});
  }
  if (mode->begin) mode->begin(rule);
  std::vector<std::pair<std::string, std::string>> amounts;
  if (colon != std::string::npos) amounts = split_assignments(text.substr(colon + 1), "--bias " + name);
  for (const auto& [key, amount] : amounts) {
    const auto target = mode->keys.find(key);
    const auto keys = std::views::keys(mode->keys);
    if (target == mode->keys.end()) fail_unknown("amount", key, {keys.begin(), keys.end()});
    target->second(rule) += parse_amount(amount);
  }
  if (!amounts.empty()) return;
  if (mode->begin) rule.constant.depth += kRoundingDepth;
  if (mode->needs_amount()) {
    throw Error(ErrorKind::kUsage,
                fmt::format("--bias {}: no amount given, write {}:{}=VALUE", name, name, mode->keys.begin()->first));
  }
}

render::Bias resolve(const BiasRule& rule, const scene::LightFrustum& frustum, double reach_texels) {
  render::Bias bias;
  bias.constant_depth = in_depth(rule.constant, frustum);
  bias.slope_depth = in_depth(rule.slope, frustum);
  bias.plane_texels = rule.plane_texels + rule.plane_kernels * reach_texels;
  bias.plane_kernels = rule.plane_kernels;
  bias.normal_offset_texels = in_world(rule.normal_offset, frustum) / frustum.texel_size_ws;
  bias.receiver_plane = rule.receiver_plane;
  bias.max_tangent = rule.max_tangent;
  return bias;
}

}  // namespace

double in_world(const BiasAmount& amount, const scene::LightFrustum& frustum) {
  return amount.depth * frustum.depth_range_ws + amount.texels * frustum.texel_size_ws + amount.world;
}

double in_depth(const BiasAmount& amount, const scene::LightFrustum& frustum) {
  return amount.depth + (amount.texels * frustum.texel_size_ws + amount.world) / frustum.depth_range_ws;
}

BiasRule BiasRule::none() {
  BiasRule rule;
  rule.constant = {};
  rule.plane_kernels = 0.0;
  return rule;
}

BiasRule parse_bias(const std::vector<std::string>& texts) {
  if (texts.empty()) return {};
  BiasRule rule = BiasRule::none();
  for (const std::string& text : texts) add(rule, text);
  return rule;
}

std::string list_bias_modes() {
  std::vector<std::string> texts;
  for (const BiasMode& mode : bias_modes()) {
    const std::string keys = fmt::format(":{}=X", fmt::join(std::views::keys(mode.keys), "=X,"));
    texts.push_back(mode.name + (mode.begin ? "[" + keys + "]" : mode.needs_amount() ? keys : ""));
  }
  std::ranges::sort(texts);
  return fmt::format("{}", fmt::join(texts, " | "));
}

std::string explain_unusable(const BiasRule& rule, const filters::FilterSpec& spec) {
  if (!rule.receiver_plane || (!spec.has_encode && !spec.uses_samplers)) return {};
  return spec.has_encode ? "reads a prefiltered map, not one depth per tap" : "reads the map's samplers itself";
}

void require_usable(const BiasRule& rule, const filters::FilterSpec& spec) {
  const std::string why = explain_unusable(rule, spec);
  if (why.empty()) return;
  throw Error(ErrorKind::kUsage,
              fmt::format("--bias receiver-plane cannot be used by the filter '{}', which {}; leave that "
                          "filter out of --filters, or choose another bias",
                          spec.id, why));
}

void require_drawable(const BiasRule& rule, const render::MapSettings& map) {
  if (map.curve.is_linear() || (rule.map.polygon_factor == 0.0 && rule.map.polygon_units == 0.0)) return;
  throw Error(
      ErrorKind::kUsage,
      "--bias polygon-offset cannot be drawn with --perspective-depth: the GL would add it to linear depth, before "
      "the map bends it; leave one of the two out");
}

render::Bias resolve_bias(const BiasRule& rule, const scene::LightFrustum& frustum, const filters::FilterSpec& spec,
                          const filters::ParamValues& values) {
  return resolve(rule, frustum, filters::bias_reach_texels(spec, values));
}

render::Bias resolve_comparison_bias(const BiasRule& rule, const scene::LightFrustum& frustum,
                                     const filters::FilterSpec& spec, const filters::ParamValues& values) {
  const double own = filters::bias_reach_texels(spec, values), whole = filters::reach_texels(spec, values);
  if (own >= whole) return resolve(rule, frustum, own);
  render::Bias bias = resolve(rule, frustum, whole);
  bias.max_tangent = kAnySlope;  // the filter itself has no acne on steep planes either
  return bias;
}

BiasTheory make_theory(double reach_texels, const filters::Receiver& receiver) {
  const glm::dvec2 slopes = glm::abs(glm::dvec2(receiver.depth_per_texel));
  return {.reach_texels = reach_texels,
          .slope_per_texel = slopes.x + slopes.y,
          .larger_slope = std::max(slopes.x, slopes.y),
          .n_dot_l = static_cast<double>(receiver.n_dot_l),
          .texel_m = static_cast<double>(receiver.texel_size_ws)};
}

BiasTheory find_theory(const BiasMode& mode, double reach_texels, const std::vector<filters::Receiver>& receivers,
                       double share) {
  struct Need {
    double amount;
    BiasTheory theory;
  };
  std::vector<Need> needs;
  for (const filters::Receiver& receiver : receivers) {
    const BiasTheory theory = make_theory(reach_texels, receiver);
    // A plane that faces the light squarely needs no bias; some modes would compute 0 / 0.
    const bool is_flat = theory.larger_slope == 0.0 || theory.n_dot_l >= 1.0;
    needs.push_back({is_flat ? 0.0 : mode.amount(theory), theory});
  }
  const auto place = needs.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(needs.size() - 1));
  std::nth_element(needs.begin(), place, needs.end(), [](const Need& a, const Need& b) {
    return std::tie(a.amount, a.theory.slope_per_texel) < std::tie(b.amount, b.theory.slope_per_texel);
  });
  return place->theory;
}

BiasRule BiasMode::make_rule(double amount_of_key) const {
  return parse_bias({key.empty() ? name : fmt::format("{}:{}={}", name, key, amount_of_key)});
}

const std::vector<BiasMode>& bias_modes() {
  static const std::vector<BiasMode> modes = make_modes();
  return modes;
}

}  // namespace shadowbench::render
