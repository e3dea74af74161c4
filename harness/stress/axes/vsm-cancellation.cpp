#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "filters/encoded_map.h"
#include "filters/store_format.h"
#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace vsm_cancellation {

constexpr int kBands = 12;    // depths at which a gap is tried, since each rounds a moment by another amount
constexpr int kDepths = 512;  // the same, where no map is needed
constexpr int kTaps = 81;     // of a 9 x 9 box
constexpr double kSingleRounding = 0x1p-24;
constexpr const char* kSource =
    "derived; Higham 2002, Accuracy and Stability of Numerical Algorithms, 2nd ed., section 1.9, on the textbook "
    "variance";

/// The largest rounding of a number in [0,1] that is stored.
double store_rounding(filters::StorePrecision store) {
  switch (store) {
    case filters::StorePrecision::kSingle: return 0x1p-25;
    case filters::StorePrecision::kHalf: return 0x1p-12;
    case filters::StorePrecision::kUnorm16: return 0x1p-17;
  }
  return 0.0;
}

/// What the two moments go through between encode() and the formula.
struct Route {
  int stores = 1;          ///< how often they are rounded to the store
  int roundings = 2;       ///< those of single precision on the way, each of a number of up to 1
  double half_step = 0.0;  ///< the rounding to whole numbers
};

/// How far E[z^2] - E[z]^2 may be off, z in [0,1]. An error of the mean counts twice.
double bound_variance_error(filters::StorePrecision store, const Route& route) {
  return 3.0 * (route.stores * store_rounding(store) + route.half_step + route.roundings * kSingleRounding);
}

bool sums_areas(const filters::FilterSpec& spec) {
  return !spec.passes.empty() && spec.passes.back().steps == filters::PassSteps::kPrefix &&
         spec.passes.back().is_integer();
}

/// A blur stores its sums of products twice more. A summed-area table of whole numbers adds without error, but the
/// larger the area, the fewer steps a texel may have: half a step is lost, and the product and the sum that round to it
/// are rounded (2). Of the 16 windows that a box is made of, the 4 that differ in their ends across the edge have a
/// weight here: the sum of each becomes a float, is divided by the steps and weighted (3); the 4 are added (3); so are
/// their areas, after one product each (4); and one is divided by the other (1). The weights themselves round alike in
/// both moments and in the area: they move the kernel, not the variance.
Route find_route(const filters::FilterRequest& request) {
  const int radius = filters::prefilter_radius_texels(request.spec, request.values);
  if (radius > 0) return {3, 2 * (2 * radius + 1), 0.0};
  if (!sums_areas(request.spec)) return {};
  const auto widest = static_cast<int>(std::ceil(filters::radius_texels(request.spec, request.values)));
  return {1, 2 + 3 + 3 + 4 + 1, 0.5 / filters::count_moment_steps<double>(filters::longest_box_side(widest))};
}

/// Spreads depths over the far half of the range, where squares are rounded most.
float place_depth(int i, int count) { return static_cast<float>(0.5 + 0.499 * (i + 0.618) / count); }

/// Variance shadow maps are exact where a kernel holds two depths and the receiver is at the farther one: visibility is
/// that depth's share. With a minimum of the variance it is more.
std::vector<double> expect_visibility(const EdgeScene& edge, const std::vector<EdgeDepths>& bands, double minimum) {
  std::vector<double> visibility;
  for (std::size_t i = 0; i < edge.lit_share.size(); ++i) {
    const EdgeDepths& band = bands[edge.band[i]];
    const double gap = static_cast<double>(band.receiver) - static_cast<double>(band.occluder),
                 share = edge.lit_share[i];
    const double distance = (1.0 - share) * gap, variance = std::max(share * (1.0 - share) * gap * gap,
                                                                     static_cast<double>(static_cast<float>(minimum)));
    visibility.push_back(distance > 0.0 ? variance / (variance + distance * distance) : 1.0);
  }
  return visibility;
}

std::vector<EdgeDepths> make_bands(double ratio) {
  std::vector<EdgeDepths> bands;
  for (int i = 0; i < kBands; ++i) {
    const float receiver = place_depth(i, kBands);
    bands.push_back({static_cast<float>(std::max(static_cast<double>(receiver) - 1.0 / ratio, 0.0)), receiver});
  }
  return bands;
}

/// An error e of the variance moves visibility by e / gap^2 at most. With a minimum m it cannot move by more than e /
/// (4 m). A filter that cuts the share b off the dark end stretches both by 1 / (1 - b), for which rounding has room.
Theory make_theory(double error, double minimum, double bound, Verdict predicts) {
  Theory theory{std::nullopt, TheoryKind::kRounding, {}, kSource, predicts};
  if (minimum > 0.0 && error / (4.0 * minimum) < bound) {
    theory.formula = fmt::format("none: {:.2g} / (4 x {:g}) stays below {:g}", error, minimum, bound);
    return theory;
  }
  theory.onset = std::sqrt(bound / error);
  theory.formula = fmt::format("sqrt({:g} / {:.2g}): gap squared against what the variance is off by", bound, error);
  return theory;
}

/// Explains an error that the minimum variance keeps below a bound, but near to it: theory adds all roundings up.
std::string explain_unmet_bound(const Disagreement& missed) {
  if (missed.measured) return {};
  const double largest = find_largest_measured(missed.record);
  const double bound = missed.theory.predicts == Verdict::kDegraded ? kVisibleError : kLargestFall,
               factor = bound / largest;
  if (factor > records::tolerance_of(TheoryKind::kRounding)) return {};
  return fmt::format(
      "the minimum variance stops the error at {:.2g}, a factor {:.1f} below {:g}; theory adds all roundings up, which "
      "here partly cancel",
      largest, factor, bound);
}

/// What is varied besides the gap.
struct Setting {
  std::string store;
  double minimum = 0.0;  ///< of the variance
};

std::string driven_param(const filters::FilterSpec& spec) {
  return spec.exponent.empty() ? spec.variance_floor : std::string();
}

/// Edges for the kernel that all receivers share; where each chooses its own, it is the narrowest without a light's
/// size, one texel read between texels.
EdgeScene make_edges(const filters::FilterRequest& request) {
  const int radius = filters::prefilter_radius_texels(request.spec, request.values);
  const auto kernel = filters::find_kernel(request.spec, request.values);
  return radius > 0 || !kernel ? make_edge_scene(radius, make_bands(1.0)) : make_edge_scene(*kernel, make_bands(1.0));
}

/// The closed form is of Chebyshev's inequality. A filter that promises no such bound does more with the moments than
/// that, and only its model knows what; null for others.
SyntheticLookup make_exact_lookup(const AxisInputs& inputs, const filters::FilterRequest& request) {
  if (request.spec.kind == filters::FilterKind::kBound) return nullptr;
  return make_model_lookup(inputs, request, filters::Precision::kExtended);
}

Case make_filter_case(const AxisInputs& inputs, filters::FilterRequest request, const Setting& setting, Level level) {
  const auto& [store, minimum] = setting;
  const std::string param = driven_param(request.spec);
  request.values["store"] = store;
  request.values[param] = minimum;
  if (!request.spec.bound_at_zero.empty()) request.values[request.spec.bound_at_zero] = 0.0;  // the formula's own error
  Case item = start_case(inputs, request, fmt::format("{}, {} {:g}", store, param, minimum), level);
  if (!item.is_available()) return item;
  const double error = bound_variance_error(filters::store_precision(store), find_route(request));
  item.theories = {make_theory(error, minimum, kVisibleError, Verdict::kDegraded),
                   make_theory(error, minimum, kLargestFall, Verdict::kBroken)};
  item.explain = explain_unmet_bound;
  item.observe = [lookup = make_lookup(inputs, request, level), exact = make_exact_lookup(inputs, request),
                  edge = make_edges(request), values = request.values, minimum = minimum](double ratio) mutable {
    const std::vector<EdgeDepths> bands = make_bands(ratio);
    set_depths(edge, bands);
    const std::vector<double> expected =
        exact ? exact(edge.scene, values).visibility : expect_visibility(edge, bands, minimum);
    return judge(lookup(edge.scene, values), {expected, kVisibleError, edge.run});
  };
  return item;
}

/// The textbook variance of one depth, 81 times, in single precision with stored moments; it should be 0.
double find_variance(float depth, filters::StorePrecision store) {
  const float first = filters::round_to_store(depth, store), second = filters::round_to_store(depth * depth, store);
  float mean = 0.0f, mean_of_squares = 0.0f;
  for (int i = 0; i < kTaps; ++i) {
    mean += first * (1.0f / kTaps);
    mean_of_squares += second * (1.0f / kTaps);
  }
  return static_cast<double>(mean_of_squares) - static_cast<double>(mean) * static_cast<double>(mean);
}

/// Observes a wall that blocks everything, a gap before the receiver. All light behind it comes from a variance that
/// should be 0.
Observation observe_wall(double largest_variance, double ratio) {
  const double gap = 1.0 / ratio, leak = largest_variance / (largest_variance + gap * gap);
  return judge_by_bounds(leak, kVisibleError, 1.0 - kVisibleError, [&](double bound) {
    return fmt::format("visibility {:.2g} behind a wall: its variance is {:.2g} instead of 0, the gap squared {:.2g}{}",
                       leak, largest_variance, gap * gap, bound > kVisibleError ? "; all is lit" : "");
  });
}

Case make_wall_case(const char* name, filters::StorePrecision store) {
  double largest = 0.0;
  for (int i = 0; i < kDepths; ++i) largest = std::max(largest, find_variance(place_depth(i, kDepths), store));
  const double error = bound_variance_error(store, {1, kTaps, 0.0});
  Case item{.variant = fmt::format("{}, {} taps of one depth, no minimum", name, kTaps), .level = Level::kArithmetic};
  const auto theory = [&](double leak, Verdict predicts) {
    return Theory{std::sqrt(leak / ((1.0 - leak) * error)), TheoryKind::kRounding,
                  fmt::format("sqrt({:g} / ({:g} x {:.2g}))", leak, 1.0 - leak, error), kSource, predicts};
  };
  item.theories = {theory(kVisibleError, Verdict::kDegraded), theory(1.0 - kVisibleError, Verdict::kBroken)};
  item.observe = [largest](double ratio) { return observe_wall(largest, ratio); };
  return item;
}

/// Lists each store with the filter's own minimum of the variance, and with none unless the user set one.
std::vector<Setting> list_settings(const filters::FilterRequest& request) {
  const std::string param = driven_param(request.spec);
  if (param.empty()) return {};
  const double minimum = filters::number(request.values, param);
  std::vector<Setting> settings;
  for (const std::string& store : list_choices(request, "store")) {
    settings.push_back({store, minimum});
    if (minimum != 0.0 && !request.set_by_user.contains(param)) settings.push_back({store, 0.0});
  }
  return settings;
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  std::vector<Case> cases =
      make_filter_cases(inputs, list_settings, make_filter_case,
                        "no chosen filter's front matter declares 'variance_floor' without 'exponent'");
  cases.push_back(make_wall_case("32-bit float", filters::StorePrecision::kSingle));
  cases.push_back(make_wall_case("16-bit float", filters::StorePrecision::kHalf));
  cases.push_back(make_wall_case("16-bit unorm", filters::StorePrecision::kUnorm16));
  return cases;
}

}  // namespace vsm_cancellation

Axis make_vsm_cancellation_axis() {
  using namespace vsm_cancellation;
  Axis axis;
  axis.title = "Variance by cancellation: across an edge, and (arithmetic) behind a wall";
  axis.quantity = "depth range / gap between occluder and receiver";
  axis.range = {1.0, 1e7};
  axis.limits = {1.0, 1e9};
  axis.coarse_samples = 43;
  axis.measured = "largest error of visibility";
  axis.bound = kVisibleError;
  axis.broken_when =
      "visibility is not finite, all lit or all dark, or falls by more than 0.1 from dark to light; of arithmetic: "
      "over 0.98 behind a wall";
  axis.driven_param = driven_param;
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
