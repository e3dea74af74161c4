#include "harness/render/bias.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <tuple>

#include "base/error.h"
#include "base/text.h"

namespace shadowbench::render {
namespace {

/// Where a key's amount goes.
using Target = std::function<double&(BiasRule&)>;

/// One mode: what it switches on, and which amounts it takes.
struct Mode {
  std::map<std::string, Target> keys;
  std::function<void(BiasRule&)> begin = [](BiasRule&) {};
  bool needs_amount = true;
};

std::map<std::string, Target> list_units(BiasAmount& (*amount)(BiasRule&)) {
  return {{"depth", [=](BiasRule& r) -> double& { return amount(r).depth; }},
          {"texels", [=](BiasRule& r) -> double& { return amount(r).texels; }},
          {"world", [=](BiasRule& r) -> double& { return amount(r).world; }}};
}

Target constant_depth() {
  return [](BiasRule& r) -> double& { return r.constant.depth; };
}

/// The tangent of 89.99 degrees.
constexpr double kAnySlope = 5730.0;

/// The slack that rounding needs, unless the user gives one.
constexpr double kRoundingDepth = 2e-5;

std::map<std::string, Mode> make_modes() {
  std::map<std::string, Mode> modes;
  modes["none"].needs_amount = false;
  modes["constant"].keys = list_units([](BiasRule& r) -> BiasAmount& { return r.constant; });
  modes["slope"].keys = list_units([](BiasRule& r) -> BiasAmount& { return r.slope; });
  modes["plane"].keys = {{"kernels", [](BiasRule& r) -> double& { return r.plane_kernels; }},
                         {"texels", [](BiasRule& r) -> double& { return r.plane_texels; }},
                         {"depth", constant_depth()}};
  modes["normal-offset"].keys = list_units([](BiasRule& r) -> BiasAmount& { return r.normal_offset; });
  modes["normal-offset"].keys.erase("depth");
  modes["receiver-plane"] = {{{"depth", constant_depth()}}, [](BiasRule& r) { r.receiver_plane = true; }, false};
  modes["polygon-offset"].keys = {{"factor", [](BiasRule& r) -> double& { return r.map.polygon_factor; }},
                                  {"units", [](BiasRule& r) -> double& { return r.map.polygon_units; }}};
  modes["front-cull"] = {{{"depth", constant_depth()}}, [](BiasRule& r) { r.map.cull_front = true; }, false};
  modes["midpoint"] = {{{"depth", constant_depth()}}, [](BiasRule& r) { r.map.midpoint = true; }, false};
  return modes;
}

const std::map<std::string, Mode>& modes() {
  static const std::map<std::string, Mode> table = make_modes();
  return table;
}

template <class Table>
std::vector<std::string> list_names(const Table& table) {
  std::vector<std::string> names;
  for (const auto& [name, value] : table) names.push_back(name);
  return names;
}

template <class Table>
[[noreturn]] void fail_unknown(const char* what, const std::string& name, const Table& table) {
  const std::vector<std::string> known = list_names(table);
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
  const auto found = modes().find(name);
  if (found == modes().end()) fail_unknown("mode", name, modes());
  const Mode& mode = found->second;
  mode.begin(rule);
  std::vector<std::pair<std::string, std::string>> amounts;
  if (colon != std::string::npos) amounts = split_assignments(text.substr(colon + 1), "--bias " + name);
  const bool any = !amounts.empty();
  for (const auto& [key, amount] : amounts) {
    const auto target = mode.keys.find(key);
    if (target == mode.keys.end()) fail_unknown("amount", key, mode.keys);
    target->second(rule) += parse_amount(amount);
  }
  if (!any && mode.needs_amount) {
    throw Error(ErrorKind::kUsage,
                fmt::format("--bias {}: no amount given, write {}:{}=VALUE", name, name, mode.keys.begin()->first));
  }
  const bool has_slack = !mode.needs_amount && mode.keys.contains("depth");
  if (!any && has_slack) rule.constant.depth += kRoundingDepth;
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
  for (const auto& [name, mode] : modes()) {
    const std::vector<std::string> keys = list_names(mode.keys);
    texts.push_back(keys.empty() ? name
                                 : fmt::format("{}{}:{}=X{}", name, mode.needs_amount ? "" : "[",
                                               fmt::join(keys, "=X,"), mode.needs_amount ? "" : "]"));
  }
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

namespace {

std::vector<SweptMode> make_swept_modes() {
  const auto depth = [](const BiasTheory& t) { return t.depth(); };
  const auto slack = [](const BiasTheory&) { return BiasRule().constant.depth; };
  return {
      {"constant", "depth", "One depth for every receiver.", depth, depth},
      {"slope", "depth", "An amount times 1 - n.l.", [](const BiasTheory& t) { return t.depth() / (1.0 - t.n_dot_l); },
       depth},
      {"plane", "texels",
       "The depth that the receiver's own plane gains over so many texels: theory holds at every slope up to 10:1.",
       [](const BiasTheory& t) { return t.reach_texels; }, depth},
      {"normal-offset", "texels",
       "The receiver is moved along its normal, by an amount times the sine of its angle to the light.",
       // Moved along the normal by s r sin(theta), a point lies s r tan(theta) above the plane, measured along the
       // light.
       [](const BiasTheory& t) { return t.depth() / std::hypot(t.larger_slope, t.slope_per_texel - t.larger_slope); },
       depth},
      {"polygon-offset", "factor",
       "glPolygonOffset while the map is drawn: an amount times the larger of the caster's two depth slopes.",
       [](const BiasTheory& t) { return t.depth() / t.larger_slope; }, depth},
      {"receiver-plane", "depth",
       "Every tap is compared with the depth of the receiver's plane there; theory asks for no more than the slack "
       "that rounding needs.",
       slack, slack},
      {"front-cull",
       "",
       "The map holds the faces turned away from the light, of objects that allow it; with the slack that rounding "
       "needs.",
       {},
       {}},
      {"midpoint",
       "",
       "The map holds what lies half-way between the first and the second surface; with the slack that rounding needs.",
       {},
       {}}};
}

}  // namespace

BiasTheory make_theory(double reach_texels, const filters::Receiver& receiver) {
  const glm::dvec2 slopes = glm::abs(glm::dvec2(receiver.depth_per_texel));
  return {.reach_texels = reach_texels,
          .slope_per_texel = slopes.x + slopes.y,
          .larger_slope = std::max(slopes.x, slopes.y),
          .n_dot_l = static_cast<double>(receiver.n_dot_l),
          .texel_m = static_cast<double>(receiver.texel_size_ws)};
}

BiasTheory find_theory(const SweptMode& mode, double reach_texels, const std::vector<filters::Receiver>& receivers,
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

BiasRule SweptMode::make_rule(double amount_of_key) const {
  return parse_bias({key.empty() ? name : fmt::format("{}:{}={}", name, key, amount_of_key)});
}

const std::vector<SweptMode>& swept_modes() {
  static const std::vector<SweptMode> modes = make_swept_modes();
  return modes;
}

}  // namespace shadowbench::render
