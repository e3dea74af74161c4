#include "harness/measure/scene_truth.h"

#include <algorithm>
#include <cmath>

#include "harness/measure/mean_flip.h"
#include "reference/metrics/error_stats.h"
#include "reference/metrics/flicker.h"
#include "report/images/picture_io.h"
#include "report/records/absence.h"

namespace shadowbench::measure {
namespace {

void summarise_errors(SceneTruth& truth, const truth::TracedVisibility& area) {
  double squares = 0.0, unanimous = 0.0, count = 0.0;
  for (std::size_t i = 0; i < truth.mask.size(); ++i) {
    if (!truth.mask[i]) continue;
    squares += static_cast<double>(area.standard_error[i]) * static_cast<double>(area.standard_error[i]);
    unanimous += area.unanimous[i];
    count += 1.0;
  }
  truth.standard_error = std::sqrt(squares / count);
  truth.unanimous = unanimous / count;
}

constexpr const char* kOnePhase = "one phase of the map's grid tells nothing of the others; see --phases";

/// Notes the mean of every error over the phases; the largest error is the largest of all.
void note_errors(records::CellRecord& record, const std::vector<metrics::ErrorStats>& phases) {
  metrics::ErrorStats sum;
  std::vector<double> rmses;
  for (const metrics::ErrorStats& stats : phases) {
    sum.rmse += stats.rmse;
    sum.mae += stats.mae;
    sum.p95 += stats.p95;
    sum.mean += stats.mean;
    sum.max = std::max(sum.max, stats.max);
    rmses.push_back(stats.rmse);
  }
  const auto count = static_cast<double>(phases.size());
  record.error.rmse = sum.rmse / count;
  record.error.mae = sum.mae / count;
  record.error.p95 = sum.p95 / count;
  record.error.max = sum.max;
  record.error.mean = sum.mean / count;
  record.phases = static_cast<std::int64_t>(phases.size());
  if (const auto interval = metrics::find_mean_interval(rmses))
    record.rmse_ci95 = records::Interval{interval->low, interval->high};
  else
    record.absent["error.rmse_ci95"] = kOnePhase;
}

}  // namespace

SceneTruth trace_scene(truth::CachedTracer& tracer, const scene::Light& light, ViewReceivers receivers) {
  SceneTruth truth;
  truth.mask = receivers.mask();
  truth.receivers = std::move(receivers);
  if (!truth.receivers.any_counts()) {
    truth.absent = records::explain_nothing_to_see("no surface in view faces the light");
    return truth;
  }
  truth.rays = tracer.trace_view(truth.receivers.image, scene::make_area_light(light));
  truth.hard = truth.receivers.to_image(truth.rays.hard);
  truth.area = truth.receivers.to_image(truth.rays.area.visibility);
  summarise_errors(truth, truth.rays.area);
  return truth;
}

images::Image make_error_image(const images::Image& visibility, const SceneTruth& truth) {
  if (!truth.absent.empty() || visibility.empty()) return {};
  images::Image error(visibility.width, visibility.height, 1);
  for (std::size_t i = 0; i < error.texels.size(); ++i)
    if (truth.mask[i]) error.texels[i] = visibility.texels[i] - truth.area.texels[i];
  return error;
}

images::Image score(records::CellRecord& record, const images::Image& visibility,
                    std::span<const images::Image> other_phases, const images::Image& picture,
                    const SceneTruth& truth) {
  std::vector<metrics::ErrorStats> phases;
  const auto measure_phase = [&](const images::Image& phase) {
    if (!truth.absent.empty() || phase.empty()) return;
    if (const auto stats = metrics::measure_error(phase.texels, truth.area.texels, truth.mask))
      phases.push_back(*stats);
  };
  measure_phase(visibility);
  if (phases.empty()) {
    const std::string reason = !truth.absent.empty() ? truth.absent
                               : visibility.empty()  ? record.message
                                                     : "no pixel of the image is finite";
    record.absent["error"] = reason;
    record.absent["truth"] = reason;
    return {};
  }
  std::ranges::for_each(other_phases, measure_phase);
  note_errors(record, phases);
  std::vector<std::span<const float>> images = {visibility.texels};
  for (const images::Image& phase : other_phases)
    if (!phase.empty()) images.emplace_back(phase.texels);
  record.error.flicker = metrics::measure_change(images, truth.mask);
  if (!record.error.flicker) record.absent["error.flicker"] = kOnePhase;
  // Of the pictures as they are saved, so that `diff` finds the same.
  images::Image flip;
  if (const auto seen = view_picture(images::round_to_half(picture)); seen && truth.area_seen) {
    flip = images::Image(picture.width, picture.height, 1);
    flip.texels = metrics::measure_flip(*seen, *truth.area_seen);
  }
  record.error.flip = find_mean(flip.texels, {});
  if (!record.error.flip) record.absent["error.flip"] = "the picture has pixels that are not finite";
  record.truth = {truth.standard_error, truth.unanimous};
  return flip;
}

}  // namespace shadowbench::measure
