#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::regress {

/// Says what a change of a number means.
enum class MetricRole {
  kError,  ///< away from 0 is less accurate
  kCost,   ///< a change of what the filter does
  kCount,  ///< a change of what it was measured on
};

/// Is one number of a cell that a baseline keeps.
struct ComparedMetric {
  std::string path;  ///< as in results.json: "error.rmse"
  MetricRole role;
};

/// Lists the numbers that a baseline keeps, in the order of the record.
const std::vector<ComparedMetric>& list_compared_metrics();

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

/// Takes them out of a record.
ComparedValues read_values(const records::CellRecord& cell);

/// Says why a record lacks a number: its own reason, that of its group, or "not measured".
std::string find_absence(const records::CellRecord& cell, const std::string& path);

}  // namespace shadowbench::regress
