#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "reference/metrics/metric_table.h"
#include "report/records/records.h"

namespace shadowbench::regress {

/// Lists the metrics that a baseline keeps, in the order of their table.
const std::vector<metrics::Metric>& list_compared_metrics();

/// Whether a metric is an error or a rate of faults: farther from 0 is less accurate.
bool is_error(const metrics::Metric& metric);

/// Lists the ratios to `none` that a baseline keeps: "ratio_to_none.lookup", ...
const std::vector<std::string>& list_compared_ratios();

/// Ratios of fewer rounds are no numbers to compare: six are the fewest whose whole range holds the median with 95 %,
/// for all of them lie on one side of it with probability 2^-5.
inline constexpr int kFewestRounds = 6;

/// What a baseline keeps of a cell's record: numbers by path; those that do not exist are missing.
struct ComparedValues {
  std::map<std::string, double> numbers;
  std::map<std::string, records::Ratio> ratios;
};

/// Reads these values from a record.
ComparedValues read_values(const records::CellRecord& cell);

/// Why a record lacks a number that a baseline keeps.
std::string find_absence(const records::CellRecord& cell, const std::string& path);

/// How far a number of a cell may be from its baseline, and why so far.
struct Tolerance {
  double limit = 0.0;  ///< infinite: the number is not compared
  std::string reason;
};

/// The limits on pixels, beside those on the metrics of list_compared_metrics() and on the ratios:
inline constexpr const char* kPixel =
    "visibility.pixel";  ///< how far a pixel may differ, beyond what rounding explains
inline constexpr const char* kShare = "visibility.share";  ///< share of the pixels that may differ by more
inline constexpr const char* kLargest = "visibility.max";  ///< largest difference of a pixel that is not excused
inline constexpr const char* kMean = "visibility.mean";    ///< mean magnitude of the differences of pixels not excused
inline constexpr const char* kExcused =
    "visibility.excused";  ///< by how much the share of excused pixels may exceed the baseline's
inline constexpr const char* kExcusedChanged =
    "visibility.excused_changed";                     ///< share of the excused pixels that do differ
inline constexpr const char* kLevel = "noise.level";  ///< probability that chance alone fails a test of noise

/// The tolerances of a baseline: those of all filters, and what single filters have in their place.
class Tolerances {
 public:
  /// The tolerances of a new baseline: they follow from how goldens are stored, and from single precision.
  Tolerances();

  /// A filter's tolerance. Requires a metric of list_limited_metrics().
  const Tolerance& find(const std::string& filter, const std::string& metric) const;

  /// Sets the tolerance of a filter, or of all where `filter` is empty.
  void set(const std::string& filter, const std::string& metric, Tolerance tolerance);

 private:
  std::map<std::string, std::map<std::string, Tolerance>> by_filter_;

  friend std::string write_tolerances(const Tolerances& tolerances);
};

/// Lists the metrics, ratios and limits on pixels that may have a tolerance.
const std::vector<std::string>& list_limited_metrics();

/// Reads a baseline's tolerances; what the file leaves out is as in a new baseline.
/// Throws Error(kInput), with the line, where the file is malformed, names no such metric, has a limit below 0, or
/// gives no reason.
Tolerances read_tolerances(const std::filesystem::path& file);

/// The text of such a file.
std::string write_tolerances(const Tolerances& tolerances);

}  // namespace shadowbench::regress
