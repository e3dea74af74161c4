#include "harness/measure/map_limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "filters/store_format.h"
#include "report/records/format.h"

namespace shadowbench::measure {
namespace {

using filters::FilterRequest;
using filters::ParamSpec;
using filters::ParamValues;
using metrics::TexelHealth;

std::string store_of(const ParamValues& values) { return filters::text_or(values, "store", ""); }

double largest_number(const ParamValues& values) {
  return filters::largest_number(filters::store_precision(store_of(values)));
}

/// `up` away from 0, else towards it.
double round_to_digits(double value, int digits, bool up) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) + 1 - digits);
  return (up ? std::ceil(value / unit) : std::floor(value / unit)) * unit;
}

/// One parameter of a filter, tried at other values.
class Exponent {
 public:
  Exponent(const FilterRequest& request, const MapTrial& trial)
      : spec_(*request.spec.find_param(request.spec.exponent)), trial_(trial), values_(request.values) {}

  double given() const { return filters::number(values_, spec_.name); }

  TexelHealth health_at(double value) const {
    ParamValues tried = values_;
    tried[spec_.name] = spec_.integer ? std::floor(value) : value;
    return trial_(tried);
  }

  /// The exponent at which the largest stored number would be the store's largest, judged by what is stored at `value`,
  /// or at the end of the range that is next to it.
  std::optional<double> extrapolate(double value) const {
    value = std::clamp(value, *spec_.min, *spec_.max);
    const auto largest = health_at(value).largest;
    if (!largest || *largest <= 1.0) return std::nullopt;
    return value * std::log(largest_number(values_)) / std::log(*largest);
  }

  /// Some value without overflow; nothing where the whole range overflows.
  std::optional<double> find_sound() const {
    for (double value = given(); value >= *spec_.min; value *= 0.25)
      if (health_at(value).broken() == 0) return value;
    return std::nullopt;
  }

  /// `estimate`, within the range, rounded down, and a little lower still where a trial says so.
  std::optional<double> settle(double estimate) const {
    constexpr double kStep = 0.999;
    constexpr int kMostSteps = 8;
    double value = std::min(estimate, *spec_.max);
    for (int i = 0; i < kMostSteps; ++i, value *= kStep) {
      const double rounded = spec_.integer ? std::floor(value) : round_to_digits(value, 4, false);
      if (rounded < *spec_.min) return std::nullopt;
      if (health_at(rounded).broken() == 0) return rounded;
    }
    return std::nullopt;
  }

 private:
  const ParamSpec& spec_;
  const MapTrial& trial_;
  ParamValues values_;
};

bool is_fixed_point(const std::string& store) {
  return filters::store_precision(store) == filters::StorePrecision::kUnorm16;
}

/// The other choices of `store` and `combine` with which `keeps` holds, as the command line has them.
std::vector<std::string> list_sound_choices(const FilterRequest& request, const MapTrial& trial,
                                            const std::function<bool(const TexelHealth&)>& keeps) {
  std::vector<std::string> sound;
  for (const char* name : {"store", "combine"}) {
    const ParamSpec* param = request.spec.find_param(name);
    if (!param) continue;
    for (const filters::ParamValue& choice : param->choices) {
      ParamValues tried = request.values;
      if (tried[name] == choice) continue;
      tried[name] = choice;
      // Fixed point never overflows: it saturates, which nothing shows.
      if (is_fixed_point(store_of(tried)) || !keeps(trial(tried))) continue;
      sound.push_back(fmt::format("{}={}", name, filters::to_string(choice)));
    }
  }
  return sound;
}

std::string advise(const std::vector<std::string>& remedies) {
  if (remedies.empty()) return "no store, no way to combine and no exponent of it avoids that here";
  return fmt::format("choose {}", fmt::join(remedies, " or "));
}

std::string describe_broken(const TexelHealth& health) {
  const double share = 100.0 * static_cast<double>(health.broken()) / static_cast<double>(health.texels);
  std::string text = fmt::format("{} of its map's {} texels ({} %) overflowed", health.broken(), health.texels,
                                 records::format_number(share));
  return health.nan > 0 ? text + fmt::format(", {} of them to NaN", health.nan) : text;
}

std::string warn_of_overflow(const FilterRequest& request, const TexelHealth& health, const MapTrial& trial) {
  std::vector<std::string> remedies;
  if (const auto safe = find_safe_exponent(request, trial))
    remedies.push_back(fmt::format("{} <= {:.4g}", request.spec.exponent, *safe));
  const auto sound = list_sound_choices(request, trial, [](const TexelHealth& tried) { return tried.broken() == 0; });
  remedies.insert(remedies.end(), sound.begin(), sound.end());
  const double largest = largest_number(request.values);
  return fmt::format("{}, so its image is not to be trusted: {} holds numbers up to {:.6g}, which is e^{:.2f}; {}",
                     describe_broken(health), store_of(request.values), largest, std::log(largest), advise(remedies));
}

std::string warn_of_variance(const FilterRequest& request, const TexelHealth& health, const MapTrial& trial) {
  const ParamSpec& floor = *request.spec.find_param(request.spec.variance_floor);
  const double given = filters::number(request.values, floor.name),
               needed = round_to_digits(-*health.lowest_variance, 2, true);
  std::vector<std::string> remedies;
  if (needed <= *floor.max) remedies.push_back(fmt::format("{} >= {:.2g}", floor.name, needed));
  const auto sound = list_sound_choices(request, trial, [given](const TexelHealth& tried) {
    return tried.broken() == 0 && tried.lowest_variance.value_or(0.0) >= -given;
  });
  remedies.insert(remedies.end(), sound.begin(), sound.end());
  return fmt::format(
      "rounding in {} takes the variance of {} of its map's {} texels below 0, down to {:.2g}, which {}={:g} does not "
      "make up "
      "for: expect acne; {}",
      store_of(request.values), *health.negative_variance, health.texels, *health.lowest_variance, floor.name, given,
      advise(remedies));
}

}  // namespace

ReadMap::ReadMap(render::FilterPasses& filter, const render::ShadowMap& map, int layer)
    : request_(filter.request()),
      texels_(filter.encoded_map(layer)->read()),
      radius_(filter.encoded_map(layer)->blur_radius_texels()),
      border_(filter.encoded_map(layer)->blurred_border()) {
  const bool is_half = filters::store_precision(store_of(request_.values)) == filters::StorePrecision::kHalf;
  if (is_half) before_blur_ = filter.encoded_map(layer)->read_before_blur(map, layer);
}

metrics::StoredMap ReadMap::stored() const {
  metrics::StoredMap stored{texels_.values, texels_.channels, largest_number(request_.values),
                            request_.spec.holds_moments};
  if (before_blur_) stored.before_blur = before_blur_->values;
  stored.blur_radius_texels = radius_;
  if (border_) stored.border = std::span(&border_->x, static_cast<std::size_t>(texels_.channels));
  return stored;
}

metrics::TexelHealth check_map(render::FilterPasses& filter, const render::ShadowMap& map) {
  metrics::TexelHealth health = metrics::check_texels(ReadMap(filter, map).stored());
  for (int layer = 1; layer < filter.layers(); ++layer)
    health.add(metrics::check_texels(ReadMap(filter, map, layer).stored()));
  return health;
}

std::int64_t count_broken_texels(render::FilterPasses& filter, const render::ShadowMap& map) {
  return filter.encoded_map() ? check_map(filter, map).broken() : 0;
}

std::optional<double> find_safe_exponent(const FilterRequest& request, const MapTrial& trial) {
  if (request.spec.exponent.empty() || filters::combines_logs(request.values)) return std::nullopt;
  const Exponent exponent(request, trial);
  const auto sound = exponent.find_sound();
  if (!sound) return std::nullopt;
  const auto rough = exponent.extrapolate(*sound);
  if (!rough) return std::nullopt;
  // Close to the limit a 16-bit store's rounding weighs less.
  constexpr double kClose = 0.95;
  return exponent.settle(exponent.extrapolate(kClose * *rough).value_or(*rough));
}

std::vector<std::string> list_exceeded_limits(const std::string& name, const FilterRequest& request,
                                              const TexelHealth& health, const MapTrial& trial) {
  std::vector<std::string> warnings;
  if (health.broken() > 0) warnings.push_back(name + ": " + warn_of_overflow(request, health, trial));
  if (request.spec.variance_floor.empty() || !health.lowest_variance) return warnings;
  if (*health.lowest_variance < -filters::number(request.values, request.spec.variance_floor))
    warnings.push_back(name + ": " + warn_of_variance(request, health, trial));
  return warnings;
}

}  // namespace shadowbench::measure
