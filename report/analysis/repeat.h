#pragma once

#include <string>
#include <vector>

#include "report/analysis/front.h"
#include "report/records/records.h"

namespace shadowbench::analysis {

/// One ratio to `none` whose 95 % intervals in two runs of one cell do not overlap.
struct RatioApart {
  const records::CellRecord* a = nullptr;
  const records::CellRecord* b = nullptr;
  std::string ratio;  ///< "lookup", "static" or "moving"
  double gap = 0.0;   ///< between the intervals' nearer ends, over the smaller of these
};

/// An RMSE that is clearly another one in two runs of one cell, by more than 0.0001.
struct ErrorApart {
  const records::CellRecord* a = nullptr;
  const records::CellRecord* b = nullptr;
  Estimate gap;  ///< of the second less that of the first
};

/// How far times and errors of two runs repeat.
struct RepeatComparison {
  records::RepeatRecord record;
  std::vector<RatioApart> apart;         ///< the widest gap first
  int errors = 0;                        ///< cells of which both runs have an RMSE
  std::vector<ErrorApart> errors_apart;  ///< the largest difference first
};

/// Compares the ratios to `none` of the cells that two runs have in common, matched by key. A ratio that either run
/// lacks is left out, and so is one that cannot differ: 1 [1, 1] of `none` itself, and `static` where it is the
/// lookup's. Compares their RMSEs as subtract() does. Requires that the cells outlive what is returned.
RepeatComparison compare_runs(const std::vector<records::CellRecord>& a, const std::vector<records::CellRecord>& b);

/// Says it in a sentence's beginning: "118 of 120 ratio intervals overlap".
std::string describe_overlap(const records::RepeatRecord& repeat);

}  // namespace shadowbench::analysis
