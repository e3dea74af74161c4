#include "harness/measure/stability_meter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/files.h"
#include "filters/percentage_closer.h"
#include "filters/store_format.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/gbuffer.h"
#include "reference/metrics/error_stats.h"
#include "report/analysis/findings.h"
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

/// Reads a layer of a filter's encoded map back, of a 16-bit float store before its blur, too: there a GL may saturate,
/// and the blur hides it. Requires a filter that encodes, and that its map was made.
metrics::StoredMap read_map(render::FilterPasses& filter, const render::ShadowMap& map, int layer = 0) {
  const filters::FilterRequest& request = filter.request();
  render::Prefilter& encoded = *filter.encoded_map(layer);
  metrics::StoredMap stored{encoded.read(), encoded.channels(), largest_number(request.values),
                            request.spec.holds_moments};
  if (filters::store_precision(store_of(request.values)) == filters::StorePrecision::kHalf)
    stored.before_blur = encoded.read_before_blur(map, layer);
  stored.blur_radius_texels = encoded.blur_radius_texels();
  if (const auto border = encoded.blurred_border()) stored.border.assign(&border->x, &border->x + stored.channels);
  return stored;
}

/// Looks through all layers of a filter's encoded map. Requires a filter that encodes, and that its map was made.
metrics::TexelHealth check_map(render::FilterPasses& filter, const render::ShadowMap& map) {
  metrics::TexelHealth health = metrics::check_texels(read_map(filter, map));
  for (int layer = 1; layer < filter.layers(); ++layer) health.add(metrics::check_texels(read_map(filter, map, layer)));
  return health;
}

/// Names the store with as many channels and the other float precision; nothing where the filter does not offer
/// it.
std::optional<std::string> find_other_store(const filters::FilterRequest& request) {
  const filters::ParamSpec* param = request.spec.find_param("store");
  if (!param) return std::nullopt;
  const std::string own = filters::text_or(request.values, "store", "");
  for (const filters::ParamValue& choice : param->choices) {
    const std::string other = filters::to_string(choice);
    const bool floats = own.ends_with("f") && other.ends_with("f");
    if (!floats || filters::store_channels(own) != filters::store_channels(other)) continue;
    if (filters::store_precision(own) != filters::store_precision(other)) return other;
  }
  return std::nullopt;
}

/// Puts a layer of a map into a picture of all, side by side; rows from top to bottom.
void put_layer(images::Image& image, int layer, const std::vector<float>& values) {
  const int side = image.height;
  for (int y = 0; y < side; ++y) {
    const auto row = values.begin() + static_cast<std::ptrdiff_t>(side - 1 - y) * side;
    std::copy(row, row + side, image.at(layer * side, y));
  }
}

void note_absent(records::CellRecord& record, std::initializer_list<const char*> fields, const std::string& reason) {
  for (const char* field : fields) record.absent[std::string("stability.") + field] = reason;
}

/// Why a filter is not compared with what it bounds; empty where it is.
std::string explain_no_bound(const filters::FilterRequest& request, const filters::ScalarModel* model) {
  if (request.spec.kind != filters::FilterKind::kBound)
    return "only a filter of the kind 'bound' promises never to be darker than its percentage-closer filter";
  if (!filters::promises_bound(request.spec, request.values))
    return fmt::format("the filter is a bound with {}=0 only", request.spec.bound_at_zero);
  if (!model) return filters::kNoModel;
  return model->kernel(request.values) ? "" : filters::explain_no_kernel(request.spec, request.values);
}

constexpr const char* kReadsDepth = "the filter reads the depth map itself";

}  // namespace

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

MapTrial StabilityMeter::make_trial(const filters::FilterRequest& request) const {
  return [this, request](const filters::ParamValues& values) {
    filters::FilterRequest tried = request;
    tried.values = values;
    const auto passes = rig_.make_passes(tried);
    passes->prefilter(light_.map);
    return check_map(*passes, light_.map);
  };
}

const std::vector<std::uint8_t>& StabilityMeter::mask() {
  if (!mask_) mask_ = read_view_receivers(rig_.gbuffer(), rig_.task.scene->light).mask();
  return *mask_;
}

void StabilityMeter::warn(MeasuredCell& cell, render::FilterPasses& filter) const {
  if (!filter.encoded_map()) return;
  const metrics::TexelHealth health = check_map(filter, light_.map);
  const std::string name = fmt::format("{}: {}", rig_.task.scene->name, cell.label);
  for (std::string& warning : list_exceeded_limits(name, cell.request, health, make_trial(cell.request)))
    cell.record.warnings.push_back(std::move(warning));
}

void StabilityMeter::measure(MeasuredCell& cell, render::FilterPasses& filter) {
  check_texels(cell, filter);
  compare_stores(cell);
  check_bound(cell, filter);
}

void StabilityMeter::check_texels(MeasuredCell& cell, render::FilterPasses& filter) const {
  records::StabilityRecord& stability = cell.record.stability;
  if (!filter.encoded_map()) {
    note_absent(
        cell.record,
        {"overflow_texels", "nan_texels", "negative_variance_texels", "lowest_variance", "headroom", "safe_exponent"},
        kReadsDepth);
    return;
  }
  const metrics::TexelHealth health = check_map(filter, light_.map);
  stability.overflow_texels = health.overflowed;
  stability.nan_texels = health.nan;
  cell.stability.headroom = draw_layers(filter, metrics::measure_headroom);
  if (health.largest && *health.largest > 0.0)
    stability.headroom = std::log(largest_number(cell.request.values)) - std::log(*health.largest);
  else
    note_absent(cell.record, {"headroom"}, health.largest ? "the map holds nothing but 0" : "the map overflowed");
  stability.safe_exponent = find_safe_exponent(cell.request, make_trial(cell.request));
  if (!stability.safe_exponent)
    note_absent(cell.record, {"safe_exponent"},
                "the map holds no exponentials, or none that a smaller exponent keeps finite");
  if (!cell.request.spec.holds_moments) {
    note_absent(cell.record, {"negative_variance_texels", "lowest_variance"},
                "the filter does not say that its map holds moments");
    return;
  }
  stability.negative_variance_texels = health.negative_variance;
  stability.lowest_variance = health.lowest_variance;
  cell.stability.variance = draw_layers(filter, metrics::measure_variance);
}

images::Image StabilityMeter::draw_layers(render::FilterPasses& filter,
                                          std::vector<float> (*of_layer)(const metrics::StoredMap&)) const {
  images::Image image(filter.layers() * light_.map.size(), light_.map.size(), 1);
  for (int layer = 0; layer < filter.layers(); ++layer)
    put_layer(image, layer, of_layer(read_map(filter, light_.map, layer)));
  return image;
}

void StabilityMeter::compare_stores(MeasuredCell& cell) {
  const auto other_store = find_other_store(cell.request);
  if (!other_store) {
    note_absent(cell.record, {"half_difference_max", "half_difference_rms"},
                cell.request.spec.has_encode ? "the filter has no other store with as many channels" : kReadsDepth);
    return;
  }
  filters::FilterRequest request = cell.request;
  request.values["store"] = *other_store;
  const auto passes = rig_.make_passes(request);
  render::ImageTarget target("visibility with the other store", GL_R32F, rig_.options.width, rig_.options.height);
  const images::Image other = draw_visibility(*passes, light_.map, rig_.gbuffer(), target);
  const bool other_is_half = filters::store_precision(*other_store) == filters::StorePrecision::kHalf;
  const images::Image& half = other_is_half ? other : cell.visibility;
  const images::Image& single = other_is_half ? cell.visibility : other;
  images::Image difference = half;
  for (std::size_t i = 0; i < difference.texels.size(); ++i) difference.texels[i] -= single.texels[i];
  const std::vector<float> zero(difference.texels.size(), 0.0f);
  if (const auto stats = metrics::measure_error(difference.texels, zero, mask())) {
    cell.record.stability.half_difference_max = stats->max;
    cell.record.stability.half_difference_rms = stats->rmse;
  } else {
    note_absent(cell.record, {"half_difference_max", "half_difference_rms"},
                "no surface in view faces the light, or no pixel is finite");
  }
  cell.stability.half_difference = std::move(difference);
}

void StabilityMeter::check_bound(MeasuredCell& cell, render::FilterPasses& filter) {
  const std::initializer_list<const char*> fields = {"bound_shortfall_max", "bound_violations",
                                                     "bound_exact_violations"};
  const filters::ScalarModel* model = filters::find_model(cell.request.spec);
  if (const std::string reason = explain_no_bound(cell.request, model); !reason.empty())
    return note_absent(cell.record, fields, reason);
  metrics::BoundCheck check = compare_with_closer(cell, *model, filter.light());
  if (check.receivers == 0) return note_absent(cell.record, fields, "no receiver can be compared");
  cell.record.stability.bound_shortfall_max = check.shortfall_max;
  cell.record.stability.bound_violations = check.violations;
  cell.record.stability.bound_exact_violations = check.exact_violations;
  cell.stability.shortfall = images::make_image(rig_.options.width, rig_.options.height, check.shortfall);
  cell.stability.violation = images::make_image(rig_.options.width, rig_.options.height, check.violation);
}

/// Compares both at the depth that the filter itself compares with: another bias would be another bound.
metrics::BoundCheck StabilityMeter::compare_with_closer(const MeasuredCell& cell, const filters::ScalarModel& model,
                                                        const render::LightLayers& light) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const ModelView view = rig_.view();
  const std::size_t pixels = cell.visibility.texels.size();
  const bool overflowed = cell.record.stability.overflow_texels.value_or(0) > 0;
  std::vector<double> of_model(pixels, 1.0), of_closer(pixels, 1.0), tolerance(pixels, kNone);
  std::vector<std::uint8_t> excused(pixels);
  for (const render::LightSetup& layer : light) {
    const auto receivers = render::read_receivers(rig_.renderer.shaders, rig_.gbuffer(), layer);
    const filters::DepthMap map = light_.map.read(layer.frustum.layer);
    const filters::ModelInput input = view.input(cell.request, map, measure_accuracy(rig_.renderer));
    const auto exact = model.prepare(input, filters::Precision::kDouble);
    const auto tracked = model.prepare(input, filters::Precision::kTracked);
    const filters::PercentageCloser closer(*model.kernel(cell.request.values), map, view.plane_max_tangent);
    visit_in_parallel(receivers.size(), [&](std::size_t i) {
      const filters::Receiver& r = receivers[i];
      const filters::ModelResult bounded = tracked->at(r);
      const std::size_t pixel = find_pixel(r, view.width, view.height);
      put_share(of_model[pixel], r, exact->at(r).visibility);
      put_share(of_closer[pixel], r, closer.at(r));
      // In a map that overflowed an infinite bound on rounding explains nothing: the overflow is no rounding.
      const double bound = std::isfinite(bounded.bound) ? bounded.bound : overflowed ? 0.0 : HUGE_VAL;
      const double so_far = std::isnan(tolerance[pixel]) ? 0.0 : tolerance[pixel];
      tolerance[pixel] = so_far + static_cast<double>(r.layer_share) * bound;
      if (bounded.excused) excused[pixel] = 1;
    });
  }
  for (std::size_t i = 0; i < pixels; ++i)
    if (excused[i]) tolerance[i] = kNone;
  return metrics::check_bound({cell.visibility.texels, of_model, of_closer, tolerance});
}

void write_stability(const options::RunOptions& options, const std::string& stem, MeasuredCell& cell) {
  if (!options.stability || cell.record.status != records::CellStatus::kOk) return;
  if (cell.stability.headroom.empty() && cell.stability.shortfall.empty()) {
    cell.record.absent["images.stability"] = "the filter reads the depth map itself, and is no bound";
    return;
  }
  images::Figure figure{
      fmt::format("{} on {}: where its numbers break, or come near to it", cell.label, cell.record.scene),
      records::describe_params(cell.record.params) + " · " + records::describe_settings(cell.record),
      images::show_stability(cell.stability,
                             {analysis::caption_texels(cell.record), analysis::caption_variance(cell.record),
                              analysis::caption_difference(cell.record), analysis::caption_bound(cell.record)}),
      2};
  cell.record.images.stability = fmt::format("images/{}.{}.stability.png", stem, make_file_stem(cell.label));
  images::write_figure(options.out / *cell.record.images.stability, figure);
}

}  // namespace shadowbench::measure
