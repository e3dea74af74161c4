#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace light_bleeding {

constexpr double kBound = 0.1;  // of visibility, where truth is 0
constexpr double kLit = 0.9;
constexpr double kFirstGap = 0.1;  // of the depth range
constexpr double kReceiver = 0.95;
constexpr records::StressRange kRange{1e-4, 8.0};

/// The visibility that a filter has by its own formula; `visibility` is null where no formula is known.
struct ClosedForm {
  std::function<double(const LayerStack&, const std::vector<double>&)> visibility;
  std::string formula;
  std::string source;
};

/// Finds a filter's formula from what its map holds, as its front matter declares it.
ClosedForm find_closed_form(const filters::FilterRequest& request) {
  const filters::FilterSpec& spec = request.spec;
  if (spec.holds_moments && !spec.exponent.empty())
    return {};  // moments of a warp: as many formulas as there are warps
  if (spec.holds_moments)
    return {find_chebyshev, "s2 / (s2 + (t - mu)^2)",
            "Donnelly and Lauritzen 2006, Variance Shadow Maps, I3D, eq. 5 (Chebyshev)"};
  if (spec.exponent.empty()) return {};
  const double c = filters::number(request.values, spec.exponent);
  return {
      [c](const LayerStack& stack, const std::vector<double>& shares) { return find_exponential(stack, shares, c); },
      fmt::format("mean of exp(-{:g} (t - z))", c),
      "Annen et al. 2008, Exponential Shadow Maps, Graphics Interface, eq. 5"};
}

LayerStack make_stack(int occluders, double ratio) { return make_layer_stack(occluders, kFirstGap, ratio, kReceiver); }

/// The most that any receiver's kernel lets through.
double find_largest(const ClosedForm& form, const LayerScene& layers, const LayerStack& stack) {
  double largest = 0.0;
  for (const std::vector<double>& shares : layers.shares) largest = std::max(largest, form.visibility(stack, shares));
  return largest;
}

/// Finds the gap ratio at which the closed form, which falls as the gap grows, crosses the bound.
Theory make_theory(const ClosedForm& form, int radius, int occluders) {
  constexpr int kHalvings = 60;
  Theory theory{std::nullopt, TheoryKind::kSlope, fmt::format("{} = {:g}", form.formula, kBound), form.source,
                Verdict::kDegraded};
  const LayerScene layers = make_layer_scene(radius, make_stack(occluders, 1.0));  // whose shares hold for all ratios
  double low = 1e-9, high = 100.0;
  const auto bleeds = [&](double ratio) { return find_largest(form, layers, make_stack(occluders, ratio)) > kBound; };
  if (!bleeds(low)) {
    theory.formula = fmt::format("none: {} stays below {:g}", form.formula, kBound);
    return theory;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (bleeds(middle) ? low : high) = middle;
  }
  theory.onset = low;
  return theory;
}

Observation judge_bleeding(const LookupResult& seen) {
  if (seen.broken_texels > 0)
    return {Verdict::kBroken, std::nullopt, fmt::format("{} texels of the map overflowed", seen.broken_texels)};
  if (!std::ranges::all_of(seen.visibility, [](double v) { return std::isfinite(v); }))
    return {Verdict::kBroken, std::nullopt, "visibility is NaN or infinite"};
  const double largest = *std::ranges::max_element(seen.visibility);
  return judge_by_bounds(largest, kBound, kLit, [&](double bound) {
    return fmt::format("visibility {:.3g} where nothing is lit, over {:g}", largest, bound);
  });
}

/// Explains a filter whose exact arithmetic says the same as what was drawn: it does not follow the formula, and is not
/// wrong by rounding.
std::string explain_by_model(const Disagreement& missed, const SyntheticLookup& exact,
                             const filters::FilterRequest& request, int occluders) {
  if (std::string words = explain_broken_throughout(missed); !words.empty()) return words;
  if (!missed.measured && !missed.theory.onset) return {};
  const double ratio = missed.measured ? *missed.measured : *missed.theory.onset;
  const LayerScene layers =
      make_layer_scene(filters::prefilter_radius_texels(request.spec, request.values), make_stack(occluders, ratio));
  const std::vector<double> visibility = exact(layers.scene, request.values).visibility;
  const double largest = *std::ranges::max_element(visibility);
  if (missed.measured ? std::abs(largest / kBound - 1.0) > 0.1 : largest > kBound) return {};
  return fmt::format(
      "the filter's model in extended precision lets {:.3f} through at {:.4g} as well: with {} it is not the plain "
      "formula",
      largest, ratio,
      request.set_by_user.empty() ? "its defaults"
                                  : fmt::format("the chosen {}", fmt::join(request.set_by_user, ", ")));
}

Case make_case(const AxisInputs& inputs, const filters::FilterRequest& request, int occluders, Level level) {
  Case item = start_case(inputs, request, fmt::format("{} occluders", occluders), level);
  if (!item.is_available()) return item;
  const int radius = filters::prefilter_radius_texels(request.spec, request.values);
  const ClosedForm form = find_closed_form(request);
  if (form.visibility) item.theories = {make_theory(form, radius, occluders)};
  item.explain = [exact = make_model_lookup(inputs, request, filters::Precision::kExtended), request, occluders](
                     const Disagreement& missed) { return explain_by_model(missed, exact, request, occluders); };
  item.observe = [lookup = make_lookup(inputs, request, level), values = request.values, radius,
                  occluders](double ratio) {
    return judge_bleeding(lookup(make_layer_scene(radius, make_stack(occluders, ratio)).scene, values));
  };
  return item;
}

std::vector<int> list_occluders(const filters::FilterRequest& request) {
  const bool bleeds = request.spec.kind == filters::FilterKind::kBound && request.spec.has_encode;
  return bleeds ? std::vector{2, 4, 8, 16} : std::vector<int>();
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  return make_filter_cases(inputs, list_occluders, make_case, "no chosen filter of kind bound encodes its map");
}

}  // namespace light_bleeding

Axis make_light_bleeding_axis() {
  using namespace light_bleeding;
  Axis axis;
  axis.title = "Light bleeding behind stacked occluders";
  axis.quantity = "gap between the last occluder and the receiver / gap between the first and the last occluder";
  axis.range = kRange;
  axis.limits = {1e-7, kReceiver / kFirstGap - 1.0};
  axis.coarse_samples = 25;
  axis.from = SearchFrom::kHigh;
  axis.measured = "largest visibility of receivers that are wholly blocked";
  axis.bound = kBound;
  axis.broken_when = fmt::format("texels of the map overflowed, or visibility is not finite or over {:g}", kLit);
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
