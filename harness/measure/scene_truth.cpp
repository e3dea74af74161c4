#include "harness/measure/scene_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/gtx/component_wise.hpp>
#include <iterator>

#include "filters/random.h"
#include "harness/measure/scene_measurement.h"
#include "reference/metrics/artefacts.h"
#include "reference/metrics/metric_table.h"
#include "reference/truth/occluders.h"
#include "report/images/crop.h"
#include "report/images/picture_io.h"
#include "report/records/format.h"

namespace shadowbench::measure {
namespace {

constexpr std::size_t kFewestOfPairs = 8;
constexpr const char* kFewPhases = "flicker needs eight sub-texel offsets of the map or more; see --phases";
constexpr const char* kOnePhase = "one phase of the map's grid tells nothing of the others; see --phases";

double wrap(double shift) { return shift < 0.5 ? shift : shift - 1.0; }

double draw(std::uint32_t seed, std::size_t number) {
  return filters::hash_bits(filters::hash_bits(seed) + static_cast<std::uint32_t>(number)) * 0x1p-32;
}

metrics::LinearPicture to_picture(const images::Image& image) {
  metrics::LinearPicture picture{image.width, image.height, {}};
  for (std::size_t i = 0; i + 2 < image.texels.size(); i += 3) {
    picture.pixels.push_back(
        glm::clamp(glm::vec3(image.texels[i], image.texels[i + 1], image.texels[i + 2]), 0.0f, 1.0f));
  }
  return picture;
}

/// Whether no other surface hides any of the light from a pixel and from those of its neighbours that count. Their own
/// planes may: then their rays do not agree.
bool is_open(const SceneTruth& truth, int i) {
  const int width = truth.receivers.image.width, height = truth.receivers.image.height, x = i % width, y = i / width;
  for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, height - 1); ++ny) {
    for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width - 1); ++nx) {
      const auto n = static_cast<std::size_t>(ny * width + nx);
      if (truth.mask[n] && truth.rays.area.ratio[n] != 1.0f) return false;
    }
  }
  return true;
}

void find_settled(SceneTruth& truth) {
  const std::vector<std::uint32_t>& rays = truth.rays.area.rays;
  for (std::size_t i = 0; i < rays.size(); ++i)
    truth.settled.push_back(rays[i] == truth::kRaysOfSettledPixel || is_open(truth, static_cast<int>(i)) ? 1 : 0);
}

void summarise_errors(SceneTruth& truth, const truth::TracedVisibility& area) {
  double squares = 0.0, gaps = 0.0, unanimous = 0.0, count = 0.0;
  for (std::size_t i = 0; i < truth.mask.size(); ++i) {
    if (!truth.mask[i]) continue;
    const double gap = static_cast<double>(area.visibility[i]) - static_cast<double>(area.ratio[i]);
    squares += static_cast<double>(truth.standard_errors[i]) * static_cast<double>(truth.standard_errors[i]);
    gaps += gap * gap;
    unanimous += area.unanimous[i];
    truth.lit += area.visibility[i] > 0.0f;
    truth.penumbra += truth.settled[i] == 0;
    count += 1.0;
  }
  truth.standard_error = std::sqrt(squares / count);
  truth.weight_rmse = std::sqrt(gaps / count);
  truth.unanimous = unanimous / count;
}

void note_growth(records::CellRecord& record, std::span<const std::span<const float>> images, const SceneTruth& truth) {
  const auto texel_m = record.map_scale.texel_m;
  if (texel_m) {
    record.penumbra.growth = metrics::measure_penumbra_growth({.images = images,
                                                               .truth = truth.area.texels,
                                                               .mask = truth.mask,
                                                               .width_ws = truth.penumbra_ws,
                                                               .texel_ws = *texel_m,
                                                               .columns = truth.area.width});
  }
  if (!record.penumbra.growth)
    records::explain(
        record, "penumbra",
        texel_m ? records::Absence{fmt::format("too few penumbrae are {:g} to {:g} texels wide, and of different "
                                               "widths",
                                               metrics::kGrowthLimits.least_texels, metrics::kGrowthLimits.most_texels),
                                   true}
                : records::Absence{"the renderer's map is not known"});
}

constexpr double kTellingWeight = 0.01;

std::string warn_of_weight(const records::CellRecord& record, double rmse) {
  return fmt::format(
      "{}, view {}: area-weighted and cosine-weighted truth differ by an RMSE of {}; choose with --truth-weight",
      record.scene, record.view, records::format_number(rmse));
}

}  // namespace

std::size_t count_phases_of_group(std::size_t phases) { return phases >= kFewestOfPairs && phases % 2 == 0 ? 2 : 1; }

std::vector<glm::dvec2> list_phase_shifts(int count, std::uint32_t seed) {
  if (count == 1) return {glm::dvec2(0.0)};
  const std::size_t of_group = count_phases_of_group(static_cast<std::size_t>(count));
  std::vector<glm::dvec2> shifts;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::size_t group = i / of_group;
    const double half = i % of_group == 0 ? 0.0 : 0.5;
    const glm::dvec2 start(draw(seed, 2 * group), draw(seed, 2 * group + 1));
    shifts.emplace_back(wrap(std::fmod(start.x + half, 1.0)), wrap(std::fmod(start.y + half, 1.0)));
  }
  return shifts;
}

void note_errors(records::CellRecord& record, const std::vector<metrics::ErrorStats>& phases, std::size_t group) {
  using Number = std::optional<double>& (*)(metrics::MetricValues&);
  const auto count = static_cast<double>(phases.size());
  for (const metrics::Metric& metric : metrics::metric_table()) {
    if (!metric.statistic) continue;
    double sum = 0.0, largest = 0.0;
    for (const metrics::ErrorStats& stats : phases) {
      sum += stats.*metric.statistic;
      largest = std::max(largest, stats.*metric.statistic);
    }
    std::get<Number>(metric.member)(record) = metric.statistic == &metrics::ErrorStats::max ? largest : sum / count;
  }
  std::vector<double> replicates(phases.size() / group);
  for (std::size_t i = 0; i < replicates.size() * group; ++i)
    replicates[i / group] += phases[i].rmse / static_cast<double>(group);
  record.phases = static_cast<std::int64_t>(phases.size());
  const auto interval = metrics::find_mean_interval(replicates);
  if (!interval) {
    record.absent["error.rmse_ci95"] = record.absent["error.rmse_replicates"] = kOnePhase;
    return;
  }
  record.rmse_ci95 = records::Interval{interval->low, interval->high};
  record.rmse_replicates = std::move(replicates);
}

void note_flicker(records::CellRecord& record, const std::optional<metrics::Change>& change) {
  const bool is_few = record.phases.value_or(1) < static_cast<std::int64_t>(kFewestOfPairs);
  if (is_few || !change || !change->reach) {
    record.absent["error.flicker"] = record.absent["error.flicker_ci95"] = kFewPhases;
    return;
  }
  record.error.flicker = change->value;
  record.flicker_ci95 =
      records::Interval{std::max(0.0, change->value - *change->reach), change->value + *change->reach};
}

void note_step(records::CellRecord& record, const std::optional<metrics::Change>& change) {
  record.absent["error.flicker_ci95"] = "the flicker is of one step of the camera";
  if (change)
    record.error.flicker = change->value;
  else
    record.absent["error.flicker"] = "no receiver is finite both before and after a step of the camera";
}

std::optional<metrics::FlipView> view_picture(const images::Image& picture, double pixels_per_degree) {
  assert(picture.channels == 3);
  if (!std::ranges::all_of(picture.texels, [](float value) { return std::isfinite(value); })) return std::nullopt;
  return metrics::view_for_flip(to_picture(picture), pixels_per_degree);
}

std::optional<double> find_mean(std::span<const float> values, std::span<const std::uint8_t> mask) {
  assert(mask.empty() || mask.size() == values.size());
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!mask.empty() && !mask[i]) continue;
    sum += static_cast<double>(values[i]);
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return sum / count;
}

std::optional<double> measure_mean_flip(const std::optional<metrics::FlipView>& a,
                                        const std::optional<metrics::FlipView>& b, std::span<const std::uint8_t> mask) {
  if (!a || !b) return std::nullopt;
  return find_mean(metrics::measure_flip(*a, *b), mask);
}

std::optional<double> measure_mean_flip(const images::Image& a, const images::Image& b,
                                        std::span<const std::uint8_t> mask, double pixels_per_degree) {
  return measure_mean_flip(view_picture(a, pixels_per_degree), view_picture(b, pixels_per_degree), mask);
}

SceneTruth trace_scene(truth::CachedTracer& tracer, const scene::Light& light, ViewReceivers receivers,
                       options::TruthWeight weight) {
  SceneTruth truth;
  truth.mask = receivers.mask();
  truth.receivers = std::move(receivers);
  if (!truth.receivers.any_counts()) {
    truth.absent = "no surface in view faces the light";
    truth.nothing_to_see = true;
    return truth;
  }
  truth.rays = tracer.trace_view(truth.receivers.image, scene::make_area_light(light));
  truth.hard = truth.receivers.to_image(truth.rays.hard);
  const bool is_ratio = weight == options::TruthWeight::kCosine;
  truth.ratio = truth.receivers.to_image(truth.rays.area.ratio);
  truth.area = is_ratio ? truth.ratio : truth.receivers.to_image(truth.rays.area.visibility);
  for (std::size_t i = 0; i < truth.mask.size(); ++i) {
    const float occluder_m = truth.rays.first_blockers_ws[i];
    truth.penumbra_ws.push_back(
        std::isfinite(occluder_m)
            ? static_cast<float>(scene::penumbra_width(light, truth.receivers.image.points[i].position_ws, occluder_m))
            : occluder_m);
  }
  truth.standard_errors = is_ratio ? truth.rays.area.ratio_error : truth.rays.area.standard_error;
  find_settled(truth);
  summarise_errors(truth, truth.rays.area);
  return truth;
}

images::Image make_error_image(const images::Image& visibility, const SceneTruth& truth) {
  if (!truth.absent.empty() || visibility.empty()) return {};
  return make_error_image(visibility, truth.area, truth.mask);
}

images::Image make_error_image(const images::Image& visibility, const images::Image& truth,
                               const std::vector<std::uint8_t>& mask) {
  images::Image error(visibility.width, visibility.height, 1);
  for (std::size_t i = 0; i < error.texels.size(); ++i)
    if (mask[i]) error.texels[i] = visibility.texels[i] - truth.texels[i];
  return error;
}

std::vector<metrics::ErrorStats> measure_phases(const images::Image& visibility,
                                                std::span<const images::Image> other_phases, const SceneTruth& truth,
                                                const std::vector<std::uint8_t>& mask) {
  std::vector<metrics::ErrorStats> phases;
  const auto measure = [&](const images::Image& phase) {
    if (phase.empty()) return;
    if (const auto stats = metrics::measure_error(phase.texels, truth.area.texels, mask)) phases.push_back(*stats);
  };
  measure(visibility);
  std::ranges::for_each(other_phases, measure);
  return phases;
}

void score(MeasuredCell& cell, const SceneTruth& truth) {
  records::CellRecord& record = cell.record;
  const images::Image &visibility = cell.visibility, &picture = cell.picture;
  std::vector<metrics::ErrorStats> phases;
  if (truth.absent.empty()) phases = measure_phases(visibility, {}, truth, truth.mask);
  if (phases.empty()) {
    const std::string reason = !truth.absent.empty() ? truth.absent
                               : visibility.empty()  ? record.message
                                                     : "no pixel of the image is finite";
    for (const char* group : {"error", "truth", "penumbra"})
      records::explain(record, group, {reason, truth.nothing_to_see});
    return;
  }
  std::ranges::move(measure_phases({}, cell.phases, truth, truth.mask), std::back_inserter(phases));
  // Without a phase of which nothing is finite, those that are left make no groups.
  const bool is_whole = phases.size() == cell.phases.size() + 1;
  const std::size_t group = is_whole ? count_phases_of_group(phases.size()) : 1;
  note_errors(record, phases, group);
  std::vector<std::span<const float>> images = {visibility.texels};
  for (const images::Image& phase : cell.phases)
    if (!phase.empty()) images.emplace_back(phase.texels);
  note_growth(record, images, truth);
  const std::array<std::span<const float>, 2> step{visibility.texels, cell.stepped.texels};
  if (cell.stepped.empty())
    note_flicker(record, metrics::measure_change(images, group, truth.mask));
  else
    note_step(record, metrics::measure_change(step, 1, truth.mask));
  // Of the pictures as they are saved, so that `diff` finds the same.
  images::Image& flip = cell.flip;
  if (const auto seen = view_picture(images::round_to_half(picture)); seen && truth.area_seen) {
    flip = images::Image(picture.width, picture.height, 1);
    flip.texels = metrics::measure_flip(*seen, *truth.area_seen);
  }
  record.error.flip = find_mean(flip.texels, {});
  const images::Rect tile = images::find_largest_tile(flip);
  record.images.hardest = records::TileRecord{tile.x, tile.y, tile.width, tile.height};
  if (!record.error.flip) record.absent["error.flip"] = "the picture has pixels that are not finite";
  record.truth = {truth.standard_error, truth.unanimous, truth.weight_rmse, truth.lit, truth.penumbra};
  if (truth.weight_rmse > kTellingWeight) record.warnings.push_back(warn_of_weight(record, truth.weight_rmse));
}

std::string describe_wide_scene(const scene::Scene& scene, double texel_m) {
  constexpr double kMostTexels = 0.1;
  const scene::Bounds bounds = scene.bounds();
  const float largest = glm::compMax(glm::max(glm::abs(bounds.min), glm::abs(bounds.max)));
  const double offset_m = static_cast<double>(truth::origin_offset(largest, largest));
  if (offset_m < kMostTexels * texel_m) return "";
  return fmt::format(
      "{}: the scene is too wide for single precision: rays of the truth start {} m off surfaces where a texel of the "
      "map is {} m, so that shadows lose their contacts; leave out of its file what casts no shadow into view",
      scene.name, records::format_number(offset_m), records::format_number(texel_m));
}

}  // namespace shadowbench::measure
