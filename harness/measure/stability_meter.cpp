#include "harness/measure/stability_meter.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "filters/percentage_closer.h"
#include "filters/store_format.h"
#include "harness/measure/filter_setup.h"
#include "harness/measure/model_images.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/gbuffer.h"
#include "reference/metrics/error_stats.h"
#include "report/analysis/findings.h"
#include "report/files/file_name.h"
#include "report/records/format.h"

namespace shadowbench::measure {
namespace {

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
  return model->kernel(request.values) ? "" : filters::explain_no_kernel(request.spec);
}

constexpr const char* kReadsDepth = "the filter reads the depth map itself";

}  // namespace

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

StabilityMeter::StabilityMeter(Renderer& renderer, const options::RunOptions& options, const SceneTask& task,
                               SceneAssets& assets)
    : renderer_(renderer),
      options_(options),
      task_(task),
      assets_(assets),
      light_(assets.light_map(*task.camera, task.map_size)) {}

MapTrial StabilityMeter::make_trial(const filters::FilterRequest& request) const {
  return [this, request](const filters::ParamValues& values) {
    filters::FilterRequest tried = request;
    tried.values = values;
    const auto passes = make_filter_passes(renderer_, options_, *task_.scene, light_, tried);
    passes->prefilter(light_.map);
    return check_map(*passes, light_.map);
  };
}

const std::vector<std::uint8_t>& StabilityMeter::mask() {
  if (!mask_) mask_ = read_view_receivers(assets_.gbuffer(*task_.camera), task_.scene->light).mask();
  return *mask_;
}

void StabilityMeter::warn(MeasuredCell& cell, render::FilterPasses& filter) const {
  if (!filter.encoded_map()) return;
  const metrics::TexelHealth health = check_map(filter, light_.map);
  const std::string name = fmt::format("{}: {}", task_.scene->name, cell.label);
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
  const ReadMap first(filter, light_.map);
  const bool holds_moments = first.stored().moments;
  stability.overflow_texels = health.overflowed;
  stability.nan_texels = health.nan;
  cell.stability.headroom = draw_layers(filter, metrics::measure_headroom);
  if (health.largest && *health.largest > 0.0)
    stability.headroom = std::log(first.stored().largest_number) - std::log(*health.largest);
  else
    note_absent(cell.record, {"headroom"}, health.largest ? "the map holds nothing but 0" : "the map overflowed");
  stability.safe_exponent = find_safe_exponent(cell.request, make_trial(cell.request));
  if (!stability.safe_exponent)
    note_absent(cell.record, {"safe_exponent"},
                "the map holds no exponentials, or none that a smaller exponent keeps finite");
  if (!holds_moments) {
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
    put_layer(image, layer, of_layer(ReadMap(filter, light_.map, layer).stored()));
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
  const auto passes = make_filter_passes(renderer_, options_, *task_.scene, light_, request);
  render::ImageTarget target("visibility with the other store", GL_R32F, options_.width, options_.height);
  const images::Image other = draw_visibility(*passes, light_.map, assets_.gbuffer(*task_.camera), target);
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
  const auto model = filters::make_model(cell.request.spec);
  if (const std::string reason = explain_no_bound(cell.request, model.get()); !reason.empty())
    return note_absent(cell.record, fields, reason);
  metrics::BoundCheck check = compare_with_closer(cell, *model, filter.light());
  if (check.receivers == 0) return note_absent(cell.record, fields, "no receiver can be compared");
  cell.record.stability.bound_shortfall_max = check.shortfall_max;
  cell.record.stability.bound_violations = check.violations;
  cell.record.stability.bound_exact_violations = check.exact_violations;
  cell.stability.shortfall = images::make_image(options_.width, options_.height, check.shortfall);
  cell.stability.violation = images::make_image(options_.width, options_.height, check.violation);
}

/// Compares both at the depth that the filter itself compares with: another bias would be another bound.
metrics::BoundCheck StabilityMeter::compare_with_closer(const MeasuredCell& cell, const filters::ScalarModel& model,
                                                        const render::LightLayers& light) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double plane_max_tangent = options_.bias.plane_max_tangent();
  const std::size_t pixels = cell.visibility.texels.size();
  const bool overflowed = cell.record.stability.overflow_texels.value_or(0) > 0;
  std::vector<double> of_model(pixels, 1.0), of_closer(pixels, 1.0), tolerance(pixels, kNone);
  std::vector<std::uint8_t> excused(pixels);
  for (const render::LightSetup& layer : light) {
    const auto receivers = render::read_receivers(renderer_.shaders, assets_.gbuffer(*task_.camera), layer);
    const filters::DepthMap map = light_.map.read(layer.frustum.layer);
    const filters::ModelInput input{.spec = cell.request.spec,
                                    .values = cell.request.values,
                                    .map = map,
                                    .accuracy = measure_accuracy(renderer_),
                                    .seed = options_.seed,
                                    .plane_max_tangent = plane_max_tangent};
    const auto exact = model.prepare(input, filters::Precision::kDouble);
    const auto tracked = model.prepare(input, filters::Precision::kTracked);
    const filters::PercentageCloser closer(*model.kernel(cell.request.values), map, plane_max_tangent);
    visit_in_parallel(receivers.size(), [&](std::size_t i) {
      const filters::Receiver& r = receivers[i];
      const filters::ModelResult bounded = tracked->at(r);
      const std::size_t pixel = find_pixel(r, options_.width, options_.height);
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
  cell.record.images.stability = fmt::format("images/{}.{}.stability.png", stem, files::make_file_stem(cell.label));
  images::write_figure(options.out / *cell.record.images.stability, figure);
}

}  // namespace shadowbench::measure
