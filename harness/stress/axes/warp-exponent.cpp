#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "filters/store_format.h"
#include "harness/stress/axis.h"
#include "harness/stress/synthetic_scene.h"

namespace shadowbench::stress {
namespace warp_exponent {

constexpr int kTaps = 81;  // of a 9 x 9 box
constexpr const char* kSource = "derived: exp(2 c) must stay below the largest finite number (IEEE 754)";

/// A store, and how many second moments are added before they are divided.
struct Moments {
  const char* name;
  filters::StorePrecision store;
  int taps;
  double largest() const { return filters::largest_number(store); }
};

/// The largest second moment, of the warped depth 1, as the store keeps it.
float sum_moments(const Moments& moments, double c) {
  const float warped = std::exp(static_cast<float>(c));
  float sum = 0.0f;
  for (int i = 0; i < moments.taps; ++i)
    sum = filters::round_to_store(sum + filters::round_to_store(warped * warped, moments.store), moments.store);
  return sum;
}

/// Measures the relative error: against exp(2 c), which double holds up to c = 354.
Observation observe_moment(const Moments& moments, double c) {
  const auto sum = static_cast<double>(sum_moments(moments, c));
  if (!std::isfinite(sum))
    return {Verdict::kBroken, std::nullopt,
            fmt::format("{:.3g}{} is more than {:.5g}", std::exp(2.0 * c),
                        moments.taps == 1 ? "" : fmt::format(" x {}", moments.taps), moments.largest())};
  const double error = std::abs(sum / (moments.taps * std::exp(2.0 * c)) - 1.0);
  return judge_by_bounds(error, kVisibleError, std::numeric_limits<double>::infinity(),
                         [&](double bound) { return fmt::format("relative error {:.2g}, over {:g}", error, bound); });
}

Case make_moment_case(const Moments& moments) {
  const std::string what =
      moments.taps == 1 ? "one second moment" : fmt::format("sum of {} second moments", moments.taps);
  Case item{.variant = fmt::format("{}, {}", moments.name, what), .level = Level::kArithmetic};
  item.theories = {
      {0.5 * std::log(moments.largest() / moments.taps), TheoryKind::kOverflow,
       fmt::format("ln({:.5g}{}) / 2", moments.largest(), moments.taps == 1 ? "" : fmt::format(" / {}", moments.taps)),
       kSource, Verdict::kBroken}};
  item.observe = [moments](double c) { return observe_moment(moments, c); };
  return item;
}

/// Makes a map of depths from 0 to 1 with receivers behind each column.
SyntheticScene make_ramp_scene() {
  SyntheticScene scene;
  scene.size = 64;
  for (int i = 0; i < scene.size * scene.size; ++i)
    scene.depths.push_back(static_cast<float>(i % scene.size) / static_cast<float>(scene.size - 1));
  for (int x = 0; x < scene.size; ++x)
    scene.receivers.push_back({scene.uv(x), 0.5f, std::min(1.0f, scene.depths[static_cast<std::size_t>(x)] + 0.1f)});
  return scene;
}

Theory make_filter_theory(const std::string& store) {
  const double largest = filters::largest_number(filters::store_precision(store));
  return {0.5 * std::log(largest), TheoryKind::kOverflow, fmt::format("ln({:.5g}) / 2", largest), kSource,
          Verdict::kBroken};
}

std::string driven_param(const filters::FilterSpec& spec) { return spec.holds_moments ? spec.exponent : std::string(); }

/// Makes a case of one store, held against the filter's own model in double precision.
Case make_filter_case(const AxisInputs& inputs, filters::FilterRequest request, const std::string& store, Level level) {
  request.values["store"] = store;
  Case item = start_case(inputs, request, store, level);
  if (!item.is_available()) return item;
  const std::string param = driven_param(request.spec);
  item.params.erase(param);
  // A model has no map that could overflow: what it makes of an infinite moment is light.
  if (level == Level::kGl) item.theories = {make_filter_theory(store)};
  item.observe = [lookup = make_lookup(inputs, request, level),
                  exact = make_model_lookup(inputs, request, filters::Precision::kDouble), values = request.values,
                  param, scene = make_ramp_scene()](double c) mutable {
    values[param] = c;
    return judge(lookup(scene, values), {exact(scene, values).visibility, kVisibleError, 0});
  };
  return item;
}

std::vector<std::string> list_stores(const filters::FilterRequest& request) {
  return driven_param(request.spec).empty() ? std::vector<std::string>() : list_choices(request, "store");
}

std::vector<Case> make_cases(const AxisInputs& inputs) {
  std::vector<Case> cases;
  for (const auto& [name, store] : {std::pair("32-bit float", filters::StorePrecision::kSingle),
                                    std::pair("16-bit float", filters::StorePrecision::kHalf)})
    for (const int taps : {1, kTaps}) cases.push_back(make_moment_case({name, store, taps}));
  for (Case& item : make_filter_cases(inputs, list_stores, make_filter_case,
                                      "no chosen filter's front matter declares 'exponent' with 'moments'"))
    cases.push_back(std::move(item));
  return cases;
}

}  // namespace warp_exponent

Axis make_warp_exponent_axis() {
  using namespace warp_exponent;
  Axis axis;
  axis.title = "Warp exponent of exponential variance maps";
  axis.quantity = "exponent c of the warp exp(c z), z in [-1,1]";
  axis.range = {1.0, 200.0};
  axis.limits = {0.1, 350.0};  // the reference, exp(2 c) in double, ends at 354
  axis.coarse_samples = 24;
  axis.measured = "relative error of the second moment; of filters: error of visibility";
  axis.bound = kVisibleError;
  axis.broken_when =
      "a moment or a sum of moments is infinite, or texels of the map overflowed; of filters also: visibility is not "
      "finite, all lit or all dark";
  axis.driven_param = driven_param;
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
