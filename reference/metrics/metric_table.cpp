#include "reference/metrics/metric_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>

#include "reference/metrics/artefacts.h"
#include "reference/metrics/flip.h"

namespace shadowbench::metrics {
namespace {

using enum MetricSource;
using enum MetricDirection;
using enum MetricBaseline;
using V = MetricValues;

/// Finds the member that a chain of members leads to.
template <auto... Chain>
auto& at(MetricValues& values) {
  return (values.*....*Chain);
}

constexpr bool kTabled = true, kUntabled = false;
constexpr MetricRange kAny{}, kPositive{0.0, {}}, kZeroToOne{0.0, 1.0};

constexpr const char* kShareOfError =
    "mean(e * part) / mean(e^2), where e is image less truth: the four shares sum to 1; a part below 0 makes up for "
    "others";

// "Truth" is the ray-traced visibility of the light's whole area. "Receivers" are pixels whose surface faces the light.
std::vector<Metric> list_errors() {
  return {
      {"error.rmse", at<&V::error, &ErrorRecord::rmse>, "visibility", kPositive, kLess, "RMSE to the area truth",
       "root mean square of image less truth, over receivers (pixels whose surface faces the light)", kError, kTabled,
       "--max-rmse", kValues, &ErrorStats::rmse},
      {"error.mae", at<&V::error, &ErrorRecord::mae>, "visibility", kPositive, kLess, "mean absolute error",
       "mean of |image less truth|, over receivers", kError, kUntabled, "", kValues, &ErrorStats::mae},
      {"error.p95", at<&V::error, &ErrorRecord::p95>, "visibility", kPositive, kLess, "95th percentile",
       "95th percentile of |image less truth|, over receivers, nearest rank", kNotKept, kUntabled, "", kValues,
       &ErrorStats::p95},
      {"error.max", at<&V::error, &ErrorRecord::max>, "visibility", kPositive, kLess, "largest error",
       "largest |image less truth|, over receivers", kNotKept, kUntabled, "", kValues, &ErrorStats::max},
      {"error.mean", at<&V::error, &ErrorRecord::mean>, "visibility", kAny, kZero, "mean signed error",
       "mean of image less truth, over receivers; positive where the image is too bright", kError, kTabled, "", kValues,
       &ErrorStats::mean},
      {"error.flip", at<&V::error, &ErrorRecord::flip>, "FLIP", kZeroToOne, kLess, "FLIP of the picture, first phase",
       fmt::format("mean LDR-FLIP of the shaded picture against the one shaded with the truth, over the whole picture, "
                   "at {} pixels per degree (Andersson et al. 2020)",
                   kDefaultPixelsPerDegree),
       kError, kUntabled, "--max-flip", kPictures},
      {"error.rmse_cascade", at<&V::error, &ErrorRecord::rmse_cascade>, "visibility", kPositive, kLess,
       "RMSE of the worst cascade",
       fmt::format("largest error.rmse of a cascade, over the receivers of which it serves the most; those with fewer "
                   "than {} are left out",
                   kFewestReceivers),
       kNotKept, kUntabled, "--max-rmse-cascade"},
      {"error.kernel_rmse", at<&V::error, &ErrorRecord::kernel_rmse>, "visibility", kPositive, kLess,
       "RMSE to the kernel truth, first phase",
       "root mean square of image less ray-traced kernel, over receivers, without the rays' sampling variance; that is "
       "the fraction of the filter's own kernel, laid on the receiver's tangent plane, that sees the light's centre",
       kError, kTabled},
      {"error.flicker", at<&V::error, &ErrorRecord::flicker>, "visibility", kPositive, kLess, "flicker",
       "root mean square of what a receiver's visibility changes by while the truth does not: where the map follows "
       "the "
       "camera, by a step of the camera to its right by half a texel of the nearest map, under the cell's own fit and "
       "snapping; where it does not, from one place of the map's texel grid to another, over pairs of places, as under "
       "a turning light",
       kNotKept, kUntabled, "--max-flicker"},
      {"truth.se", at<&V::truth, &TruthRecord::se>, "visibility", kPositive, kLess, "standard error of the truth",
       "standard error of the truth, root mean square over receivers", kKept},
      {"truth.unanimous", at<&V::truth, &TruthRecord::unanimous>, "share", kZeroToOne, kMore, "unanimous receivers",
       "receivers whose rays all agree, and which therefore have no standard error"},
      {"truth.weight_rmse", at<&V::truth, &TruthRecord::weight_rmse>, "visibility", kPositive, kNeither,
       "what weighing the truth changes",
       "root mean square, over receivers, of the share of the light's area that is seen less the share of its "
       "unshadowed light that arrives; see --truth-weight"},
      {"truth.lit", at<&V::truth, &TruthRecord::lit>, "pixels", kPositive, kNeither, "lit receivers",
       "receivers that see any of the light"},
      {"truth.penumbra", at<&V::truth, &TruthRecord::penumbra>, "pixels", kPositive, kNeither,
       "receivers at a penumbra",
       "receivers in a penumbra or beside one: those whose rays to the light disagree with each other or with a "
       "neighbour's, those below the receiver's own plane left out"},
      {"receivers", at<&V::receivers>, "pixels", kPositive, kNeither, "receivers",
       "pixels whose surface faces the light: those that count", kCount},
      {"nan", at<&V::nan>, "pixels", kPositive, kLess, "not finite", "pixels whose visibility is not finite", kCount},
  };
}

std::vector<Metric> list_map_metrics() {
  return {
      {"map_scale.texel_m", at<&V::map_scale, &MapScaleRecord::texel_m>, "m", kPositive, kNeither, "side of a texel",
       "side of a shadow-map texel", kScale},
      {"map_scale.depth_range_m", at<&V::map_scale, &MapScaleRecord::depth_range_m>, "m", kPositive, kNeither,
       "depth range", "distance between depth 0 and depth 1 of the map", kScale},
      {"coverage.texels_per_pixel", at<&V::coverage, &CoverageRecord::texels_per_pixel>, "texels", kPositive, kNeither,
       "map texels per pixel",
       "texels of the shadow map under a pixel's footprint on its receiver's tangent plane, seen along the light: "
       "median over receivers"},
      {"coverage.fewest_texels_per_pixel", at<&V::coverage, &CoverageRecord::fewest_texels_per_pixel>, "texels",
       kPositive, kNeither, "fewest map texels per pixel",
       "texels of the shadow map under a pixel's footprint, of the receiver with the fewest"},
      {"coverage.map_used", at<&V::coverage, &CoverageRecord::map_used>, "share", kZeroToOne, kMore, "map used",
       "of the map's area: what lies under the footprint of a receiver"},
      {"coverage.map_filled", at<&V::coverage, &CoverageRecord::map_filled>, "share", kZeroToOne, kNeither,
       "map filled", "of the map's texels: those that hold a caster"},
  };
}

std::vector<Metric> list_artefacts() {
  const ArtefactLimits& limits = kArtefactLimits;
  return {
      {"artefact.acne", at<&V::artefact, &ArtefactRecord::acne>, "share", kZeroToOne, kLess, "acne, first phase",
       fmt::format("of the receivers from which no other surface hides any of the area light, nor its centre from the "
                   "guard: those that the image shows darker than {} of what they see of the light, of which the "
                   "receiver's own plane may hide a part. Guard: a square on the receiver's tangent plane, of "
                   "half-width (widest kernel of the run "
                   "+ {} texel), every ray of which is traced to the light's centre",
                   limits.acne_below, limits.guard_texels),
       kRate, kTabled, "--max-acne"},
      {"artefact.leak", at<&V::artefact, &ArtefactRecord::leak>, "share", kZeroToOne, kLess, "leak, first phase",
       fmt::format(
           "of the receivers whose area light and whole guard (see acne) is blocked, by something farther than "
           "{} texels along the light: those that the image shows brighter than {}, unless the filter without any bias "
           "does not, and bias makes them brighter by more than that",
           limits.contact_texels, limits.leak_above),
       kRate, kTabled, "--max-leak"},
      {"artefact.contact_gap", at<&V::artefact, &ArtefactRecord::contact_gap>, "share", kZeroToOne, kLess,
       "contact gap, first phase",
       fmt::format(
           "of the receivers whose area light is blocked, and which the filter without any bias shows no brighter "
           "than {}: those that bias makes brighter by more than {}. Receivers whose blocker is farther than {} "
           "texels along the light count only where bias does. Blur, and a bound's own fade at contacts, light a "
           "receiver without bias too, and do not count",
           limits.contact_gap_above, limits.contact_gap_above, limits.contact_texels),
       kRate, kTabled, "--max-contact-gap"},
      {"artefact.noise", at<&V::artefact, &ArtefactRecord::noise>, "share", kZeroToOne, kLess, "noise, first phase",
       fmt::format("of the receivers in the filter's own penumbra (where its ray-traced kernel is strictly between 0 "
                   "and 1): those where image less the percentage-closer filter of that kernel differs by more than {} "
                   "from its mean over the 3x3 neighbourhood; for filters of the kind 'stochastic' only",
                   limits.noise_above),
       kRate, kTabled},
      {"artefact.seam", at<&V::artefact, &ArtefactRecord::seam>, "visibility", kPositive, kLess, "seam, first phase",
       fmt::format(
           "how much the image changes because cascades take over from each other: root mean square, over pixels on "
           "one surface, {:.2g} % of the picture's width apart, that cascades share differently, of the sum of what "
           "each "
           "cascade alone shows there times the change of its share",
           100.0 * limits.seam_step),
       kNotKept, kUntabled, "--max-seam"},
      {"penumbra.growth", at<&V::penumbra, &PenumbraRecord::growth>, "ratio", kAny, kNeither, "growth of penumbrae",
       fmt::format(
           "by how much the width of the image's penumbrae grows where the truth's grows by 1: 1 as the truth, 0 "
           "one width for all. Over tiles of {} pixels: slope of (sum of v (1 - v) of the image's mean over the "
           "phases / the truth's) x width over the width that the blockers' distance gives, where that is {:g} "
           "to {:g} texels; each length of edge weighs the same",
           kGrowthLimits.tile_pixels, kGrowthLimits.least_texels, kGrowthLimits.most_texels)},
  };
}

template <AttributionPart AttributionRecord::*Part>
void add_part(std::vector<Metric>& metrics, std::string_view rms, std::string_view share, std::string_view definition) {
  metrics.push_back({rms, at<&V::attribution, Part, &AttributionPart::rms>, "visibility", kPositive, kLess,
                     "RMS, first phase", fmt::format("root mean square of {}", definition), kError});
  metrics.push_back({share, at<&V::attribution, Part, &AttributionPart::share>, "share", kAny, kNeither,
                     "share of the error, first phase", kShareOfError});
}

std::vector<Metric> list_parts() {
  std::vector<Metric> metrics;
  add_part<&AttributionRecord::numeric>(
      metrics, "attribution.numeric.rms", "attribution.numeric.share",
      "image less double-precision model: precision, storage format, hardware filtering");
  add_part<&AttributionRecord::estimator>(
      metrics, "attribution.estimator.rms", "attribution.estimator.share",
      "double-precision model (without one the image) less brute-force percentage-closer filter with the filter's own "
      "kernel on the same map: "
      "light bleeding, noise of few taps; a bound is compared under the bias that a comparison of its kernel needs");
  add_part<&AttributionRecord::discretisation>(
      metrics, "attribution.discretisation.rms", "attribution.discretisation.share",
      "that percentage-closer filter less the ray-traced kernel, whose sampling variance is taken off: map resolution "
      "and bias");
  add_part<&AttributionRecord::model>(metrics, "attribution.model.rms", "attribution.model.share",
                                      "the ray-traced kernel, whose sampling variance is taken off, less truth: the "
                                      "kernel is not this light's penumbra");
  return metrics;
}

using S = StabilityRecord;

std::vector<Metric> list_stability() {
  return {
      {"stability.overflow_texels", at<&V::stability, &S::overflow_texels>, "texels", kPositive, kLess, "overflow",
       "texels of the encoded map that overflowed, or into which the blur mixed one that did"},
      {"stability.nan_texels", at<&V::stability, &S::nan_texels>, "texels", kPositive, kLess, "NaN texels",
       "texels of the encoded map that are NaN"},
      {"stability.negative_variance_texels", at<&V::stability, &S::negative_variance_texels>, "texels", kPositive,
       kLess, "negative variances", "texels of a map of moments whose variance is below 0 before any clamp"},
      {"stability.lowest_variance", at<&V::stability, &S::lowest_variance>, "depth^2", kAny, kMore, "lowest variance",
       "lowest variance in a map of moments, before any clamp; unit: depth squared, or what the moments are of"},
      {"stability.headroom", at<&V::stability, &S::headroom>, "ln", kAny, kMore, "headroom",
       "ln(largest number of the store) - ln(largest stored value): what exponents could grow by"},
      {"stability.safe_exponent", at<&V::stability, &S::safe_exponent>, "exponent", kPositive, kMore, "safe exponent",
       "largest value of the filter's exponent with which no texel of this map overflows"},
      {"stability.half_difference_max", at<&V::stability, &S::half_difference_max>, "visibility", kPositive, kLess,
       "largest difference of a 16-bit store",
       "visibility with the 16-bit store less that with the 32-bit store: largest magnitude"},
      {"stability.half_difference_rms", at<&V::stability, &S::half_difference_rms>, "visibility", kPositive, kLess,
       "difference of a 16-bit store",
       "visibility with the 16-bit store less that with the 32-bit store: root mean square over receivers"},
      {"stability.bound_shortfall_max", at<&V::stability, &S::bound_shortfall_max>, "visibility", kPositive, kLess,
       "largest shortfall of a bound",
       "by how much a bound is darker than the percentage-closer filter of its own kernel and depth: largest value"},
      {"stability.bound_violations", at<&V::stability, &S::bound_violations>, "pixels", kPositive, kLess,
       "violations of a bound", "receivers where a bound is darker by more than rounding explains"},
      {"stability.bound_exact_violations", at<&V::stability, &S::bound_exact_violations>, "pixels", kPositive, kLess,
       "exact violations of a bound",
       "receivers where a bound is darker in double precision too: with these parameters it is no bound"},
  };
}

std::vector<Metric> list_costs() {
  return {
      {"cost.fetches", at<&V::cost, &CostRecord::fetches>, "fetches", kPositive, kLess, "fetches per receiver",
       "mean texture fetches per receiver, counted in the shader", kCount, kTabled, "--max-fetches"},
      {"cost.bytes_per_texel", at<&V::cost, &CostRecord::bytes_per_texel>, "bytes", kPositive, kLess, "bytes per texel",
       "bytes of a texel of the map that the lookup reads", kCount, kTabled},
      {"cost.passes", at<&V::cost, &CostRecord::passes>, "passes", kPositive, kLess, "passes", "passes per frame",
       kCount, kTabled},
      {"cost.map_bytes", at<&V::cost, &CostRecord::map_bytes>, "bytes", kPositive, kLess, "bytes of the map",
       "bytes of the map that the lookup reads, mip levels included", kCount, kUntabled, "--max-bytes"},
      {"cost.prefilter_texels", at<&V::cost, &CostRecord::prefilter_texels>, "texels", kPositive, kLess,
       "prefilter texels", "texels that the prefilter writes", kCount},
  };
}

}  // namespace

std::optional<double> Metric::read(const MetricValues& values) const {
  std::optional<double> number;
  visit_metric(*this, values, [&](const std::string&, const auto& value) {
    if (value) number = static_cast<double>(*value);
  });
  return number;
}

std::span<const Metric> metric_table() {
  static const std::vector<Metric> table = [] {
    std::vector<Metric> rows;
    for (auto* list : {list_errors, list_map_metrics, list_artefacts, list_parts, list_stability, list_costs})
      std::ranges::move(list(), std::back_inserter(rows));
    return rows;
  }();
  return table;
}

const Metric& find_metric(std::string_view path) {
  const auto found = std::ranges::find(metric_table(), path, &Metric::path);
  assert(found != metric_table().end());
  return *found;
}

std::vector<Metric> picture_metrics() {
  std::vector<Metric> metrics;
  std::ranges::copy_if(metric_table(), std::back_inserter(metrics),
                       [](const Metric& metric) { return metric.source != MetricSource::kRun; });
  return metrics;
}

std::string_view describe_direction(MetricDirection direction) {
  constexpr std::string_view kTexts[] = {"less is better", "more is better", "0 is best",
                                         "neither less nor more is better"};
  return kTexts[static_cast<std::size_t>(direction)];
}

std::string describe_range(const MetricRange& range) {
  if (range.min && range.max) return fmt::format("{} .. {}", *range.min, *range.max);
  return range.min ? fmt::format("{} or more", *range.min) : "any number";
}

}  // namespace shadowbench::metrics
