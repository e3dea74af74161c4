#include "reference/metrics/metric_table.h"

#include <algorithm>
#include <iterator>

namespace shadowbench::metrics {
namespace {

using enum MetricSource;

constexpr const char* kShare =
    "mean(e * part) / mean(e^2), where e is image less truth: the four shares sum to 1; a part below 0 makes up for "
    "others";

constexpr MetricRange kAny{}, kPositive{0.0, {}}, kZeroToOne{0.0, 1.0};

// "Truth" is the ray-traced visibility of the light's whole area.
constexpr Metric kTable[] = {
    {"error.rmse", "visibility", kPositive, kValues, &ErrorStats::rmse,
     "root mean square of image less truth, over receivers (pixels whose surface faces the light)"},
    {"error.mae", "visibility", kPositive, kValues, &ErrorStats::mae, "mean of |image less truth|, over receivers"},
    {"error.p95", "visibility", kPositive, kValues, &ErrorStats::p95,
     "95th percentile of |image less truth|, over receivers, nearest rank"},
    {"error.max", "visibility", kPositive, kValues, &ErrorStats::max, "largest |image less truth|, over receivers"},
    {"error.mean", "visibility", kAny, kValues, &ErrorStats::mean,
     "mean of image less truth, over receivers; positive where the image is too bright"},
    {"error.flip", "FLIP", kZeroToOne, kPictures, nullptr,
     "mean LDR-FLIP of the shaded picture against the one shaded with the truth, over the whole picture, at 67 pixels "
     "per degree (Andersson et al. 2020)"},
    {"error.kernel_rmse", "visibility", kPositive, kRun, nullptr,
     "root mean square of image less ray-traced kernel, over receivers; that is the fraction of the filter's own "
     "kernel, laid on the receiver's tangent plane, that sees the light's centre"},
    {"truth.se", "visibility", kPositive, kRun, nullptr,
     "standard error of the truth, root mean square over receivers"},
    {"truth.unanimous", "share", kZeroToOne, kRun, nullptr,
     "receivers whose rays all agree, and which therefore have no standard error"},
    {"coverage.texels_per_pixel", "texels", kPositive, kRun, nullptr,
     "texels of the shadow map under a pixel's footprint on its receiver's tangent plane, seen along the light: median "
     "over receivers"},
    {"coverage.fewest_texels_per_pixel", "texels", kPositive, kRun, nullptr,
     "the same, of the receiver with the fewest"},
    {"coverage.map_used", "share", kZeroToOne, kRun, nullptr,
     "of the map's area: what lies under the footprint of a receiver"},
    {"coverage.map_filled", "share", kZeroToOne, kRun, nullptr, "of the map's texels: those that hold a caster"},
    {"artefact.acne", "share", kZeroToOne, kRun, nullptr,
     "of the receivers whose whole area light and whole guard is lit: those that the image shows darker than 0.9. "
     "Guard: a square on the receiver's tangent plane, of half-width (widest kernel of the run + 1 texel), every ray "
     "of which is traced to the light's centre"},
    {"artefact.leak", "share", kZeroToOne, kRun, nullptr,
     "of the receivers whose area light and whole guard (see acne) is blocked, by something farther than 8 texels "
     "along the light: those that the image shows brighter than 0.1"},
    {"artefact.contact_gap", "share", kZeroToOne, kRun, nullptr,
     "of the receivers whose area light is blocked by a surface within 8 texels along the light: those that the image "
     "shows brighter than 0.5"},
    {"artefact.noise", "share", kZeroToOne, kRun, nullptr,
     "of the receivers in the filter's own penumbra (where its ray-traced kernel is strictly between 0 and 1): those "
     "where image less the percentage-closer filter of that kernel differs by more than 0.05 from its mean over the "
     "3x3 "
     "neighbourhood; for filters of the kind 'stochastic' only"},
    {"attribution.numeric.rms", "visibility", kPositive, kRun, nullptr,
     "root mean square of image less double-precision model: precision, storage format, hardware filtering"},
    {"attribution.numeric.share", "share", kAny, kRun, nullptr, kShare},
    {"attribution.estimator.rms", "visibility", kPositive, kRun, nullptr,
     "root mean square of double-precision model less brute-force percentage-closer filter with the filter's own "
     "kernel on the same map: light bleeding, noise of few taps; a bound is compared under the bias "
     "that a comparison of its kernel needs"},
    {"attribution.estimator.share", "share", kAny, kRun, nullptr, kShare},
    {"attribution.discretisation.rms", "visibility", kPositive, kRun, nullptr,
     "root mean square of that percentage-closer filter less the ray-traced kernel: map resolution and bias"},
    {"attribution.discretisation.share", "share", kAny, kRun, nullptr, kShare},
    {"attribution.model.rms", "visibility", kPositive, kRun, nullptr,
     "root mean square of the ray-traced kernel less truth: a fixed kernel is not this light's penumbra"},
    {"attribution.model.share", "share", kAny, kRun, nullptr, kShare},
};

}  // namespace

std::span<const Metric> metric_table() { return kTable; }

std::vector<Metric> picture_metrics() {
  std::vector<Metric> metrics;
  std::copy_if(std::begin(kTable), std::end(kTable), std::back_inserter(metrics),
               [](const Metric& metric) { return metric.source != kRun; });
  return metrics;
}

}  // namespace shadowbench::metrics
