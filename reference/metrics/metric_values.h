#pragma once

#include <cstdint>
#include <optional>

namespace shadowbench::metrics {

// What is measured of one cell (a scene, a view, a filter, its parameters and a map). What does not exist is empty.
// The table of metrics says what each number is; a metric's member stands here, and its row in metric_table.cpp.

/// What the units of lengths along the light are worth in a map.
struct MapScaleRecord {
  std::optional<double> texel_m;
  std::optional<double> depth_range_m;
};

/// The costs that do not depend on the machine.
struct CostRecord {
  std::optional<double> fetches;
  std::optional<std::int64_t> bytes_per_texel;
  std::optional<std::int64_t> passes;
  std::optional<std::int64_t> map_bytes;
  std::optional<std::int64_t> prefilter_texels;
};

/// The error against the truth.
struct ErrorRecord {
  std::optional<double> rmse;
  std::optional<double> mae;
  std::optional<double> p95;
  std::optional<double> max;
  std::optional<double> mean;
  std::optional<double> flip;
  std::optional<double> rmse_cascade;
  std::optional<double> kernel_rmse;
  std::optional<double> flicker;
};

/// How sure the truth itself is.
struct TruthRecord {
  std::optional<double> se;
  std::optional<double> unanimous;
  std::optional<double> weight_rmse;
  std::optional<std::int64_t> lit;
  std::optional<std::int64_t> penumbra;
};

/// How well the map's texels are spent on the view.
struct CoverageRecord {
  std::optional<double> texels_per_pixel;
  std::optional<double> fewest_texels_per_pixel;
  std::optional<double> map_used;
  std::optional<double> map_filled;
};

/// The rates of the faults that a person sees.
struct ArtefactRecord {
  std::optional<double> acne;
  std::optional<double> leak;
  std::optional<double> contact_gap;
  std::optional<double> noise;
  std::optional<double> seam;
};

/// What becomes of penumbrae.
struct PenumbraRecord {
  std::optional<double> growth;
};

/// One of the parts that the error is the sum of.
struct AttributionPart {
  std::optional<double> rms;
  std::optional<double> share;
};

/// The four parts that the error is the sum of.
struct AttributionRecord {
  AttributionPart numeric;
  AttributionPart estimator;
  AttributionPart discretisation;
  AttributionPart model;
};

/// Where a cell's numbers break, or come near to it.
struct StabilityRecord {
  std::optional<std::int64_t> overflow_texels;
  std::optional<std::int64_t> nan_texels;
  std::optional<std::int64_t> negative_variance_texels;
  std::optional<double> lowest_variance;
  std::optional<double> headroom;
  std::optional<double> safe_exponent;
  std::optional<double> half_difference_max;
  std::optional<double> half_difference_rms;
  std::optional<double> bound_shortfall_max;
  std::optional<std::int64_t> bound_violations;
  std::optional<std::int64_t> bound_exact_violations;
};

/// All numbers of the table of metrics.
struct MetricValues {
  MapScaleRecord map_scale;
  std::optional<std::int64_t> receivers;
  std::optional<std::int64_t> nan;
  CostRecord cost;
  ErrorRecord error;
  TruthRecord truth;
  CoverageRecord coverage;
  ArtefactRecord artefact;
  PenumbraRecord penumbra;
  AttributionRecord attribution;
  StabilityRecord stability;
};

}  // namespace shadowbench::metrics
