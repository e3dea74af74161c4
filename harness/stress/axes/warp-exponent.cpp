#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "filters/store_format.h"
#include "harness/stress/probe.h"

namespace shadowbench::stress {
namespace warp_exponent {

constexpr double kBound = 0.02;
constexpr int kTaps = 81;  // of a 9 x 9 box
constexpr const char* kSource = "derived: exp(2 c) must stay below the largest finite number (IEEE 754)";

/// A store, and how many second moments are added before they are divided.
struct Setting {
  const char* name;
  filters::StorePrecision store;
  double largest;
  int taps;
};

/// The largest second moment, of the warped depth 1, as the store keeps it.
float sum_moments(const Setting& setting, double c) {
  const float warped = std::exp(static_cast<float>(c));
  float sum = 0.0f;
  for (int i = 0; i < setting.taps; ++i)
    sum = filters::round_to_store(sum + filters::round_to_store(warped * warped, setting.store), setting.store);
  return sum;
}

/// Measures the relative error: against exp(2 c), which double holds up to c = 354.
Observation observe_moment(const Setting& setting, double c) {
  const auto sum = static_cast<double>(sum_moments(setting, c));
  if (!std::isfinite(sum))
    return {Verdict::kBroken, std::nullopt,
            fmt::format("{:.3g}{} is more than {:.5g}", std::exp(2.0 * c),
                        setting.taps == 1 ? "" : fmt::format(" x {}", setting.taps), setting.largest)};
  const double error = std::abs(sum / (setting.taps * std::exp(2.0 * c)) - 1.0);
  if (error > kBound)
    return {Verdict::kDegraded, error, fmt::format("relative error {:.2g}, over {:g}", error, kBound)};
  return {Verdict::kOk, error, {}};
}

Case make_moment_case(const Setting& setting) {
  Case item;
  item.variant =
      fmt::format("{}, {}", setting.name,
                  setting.taps == 1 ? "one second moment" : fmt::format("sum of {} second moments", setting.taps));
  item.level = Level::kArithmetic;
  item.theories = {
      {0.5 * std::log(setting.largest / setting.taps), TheoryKind::kOverflow,
       fmt::format("ln({:.5g}{}) / 2", setting.largest, setting.taps == 1 ? "" : fmt::format(" / {}", setting.taps)),
       kSource, Verdict::kBroken}};
  item.observe = [setting](double c) { return observe_moment(setting, c); };
  return item;
}

/// A map of depths 0 .. 1 with receivers behind each column, held against the filter's own model in double precision.
ProbeScene make_ramp_scene() {
  ProbeScene scene;
  scene.size = 64;
  for (int i = 0; i < scene.size * scene.size; ++i)
    scene.depths.push_back(static_cast<float>(i % scene.size) / static_cast<float>(scene.size - 1));
  for (int x = 0; x < scene.size; ++x)
    scene.receivers.push_back({scene.uv(x), 0.5f, std::min(1.0f, scene.depths[static_cast<std::size_t>(x)] + 0.1f)});
  return scene;
}

Theory make_filter_theory(const std::string& store) {
  const double largest = filters::store_precision(store) == filters::StorePrecision::kHalf
                             ? 65504.0
                             : static_cast<double>(std::numeric_limits<float>::max());
  return {0.5 * std::log(largest), TheoryKind::kOverflow, fmt::format("ln({:.5g}) / 2", largest), kSource,
          Verdict::kBroken};
}

Case make_filter_case(const StressContext& context, const DrivenFilter& driven, const std::string& store, Level level) {
  filters::FilterRequest request = driven.request;
  request.values["store"] = store;
  const auto [probe, reason] = make_probe(context, request, level);
  if (!probe || !filters::make_model(request.spec.id)) {
    return make_absent_case(request.spec.id, store, level,
                            probe ? "the filter has no scalar model to be held against" : reason);
  }
  Case item = start_case(request, store, level);
  item.params.erase(driven.param);
  item.theories = {make_filter_theory(store)};
  const std::shared_ptr<Probe> exact = make_model_probe(context, request, filters::Precision::kDouble);
  item.observe = [probe = probe, exact, values = request.values, param = driven.param,
                  scene = make_ramp_scene()](double c) mutable {
    values[param] = c;
    return judge(probe->look(scene, values), {exact->look(scene, values).visibility, kBound, 0});
  };
  return item;
}

std::string driven_param(const filters::FilterSpec& spec) { return spec.holds_moments ? spec.exponent : std::string(); }

std::vector<Case> make_cases(const StressContext& context) {
  const double single = static_cast<double>(std::numeric_limits<float>::max());
  std::vector<Case> cases;
  for (const Setting& setting : {Setting{"32-bit float", filters::StorePrecision::kSingle, single, 1},
                                 {"32-bit float", filters::StorePrecision::kSingle, single, kTaps},
                                 {"16-bit float", filters::StorePrecision::kHalf, 65504.0, 1},
                                 {"16-bit float", filters::StorePrecision::kHalf, 65504.0, kTaps}})
    cases.push_back(make_moment_case(setting));
  const std::vector<DrivenFilter> driven = find_driven(context, driven_param);
  if (driven.empty()) cases.push_back(make_undriven_case("'exponent' with 'moments'"));
  for (const DrivenFilter& filter : driven) {
    for (const std::string& store : list_choices(filter.request, "store"))
      for (const Level level : {Level::kGl, Level::kModel})
        cases.push_back(make_filter_case(context, filter, store, level));
  }
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
  axis.bound = kBound;
  axis.broken_when =
      "a moment or a sum of moments is infinite, or texels of the map overflowed; of filters also: visibility is not "
      "finite, all lit or all dark";
  axis.driven_param = driven_param;
  axis.make_cases = make_cases;
  return axis;
}

}  // namespace shadowbench::stress
