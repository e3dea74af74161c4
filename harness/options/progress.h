#pragma once

#include <functional>
#include <optional>
#include <string>

#include "harness/options/work_meter.h"

namespace shadowbench::options {

/// Receives how far a run is; the command line shows it.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A run of `cells` cells begins, of which `finished` were finished before.
  virtual void begin(int cells, int finished) = 0;
  /// The cell named is under way, `done` cells are finished; `ahead` where the work is weighed, not counted.
  virtual void show(int done, const std::string& what, const std::optional<WorkAhead>& ahead) = 0;
  void show(int done, const std::string& what) { show(done, what, std::nullopt); }
  /// The user should know this; it is shown once.
  virtual void note(const std::string& message) = 0;
};

/// Hears of the steps of a piece of work.
struct StepListener {
  /// A step of this kind for so many cells begins; `what` names it.
  std::function<void(Work kind, std::size_t cells, const std::string& what)> begin = [](Work, std::size_t,
                                                                                        const std::string&) {};
  std::function<void(double part)> advance = [](double) {};  ///< so much of it is done, 0 .. 1
};

}  // namespace shadowbench::options
