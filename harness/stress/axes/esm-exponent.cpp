#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "filters/store_format.h"
#include "harness/stress/axis.h"
#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace esm_exponent {

constexpr float kOccluder = 0.3f;  // of the largest depth
constexpr const char* kSource = "derived: exp(c z) must stay below the largest finite number (IEEE 754)";

/// What is varied besides the exponent.
struct Setting {
  std::string store;
  std::string combine;  ///< empty: the filter has no choice
  int radius = 0;
  float largest_depth = 1.0f;
};

bool is_log(const Setting& setting) { return setting.combine == "log"; }

double largest_number(const std::string& store) { return filters::largest_number(filters::store_precision(store)); }

double unit_roundoff(const std::string& store) {
  return filters::store_precision(store) == filters::StorePrecision::kHalf ? 0x1p-11 : 0x1p-24;
}

/// The deepest depth that is encoded. A blur on the GL also encodes the border, whose depth is 1 whatever the map
/// holds; a model looks up only what its receivers reach.
double find_deepest(const Setting& setting, Level level) {
  return level == Level::kGl && setting.radius > 0 ? 1.0 : static_cast<double>(setting.largest_depth);
}

Theory make_overflow(const Setting& setting, Level level) {
  Theory theory{std::nullopt, TheoryKind::kOverflow, "none: the map holds c z, never exp(c z)", kSource,
                Verdict::kBroken};
  if (is_log(setting)) return theory;
  const double deepest = find_deepest(setting, level), largest = largest_number(setting.store);
  theory.onset = std::log(largest) / deepest;
  theory.formula = fmt::format("ln({:.5g}) / {:g}{}", largest, deepest,
                               deepest > static_cast<double>(setting.largest_depth) ? ", the border's depth" : "");
  return theory;
}

/// A stored c z is off by c z times the unit round-off, and so is the logarithm of visibility.
Theory make_rounding(const Setting& setting) {
  const double z = static_cast<double>(setting.largest_depth);
  return {kVisibleError / (unit_roundoff(setting.store) * z), TheoryKind::kRounding,
          fmt::format("{:g} / ({:.3g} x {:g}): where c z is rounded by as much as visibility may be off", kVisibleError,
                      unit_roundoff(setting.store), z),
          "derived: d ln V = c z u", Verdict::kDegraded};
}

/// Annen et al. 2008, eq. 5, of a kernel that holds two depths: exact where every exponent is a difference.
std::vector<double> expect_visibility(const EdgeScene& edge, const Setting& setting, double c) {
  const double z = static_cast<double>(setting.largest_depth);
  const double leak = std::exp(-static_cast<double>(static_cast<float>(c)) *
                               (z - static_cast<double>(kOccluder * setting.largest_depth)));
  std::vector<double> visibility;
  for (const double share : edge.lit_share) visibility.push_back(share + (1.0 - share) * leak);
  return visibility;
}

std::string name(const Setting& setting) {
  return fmt::format("{}{}{}, depths to {:g}{}", setting.store, setting.combine.empty() ? "" : ", ", setting.combine,
                     setting.largest_depth, setting.radius == 0 ? ", no blur" : "");
}

Case make_case(const AxisInputs& inputs, filters::FilterRequest request, const Setting& setting, Level level) {
  request.values["store"] = setting.store;
  if (!setting.combine.empty()) request.values["combine"] = setting.combine;
  request.values["radius"] = static_cast<double>(setting.radius);
  Case item = start_case(inputs, request, name(setting), level);
  if (!item.is_available()) return item;
  const std::string param = find_exponent(request.spec);
  item.params.erase(param);
  item.theories = {make_overflow(setting, level)};
  if (is_log(setting)) item.theories.push_back(make_rounding(setting));
  const EdgeScene edge = make_edge_scene(setting.radius, {{kOccluder * setting.largest_depth, setting.largest_depth}});
  item.observe = [lookup = make_lookup(inputs, request, level), edge, setting, values = request.values,
                  param](double c) mutable {
    values[param] = c;
    return judge(lookup(edge.scene, values), {expect_visibility(edge, setting, c), kVisibleError, edge.run});
  };
  return item;
}

/// Lists each store with the filter's blur and without, where nothing but the map's own depths counts. Maps of
/// logarithms are read with the nearest texel, and have no penumbra without a blur.
std::vector<Setting> list_settings(const filters::FilterRequest& request) {
  if (find_exponent(request.spec).empty()) return {};
  const int radius = filters::prefilter_radius_texels(request.spec, request.values);
  std::vector<std::string> combines = list_choices(request, "combine");
  if (combines.empty()) combines.emplace_back();
  std::vector<Setting> settings;
  for (const std::string& store : list_choices(request, "store")) {
    for (const std::string& combine : combines) {
      const Setting setting{store, combine, radius, 1.0f};
      if (radius > 0 || !is_log(setting)) settings.push_back(setting);
      if (is_log(setting)) continue;
      if (radius > 0) settings.push_back({store, combine, radius, 0.5f});
      settings.push_back({store, combine, 0, 0.5f});
    }
  }
  return settings;
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  return make_filter_cases(inputs, list_settings, make_case,
                           "no chosen filter's front matter declares 'exponent' without 'moments'");
}

}  // namespace esm_exponent

Axis make_esm_exponent_axis() {
  using namespace esm_exponent;
  Axis axis;
  axis.title = "Exponent of exponential shadow maps";
  axis.quantity = "exponent c";
  axis.unit = "1/depth";
  axis.range = {1.0, 2000.0};
  axis.limits = {1.0, 1e6};
  axis.coarse_samples = 34;
  axis.measured = "largest error of visibility across a two-depth edge";
  axis.bound = kVisibleError;
  axis.broken_when =
      "texels of the map overflowed (GL), or visibility is not finite, all lit, all dark, or falls by more than 0.1 "
      "from dark to light";
  axis.driven_param = find_exponent;
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
