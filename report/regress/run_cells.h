#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "report/records/json_io.h"
#include "report/regress/comparison.h"

namespace shadowbench::regress {

/// Which cells are compared; an empty list: all.
struct Selection {
  std::vector<std::string> filters;
  std::vector<std::string> scenes;

  bool holds(const std::string& scene, const std::string& filter) const;
};

/// Reads the cells of a run with their images, file by file: an image file stays in memory while its cells are handed
/// out.
class RunCells {
 public:
  /// `folder` is the run's report folder. Throws Error(kInput) where its results cannot be read.
  RunCells(const std::filesystem::path& folder, const Selection& selection);

  const records::RunRecord& run() const { return results_.run; }
  const std::vector<records::CellRecord>& cells() const { return results_.cells; }
  const std::vector<records::CellRecord>& all_cells() const { return all_; }  ///< with those that are not compared

  /// Hands out every cell, and the truth of every view once, where there is one.
  void visit(const std::function<void(const ActualCell&)>& on_cell,
             const std::function<void(const ActualTruth&)>& on_truth) const;

 private:
  std::filesystem::path folder_;
  records::Results results_;
  std::vector<records::CellRecord> all_;

  Origin origin() const;
};

}  // namespace shadowbench::regress
