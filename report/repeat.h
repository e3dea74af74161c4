#pragma once

#include <string>
#include <vector>

#include "report/records.h"

namespace shadowbench::report {

/// Is one ratio to `none` whose 95 % intervals in two runs of one cell do not overlap.
struct RatioApart {
  const CellRecord* a = nullptr;
  const CellRecord* b = nullptr;
  std::string ratio;  ///< "lookup", "static" or "moving"
  double gap = 0.0;   ///< between the intervals' nearer ends, over the smaller of these
};

/// Says how far the times of two runs repeat.
struct RepeatComparison {
  RepeatRecord record;
  std::vector<RatioApart> apart;  ///< the widest gap first
};

/// Compares the ratios to `none` of the cells that two runs have in common, matched by key. A ratio that either run
/// lacks is left out, and so is one that cannot differ: 1 [1, 1] of `none` itself, and `static` where it is the
/// lookup's. Requires that the cells outlive what is returned.
RepeatComparison compare_times(const std::vector<CellRecord>& a, const std::vector<CellRecord>& b);

/// Says it in a sentence's beginning: "118 of 120 ratio intervals overlap".
std::string describe_overlap(const RepeatRecord& repeat);

}  // namespace shadowbench::report
