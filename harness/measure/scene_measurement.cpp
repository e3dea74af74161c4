#include "harness/measure/scene_measurement.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "filters/filter_spec.h"
#include "filters/kernel.h"
#include "filters/model.h"
#include "filters/random.h"
#include "filters/screen.h"
#include "harness/gl/survey.h"
#include "harness/measure/stability_meter.h"
#include "harness/measure/timing.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/gbuffer.h"
#include "harness/render/picture_passes.h"
#include "report/records/cell_key.h"
#include "report/records/format.h"

namespace shadowbench::measure {
namespace {

/// Whether a triangle reaches into a frustum, by its corners in clip space: not all are beyond one of its sides, or
/// beyond the far one. What is nearer than the near one is drawn at depth 0.
bool reaches_into(const std::array<glm::vec4, 3>& corners) {
  const auto all = [&](auto is_out) { return std::ranges::all_of(corners, is_out); };
  return !(all([](const glm::vec4& p) { return p.x < -p.w; }) || all([](const glm::vec4& p) { return p.x > p.w; }) ||
           all([](const glm::vec4& p) { return p.y < -p.w; }) || all([](const glm::vec4& p) { return p.y > p.w; }) ||
           all([](const glm::vec4& p) { return p.z > p.w; }));
}

/// Counts the triangles that reach into each layer; all of them where its map is curved.
double count_triangles(const scene::Scene& scene, const std::vector<scene::LightFrustum>& layers) {
  std::int64_t count = 0;
  for (const scene::LightFrustum& layer : layers) {
    for (const scene::Mesh& mesh : scene.meshes) {
      for (std::size_t i = 0; mesh.casts_shadow && i < mesh.indices.size(); i += 3) {
        std::array<glm::vec4, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
          corners[k] = layer.clip_from_world * glm::vec4(mesh.vertices[mesh.indices[i + k]].position_ws, 1.0f);
        count += scene::is_curved(layer.shape) || reaches_into(corners) ? 1 : 0;
      }
    }
  }
  return static_cast<double>(count);
}

/// Everything that one task draws with.
class SceneBench {
 public:
  SceneBench(const TaskRig& rig, const options::StepListener& listener)
      : rig_(rig),
        listener_(listener),
        light_(rig.light()),
        gbuffer_(rig.gbuffer()),
        target_("visibility", GL_R32F, rig.options.width, rig.options.height) {}

  SceneMeasurement run() {
    SceneMeasurement result;
    const std::vector<std::unique_ptr<render::FilterPasses>> filters = compile();
    StabilityMeter stability(rig_);
    for (const auto& filter : filters) {
      listener_(filter->request().label());
      result.cells.push_back(draw(*filter));
      const int prefilter = filter->prefilter_passes();
      result.passes_run += 1 + prefilter;
      result.passes_skipped += std::max(0, 3 - prefilter);
      stability.warn(result.cells.back(), *filter);
      if (rig_.options.stability) stability.measure(result.cells.back(), *filter);
      if (rig_.options.uncertainty) result.cells.back().uncertainty = measure_uncertainty(*filter);
      if (!rig_.options.truth && !rig_.options.part.is_worker()) continue;
      result.cells.back().cascades = draw_cascades(*filter);
      draw_without_bias(rig_.options, rig_.assets, light_, *filter, [&] {
        result.cells.back().unbiased = draw_visibility(*filter, light_.map, gbuffer_, target_);
      });
    }
    const double triangles = count_triangles(*rig_.task.scene, light_.layers);
    for (MeasuredCell& cell : result.cells) cell.map_triangles = triangles;
    time(result, filters);
    draw_phases(result, filters);
    warn_of_coarse_depth(result);
    if (const std::string wide = describe_wide_scene(*rig_.task.scene, light_.frustum().texel_size_ws);
        rig_.options.truth && !wide.empty())
      for (MeasuredCell& cell : result.cells) cell.record.warnings.push_back(wide);
    warn_of_small_map(result);
    rig_.renderer.context->require_no_gl_errors();
    return result;
  }

 private:
  const TaskRig& rig_;
  const options::StepListener& listener_;
  LightMap& light_;
  render::GBuffer& gbuffer_;
  render::ImageTarget target_;
  std::int64_t receivers_ = -1;
  double drawn_ms_ = 0.0;  ///< of all filters' passes, once

  /// Throws FilterErrors with what is wrong in any of the filters, before one of them is drawn.
  std::vector<std::unique_ptr<render::FilterPasses>> compile() {
    std::vector<std::unique_ptr<render::FilterPasses>> compiled;
    std::vector<filters::FilterMistake> mistakes;
    for (const filters::FilterRequest& request : rig_.task.filters) {
      try {
        compiled.push_back(rig_.make_passes(request));
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::kFilter) throw;
        mistakes.push_back({request.spec.id, request.spec.path, error.what()});
      }
    }
    if (!mistakes.empty()) throw filters::FilterErrors(std::move(mistakes));
    return compiled;
  }

  MeasuredCell draw(render::FilterPasses& filter) {
    MeasuredCell cell;
    cell.record = make_record(rig_.options, rig_.task, filter.request());
    cell.record.map_scale = {light_.frustum().texel_size_ws, light_.frustum().depth_range_ws};
    cell.request = filter.request();
    cell.label = filter.request().label();
    cell.light = filter.light();
    drawn_ms_ += time_once(filter, light_.map, gbuffer_, target_, rig_.renderer.timer);
    cell.visibility = render::read_image(target_.texture(), 1);
    cell.picture = render::shade(rig_.renderer.shaders, gbuffer_, target_.texture(), *rig_.task.scene,
                                 *rig_.task.camera, rig_.options.range);
    if (rig_.renderer.recorder) cell.frame = rig_.renderer.recorder->newest_draw();
    cell.record.nan = std::ranges::count_if(cell.visibility.texels, [](float v) { return !std::isfinite(v); });
    if (receivers_ < 0) receivers_ = render::count_receivers(rig_.renderer.shaders, gbuffer_, filter.light());
    cell.record.receivers = receivers_;
    cell.cost = filter.measure_cost(gbuffer_, light_.map);
    cell.passes = filter.list_passes(gl::pixel_format(rig_.options.map.format).bytes_per_texel);
    cell.record.cost = {.fetches = cell.cost.fetches,
                        .bytes_per_texel = cell.cost.bytes_per_texel,
                        .passes = cell.cost.passes,
                        .map_bytes = cell.cost.map_bytes,
                        .prefilter_texels = cell.cost.prefilter_texels};
    if (filter.has_screen()) cell.record.screen_reads = cell.cost.screen.per_receiver;
    if (!cell.cost.fetches) cell.record.absent["cost.fetches"] = "the filter reads the map's samplers itself";
    check_drawing(cell);
    return cell;
  }

  /// Draws the filter by each cascade alone, as if the view had no other. Requires that the filter's map was made.
  std::vector<images::Image> draw_cascades(render::FilterPasses& filter) {
    if (!std::holds_alternative<scene::ViewSlice>(light_.frustum().share)) return {};
    constexpr double kNever = 1e30;  // metres from the camera
    constexpr scene::ViewSlice kAll{-1.0, -1.0, kNever, kNever}, kNone{kNever, kNever, kNever, kNever};
    const gl::Recorder::Pause pause(rig_.renderer.recorder.get());
    const render::LightLayers own = filter.light();
    std::vector<images::Image> drawn;
    for (std::size_t i = 0; i < own.size(); ++i) {
      render::LightLayers alone = own;
      for (std::size_t other = 0; other < alone.size(); ++other) alone[other].frustum.share = other == i ? kAll : kNone;
      filter.retune(alone);
      filter.lookup(gbuffer_, light_.map, target_);
      drawn.push_back(render::read_image(target_.texture(), 1));
    }
    filter.retune(own);
    return drawn;
  }

  /// Measures how far rounding can move each pixel (filters with a scalar model), and how far other seeds move it
  /// (stochastic filters). Requires that the filter's map was made. The passes keep the run's own seed. Cost: the
  /// scalar model with its running error bound for every receiver, and images::kSpreadSeeds lookups.
  images::UncertaintyImages measure_uncertainty(render::FilterPasses& filter) {
    images::UncertaintyImages uncertainty;
    const filters::FilterSpec& spec = filter.request().spec;
    if (spec.kind == filters::FilterKind::kStochastic) uncertainty = spread_seeds(filter);
    if (const filters::ScalarModel* model = filters::find_model(spec))
      uncertainty.rounding = bound_rounding(*model, filter);
    return uncertainty;
  }

  /// Bounds what the same computation in single precision may make of each pixel.
  images::Image bound_rounding(const filters::ScalarModel& model, const render::FilterPasses& filter) {
    images::Image image(rig_.options.width, rig_.options.height, 1);
    const filters::FilterRequest& request = filter.request();
    auto picture = filters::ScreenPicture::make(model, request.spec, request.values, image.width, image.height);
    for (const render::LightSetup& layer : filter.light()) {
      const filters::DepthMap map = light_.map.read(layer.frustum.layer);
      const auto tracked =
          model.prepare(rig_.view().input(request, map, measure_accuracy(rig_.renderer)), filters::Precision::kTracked);
      const auto receivers = render::read_receivers(rig_.renderer.shaders, gbuffer_, layer);
      visit_in_parallel(receivers.size(), [&](std::size_t i) {
        const filters::ModelResult result = tracked->at(receivers[i]);
        if (picture) picture->add(receivers[i], result);
        const float of_share = receivers[i].layer_share < 1.0f ? 0x1p-23f : 0.0f;
        const float bound = result.bound < 1.0 ? static_cast<float>(result.bound) + of_share : 1.0f;
        float& pixel = image.texels[find_pixel(receivers[i], rig_.options.width, rig_.options.height)];
        pixel = result.excused ? images::kMayFlip : pixel + receivers[i].layer_share * bound;
      });
    }
    if (!picture) return image;
    picture->filter(model, request.spec, request.values, filters::Precision::kTracked);
    picture->visit_from_top([&](std::size_t i, const filters::ModelResult& result) {
      image.texels[i] = result.excused ? images::kMayFlip : static_cast<float>(std::min(result.bound, 1.0));
    });
    return image;
  }

  /// Mean and deviation of each pixel over a sample of seeds.
  images::UncertaintyImages spread_seeds(render::FilterPasses& filter) {
    const render::LightLayers own = filter.light();
    images::UncertaintyImages spread;
    spread.seed_mean = spread.seed_deviation = images::Image(rig_.options.width, rig_.options.height, 1);
    std::vector<double> sum(spread.seed_mean.texels.size()), squares(sum.size());
    for (std::uint32_t i = 1; i <= static_cast<std::uint32_t>(images::kSpreadSeeds); ++i) {
      render::LightLayers other = own;
      for (render::LightSetup& layer : other) layer.seed = filters::hash_bits(own.front().seed + i);
      filter.retune(other);
      const images::Image image = draw_visibility(filter, light_.map, gbuffer_, target_);
      for (std::size_t p = 0; p < sum.size(); ++p) {
        const double value = static_cast<double>(image.texels[p]);
        sum[p] += value;
        squares[p] += value * value;
      }
    }
    filter.retune(own);
    for (std::size_t p = 0; p < sum.size(); ++p) {
      const double n = images::kSpreadSeeds, mean = sum[p] / n;
      spread.seed_mean.texels[p] = static_cast<float>(mean);
      spread.seed_deviation.texels[p] =
          static_cast<float>(std::sqrt(std::max(squares[p] - n * mean * mean, 0.0) / (n - 1.0)));
    }
    return spread;
  }

  /// A map that holds depth in steps shadows surfaces by up to half a step, in the light's face as on a slope.
  void warn_of_coarse_depth(SceneMeasurement& result) const {
    float farthest = 0.0f;
    for (const float depth : read_linear_depth(light_.map).texels)
      farthest = depth < 1.0f ? std::max(farthest, depth) : farthest;
    const double step_m = render::find_coarsest_step(light_.map.settings(), static_cast<double>(farthest)) *
                          light_.frustum().depth_range_ws;
    const double bias_m = render::in_world(rig_.options.bias.constant, light_.frustum());
    if (bias_m == 0.0 || bias_m >= 0.5 * step_m) return;
    const std::string warning(fmt::format(
        "{}: a map stored as {} holds depth in steps of up to {} m, but the constant bias is {} m: expect "
        "acne on what faces the light; choose --bias with a constant of {} m or more, --reversed-depth with d32f, or a "
        "smaller --perspective-depth",
        rig_.task.scene->name, render::describe_map(light_.map.settings()), records::format_number(step_m),
        records::format_number(bias_m), records::format_number(0.5 * step_m)));
    for (MeasuredCell& cell : result.cells) cell.record.warnings.push_back(warning);
  }

  /// Half of a map at most is padding, and kernels wider than that read beyond it.
  void warn_of_small_map(SceneMeasurement& result) const {
    const double pad_texels = padding_texels(rig_.options);
    if (limit_padding(pad_texels, rig_.task.map_size) >= pad_texels) return;
    const std::string warning(fmt::format(
        "{}: a map of {} texels a side has no room for the {} texels that kernels need on each: "
        "choose --map-size {:.0f} or more",
        rig_.task.scene->name, rig_.task.map_size, records::format_number(pad_texels), 4.0 * pad_texels + 1.0));
    for (MeasuredCell& cell : result.cells) cell.record.warnings.push_back(warning);
  }

  void time(SceneMeasurement& result, const std::vector<std::unique_ptr<render::FilterPasses>>& filters) {
    std::vector<render::FilterPasses*> pointers;
    for (const auto& filter : filters) pointers.push_back(filter.get());
    const auto asked = std::ranges::find_if(
        rig_.task.filters, [&](const auto& request) { return filters::is_same(request, rig_.options.reference); });
    const auto reference = static_cast<std::size_t>(asked - rig_.task.filters.begin());
    std::unique_ptr<render::FilterPasses> added;
    if (asked == rig_.task.filters.end()) {
      pointers.push_back((added = rig_.make_passes(rig_.options.reference)).get());
      drawn_ms_ += time_once(*added, light_.map, gbuffer_, target_, rig_.renderer.timer);
    }
    listener_("times");
    const EmptyLookups empty = make_empty_lookups(rig_.renderer, rig_.options, *rig_.task.scene, light_, pointers);
    record_empties(result, empty);
    const gl::Recorder::Pause pause(rig_.renderer.recorder.get());
    const RoundTimes times = time_rounds(
        {.filters = pointers,
         .empties = empty.passes,
         .draw_map = [&] { rig_.assets.redraw(light_); },
         .map = light_.map,
         .gbuffer = gbuffer_,
         .timer = rig_.renderer.timer},
        {.reference = reference, .limits = rig_.options.rounds, .seed = rig_.options.seed, .drawn_ms = drawn_ms_});
    result.timed_ms = times.spent_ms;
    for (std::size_t i = 0; i < filters.size(); ++i) {
      note_times(result.cells[i].record, times, {i, reference, empty.of_filter[i]});
      result.cells[i].empty_lookup = empty.passes[empty.of_filter[i]]->list_passes(0).front();
      result.cells[i].empty_lookup.name = "empty";
    }
  }

  /// Has the empty lookups written down, each drawn once.
  void record_empties(SceneMeasurement& result, const EmptyLookups& empty) {
    if (!rig_.renderer.recorder) return;
    std::vector<gl::StepPointer> drawn;
    for (const auto& passes : empty.passes) {
      passes->lookup(gbuffer_, light_.map, target_);
      drawn.push_back(rig_.renderer.recorder->newest_draw());
    }
    for (std::size_t i = 0; i < result.cells.size(); ++i) result.cells[i].empty_frame = drawn[empty.of_filter[i]];
  }

  /// Draws every filter again with the map's grid moved by parts of a texel, and after a step of the camera. The passes
  /// stay turned to the last of these maps.
  void draw_phases(SceneMeasurement& result, const std::vector<std::unique_ptr<render::FilterPasses>>& filters) {
    const gl::Recorder::Pause pause(rig_.renderer.recorder.get());
    const std::vector<glm::dvec2> shifts = list_phase_shifts(rig_.options.phases, rig_.options.seed);
    if (shifts.size() > 1) listener_("phases");
    for (std::size_t phase = 1; phase < shifts.size(); ++phase) {
      gbuffer_.forget_receivers();  // no phase asks for those of another
      const LightMap moved =
          rig_.assets.make_light_map(rig_.task.scene->light, *rig_.task.camera, rig_.task.map_size, shifts[phase]);
      for (std::size_t i = 0; i < filters.size(); ++i)
        result.cells[i].phases.push_back(draw_turned(*filters[i], moved));
    }
    gbuffer_.forget_receivers();
    if (!rig_.options.truth && !rig_.options.part.is_worker()) return;
    if (const auto moved = rig_.assets.make_stepped_map(*rig_.task.camera, rig_.task.map_size)) {
      for (std::size_t i = 0; i < filters.size(); ++i) result.cells[i].stepped = draw_turned(*filters[i], *moved);
      gbuffer_.forget_receivers();
    }
  }

  images::Image draw_turned(render::FilterPasses& filter, const LightMap& light) {
    filter.retune(make_filter_light(rig_.options, rig_.task.scene->light, light.layers, filter.request()));
    return draw_visibility(filter, light.map, gbuffer_, target_);
  }
};

void set_kernel(records::CellRecord& record, const filters::FilterRequest& request) {
  record.kernel_radius_texels = filters::radius_texels(request.spec, request.values);
  record.kernel = records::make_kernel_record(filters::find_kernel_sigma(request.spec, request.values));
  if (request.width == filters::kLightWidth) {
    record.kernel.width_class = request.width;
    record.kernel.light_texels = request.light_sigma_texels;
    if (const std::string* name = request.param_by_light()) record.kernel.by_light = *name;
  }
  if (!record.kernel.sigma_texels)
    record.absent[record.kernel.width_class ? "kernel.sigma_texels" : "kernel"] =
        filters::explain_no_kernel(request.spec, request.values);
  else if (!record.kernel.width_class)
    record.absent["kernel.class"] =
        fmt::format("kernels of more than {:.2f} texels have none", filters::width_classes().back().widest_texels);
}

using records::format_number;

constexpr float kRounding = 1e-5f;             // of a sum of weights in single precision
constexpr double kReachRoundingTexels = 0.01;  // of an offset that was turned or taken from a uv

void suspect(MeasuredCell& cell, const std::string& sentence) {
  records::CellRecord& record = cell.record;
  record.status = records::CellStatus::kSuspect;
  record.suspect_of.push_back(sentence);
  record.message = fmt::format("{}", fmt::join(record.suspect_of, "; "));
  record.warnings.push_back(fmt::format("{}: {} is suspect: {}", record.scene, cell.label, sentence));
}

/// The least and the largest finite value; in the wrong order where no value is finite.
struct ValueSpan {
  float least = std::numeric_limits<float>::max();
  float most = std::numeric_limits<float>::lowest();

  void add(float value) {
    if (!std::isfinite(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

void check_values(MeasuredCell& cell) {
  const std::int64_t broken = cell.record.nan.value_or(0);
  if (broken > 0) {
    suspect(cell, fmt::format("{} pixels are not finite; look for a division by 0, and for numbers too large for the "
                              "format of the map",
                              broken));
  }
  ValueSpan span;
  for (const float value : cell.visibility.texels) span.add(value);
  if (span.least >= -kRounding && span.most <= 1.0f + kRounding) return;
  if (span.least > span.most) return;
  suspect(cell,
          fmt::format("its visibility lies between {} and {}, which should be 0 for blocked and 1 for lit; divide "
                      "by the sum of the weights, or clamp",
                      format_number(static_cast<double>(span.least)), format_number(static_cast<double>(span.most))));
}

void check_reads(MeasuredCell& cell) {
  const render::FilterCost& cost = cell.cost;
  const filters::FilterSpec& spec = cell.request.spec;
  if (spec.reads_unwritten) {
    suspect(cell,
            "it reads the encoded map, but no encode() writes one; write encode(), or call fetch_depth or "
            "compare_nearest");
  }
  for (const std::string& screen : cost.screen.exceeded)
    suspect(cell, fmt::format("its screen pass {}; declare what it reads, or read less", screen));
  if (!cost.reach_texels) return;
  if (*cost.fetches == 0.0)
    suspect(cell,
            "it reads nothing from the map; call compare_nearest, compare_2x2, fetch_depth, fetch_map or a gather");
  const double declared = filters::reach_texels(spec, cell.request.values);
  if (*cost.reach_texels <= declared + kReachRoundingTexels) return;
  suspect(cell,
          fmt::format("it reads texels up to {} texels from the receiver, but its radius_texels declares {}: bias "
                      "and the map's margin are made for that; declare what it reads, a texel for the four of a "
                      "2x2 fetch included, or move the taps",
                      format_number(*cost.reach_texels), format_number(declared)));
}

/// A GL that ends a loop too early says nothing, and the image is wrong.
void check_loops(MeasuredCell& cell) {
  constexpr int kFewestOfAnyLimit = 10'000;
  if (cell.cost.most_turns < kFewestOfAnyLimit) return;
  const int limit = gl::measure_loop_turns();
  if (limit == 0 || cell.cost.most_turns < limit) return;
  suspect(cell, fmt::format("one of its loops goes on after {} turns, where this GL ends it without a word; write one "
                            "that ends sooner",
                            limit));
}

}  // namespace

std::string describe_light(const scene::SkyAngles& light) {
  return fmt::format("{},{}", light.azimuth_deg, light.elevation_deg);
}

records::CellRecord make_record(const options::RunOptions& options, const SceneTask& task,
                                const filters::FilterRequest& request) {
  records::CellRecord record;
  record.scene = task.scene->name;
  record.view = task.camera->name;
  record.filter = request.spec.id;
  record.params = request.values;
  set_kernel(record, request);
  record.teaching = request.spec.teaching;
  record.claims = request.spec.claims;
  record.map_size = task.map_size;
  record.map_format = render::describe_map(options.map);
  record.fit = scene::describe_fit(options.fit) + (options.snap ? " snapped" : "");
  if (options.light) record.light = describe_light(*options.light);
  record.bias = options.bias;
  record.range = options.range;
  if (!options.stability)
    record.absent["stability"] = record.absent["images.stability"] = "the run was made without --stability";
  record.width = options.width;
  record.height = options.height;
  record.key = records::cell_key(record);
  return record;
}

SceneMeasurement measure_scene(const TaskRig& rig, const options::StepListener& listener) {
  return SceneBench(rig, listener).run();
}

void check_drawing(MeasuredCell& cell) {
  check_values(cell);
  check_reads(cell);
  check_loops(cell);
}

void check_against_truth(MeasuredCell& cell, const SceneTruth& truth) {
  if (!truth.absent.empty() || cell.visibility.empty()) return;
  ValueSpan span;
  int lit = 0, blocked = 0;
  for (std::size_t i = 0; i < truth.mask.size(); ++i) {
    if (!truth.mask[i]) continue;
    span.add(cell.visibility.texels[i]);
    lit += truth.ratio.texels[i] == 1.0f;
    blocked += truth.area.texels[i] == 0.0f;
  }
  if (std::min(lit, blocked) < metrics::kFewestReceivers || span.least > span.most) return;
  if (span.most - span.least > kRounding) return;
  suspect(cell, fmt::format("its visibility is {} at every receiver, though {} of them are wholly lit in truth and {} "
                            "wholly blocked; let it depend on how r.depth compares with the map, and check that --bias "
                            "is not larger than the scene",
                            format_number(static_cast<double>(span.least)), lit, blocked));
}

}  // namespace shadowbench::measure
