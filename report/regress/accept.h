#pragma once

#include <map>
#include <string>
#include <vector>

#include "report/regress/comparison.h"

namespace shadowbench::regress {

/// Takes what differs over into the baseline; cells that did not change keep their files' content.
class Accepter {
 public:
  Accepter(Baseline& baseline, const Tolerances& tolerances) : baseline_(baseline), tolerances_(tolerances) {}

  /// Takes a cell over, and notes it. Does nothing for a cell that is the same, or that the run could not measure.
  void take(Comparison& comparison, const ActualCell& cell);
  void take(Comparison& comparison, const ActualTruth& truth);

  /// Removes a cell or a truth that the run lacks.
  void drop(Comparison& comparison);

  /// Writes what was taken over, and says what that was, a line each. Throws Error(kOutput).
  std::vector<std::string> write();

 private:
  Baseline& baseline_;
  const Tolerances& tolerances_;
  std::map<std::pair<std::string, std::string>, CellFile> files_;     ///< by scene and filter
  std::map<std::string, std::map<std::string, TruthImages>> truths_;  ///< by scene
  std::vector<std::string> lines_;

  BaselineCell make_cell(const ActualCell& cell) const;
  CellFile& file(const std::string& scene, const std::string& filter);
  std::map<std::string, TruthImages>& truths(const std::string& scene);
  void note(Comparison& comparison, const std::string& what);
};

}  // namespace shadowbench::regress
