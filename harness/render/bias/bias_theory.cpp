#include "harness/render/bias/bias_theory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace shadowbench::render {
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
