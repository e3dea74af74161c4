#include "harness/measure/scene_truth.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "harness/measure/mean_flip.h"
#include "reference/metrics/error_stats.h"
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

void score(records::CellRecord& record, const images::Image& visibility, const images::Image& picture,
           const SceneTruth& truth) {
  const auto stats = truth.absent.empty() && !visibility.empty()
                         ? metrics::measure_error(visibility.texels, truth.area.texels, truth.mask)
                         : std::nullopt;
  if (!stats) {
    const std::string reason = !truth.absent.empty() ? truth.absent
                               : visibility.empty()  ? record.message
                                                     : "no pixel of the image is finite";
    record.absent["error"] = reason;
    record.absent["truth"] = reason;
    return;
  }
  // Of the pictures as they are saved, so that `diff` finds the same.
  const auto flip = measure_mean_flip(view_picture(images::round_to_half(picture)), truth.area_seen);
  record.error = {stats->rmse, stats->mae, stats->p95, stats->max, stats->mean, flip, std::nullopt};
  if (!record.error.flip) record.absent["error.flip"] = "the picture has pixels that are not finite";
  record.truth = {truth.standard_error, truth.unanimous};
}

}  // namespace shadowbench::measure
