#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "report/records/records.h"

namespace shadowbench::submit {

/// Expects what cells take from what measured ones took. Of one filter, seconds are taken to follow the half-width of
/// the kernel between those that are known, which its scalar model and its traced kernel grow with; of all cells, they
/// are taken to grow with the picture.
class CellCosts {
 public:
  /// Cells that have no `measured_s` tell nothing.
  explicit CellCosts(const std::vector<records::CellRecord>& measured);

  /// Seconds that a cell is expected to take; of a filter that nobody measured, what the others take on average.
  /// 1 where nothing is known at all.
  double expect_s(const records::CellRecord& cell) const;

  bool is_empty() const { return by_filter_.empty(); }

 private:
  struct Point {
    double seconds = 0.0;  ///< for a megapixel, summed
    int cells = 0;
    double mean() const { return seconds / cells; }
  };

  std::map<std::string, std::map<double, Point>> by_filter_;  ///< then by the half-width of the kernel, in texels
  Point all_;

  double expect_for_megapixel(const records::CellRecord& cell) const;
};

}  // namespace shadowbench::submit
