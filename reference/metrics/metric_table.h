#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "reference/metrics/error_stats.h"

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

/// Finds a metric's value, which is a real number or a count.
using MetricMember =
    std::variant<std::optional<double>& (*)(MetricValues&), std::optional<std::int64_t>& (*)(MetricValues&)>;

/// The least and largest value that a metric can have; empty: there is none.
struct MetricRange {
  std::optional<double> min;
  std::optional<double> max;
};

/// Which values of a metric are better.
enum class MetricDirection {
  kLess,     ///< smaller values
  kMore,     ///< larger values
  kZero,     ///< values near 0; the sign says to which side an image is wrong
  kNeither,  ///< none: the metric describes what was measured
};

/// What a metric is measured from.
enum class MetricSource {
  kRun,       ///< a scene, its rays and models: `shadowbench run` alone has them
  kValues,    ///< the values of two pictures, pixel by pixel: measure_error()
  kPictures,  ///< two whole pictures: measure_flip()
};

/// What a baseline keeps of a metric, and how far a run may be from it.
enum class MetricBaseline {
  kNotKept,  ///< the pixels themselves say more
  kKept,     ///< kept for the other tolerances, and not compared itself
  kError,    ///< a mean of errors: it moves by what the pixels may move by
  kRate,     ///< a share of receivers: one of them may fall on the other side of a limit
  kCount,    ///< the same to the last digit
  kScale,    ///< a length, the same but for rounding
};

/// One number of a cell.
struct Metric {
  std::string_view path;  ///< in results.json: "error.rmse", "attribution.numeric.share"
  MetricMember member;
  std::string_view unit;
  MetricRange range;
  MetricDirection direction;
  std::string_view title;  ///< a few words for tables and axes
  std::string definition;
  MetricBaseline baseline = MetricBaseline::kNotKept;
  bool tabled = false;          ///< has a column in the tables for people
  std::string_view limit = {};  ///< the option of `advise` that limits it: "--max-rmse"; empty: none
  MetricSource source = MetricSource::kRun;
  double ErrorStats::*statistic = nullptr;  ///< where measure_error() puts it; null for other sources

  /// The path up to its first dot: "error"; empty where it has none.
  std::string_view group() const { return path.substr(0, path.find('.') == path.npos ? 0 : path.find('.')); }
  /// The path without its group: "rmse", "numeric.share".
  std::string_view name() const { return path.substr(path.find('.') + 1); }
  /// The value as a number, where it exists.
  std::optional<double> read(const MetricValues& values) const;
};

/// Calls `visit(path, value)` with a metric's optional value.
template <class Values, class Visitor>
void visit_metric(const Metric& metric, Values& values, Visitor&& visit) {
  std::visit(
      [&](auto member) {
        // The members only find their value: what is const stays so.
        auto& value = member(const_cast<MetricValues&>(static_cast<const MetricValues&>(values)));
        if constexpr (std::is_const_v<Values>)
          visit(std::string(metric.path), std::as_const(value));
        else
          visit(std::string(metric.path), value);
      },
      metric.member);
}

/// All metrics, in the order in which they are listed: the one list of metrics that there is.
std::span<const Metric> metric_table();

/// The metric of a path. Requires that the table has it.
const Metric& find_metric(std::string_view path);

/// The metrics that two pictures are enough for, in the order of the table.
std::vector<Metric> picture_metrics();

/// Names a direction: "less is better".
std::string_view describe_direction(MetricDirection direction);

/// Names a range: "0 .. 1", "0 or more", "any number".
std::string describe_range(const MetricRange& range);

}  // namespace shadowbench::metrics
