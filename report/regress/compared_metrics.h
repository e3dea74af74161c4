#pragma once

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

}  // namespace shadowbench::regress
