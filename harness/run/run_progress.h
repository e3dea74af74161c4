#pragma once

#include <mutex>
#include <string>

#include "harness/options/progress.h"
#include "harness/options/work_meter.h"
#include "harness/run/run_plan.h"

namespace shadowbench::run {

/// Weighs a run's steps, and shows how far it is: whenever something else is under way, or a thousandth more is done.
class RunProgress {
 public:
  explicit RunProgress(options::Progress& shown);

  /// Plans the work of all cells that are still to be measured.
  void plan(const RunPlan& plan);

  /// A step for so many cells of a task begins. One that the options make no work of is not shown.
  void begin(const PlannedScene& scene, const PlannedTask& task, options::Work kind, std::size_t cells,
             const std::string& what);

  /// So much of the step is done, 0 .. 1. Safe to call from many threads.
  void advance(double part);

  /// So much of one image is traced, and the step needs nobody knows how many. Safe to call from many threads.
  void advance_tracing(double part);

  /// Cells are written.
  void count(int cells);

  void begin_report();
  void finish();

  options::Progress& shown() { return shown_; }

 private:
  options::Progress& shown_;
  std::mutex mutex_;
  options::WorkMeter meter_;
  int done_ = 0;  ///< cells
  double report_cost_ = 0.0;
  std::string what_;
  double last_share_ = -1.0;
  bool finished_ = false;
  double traced_ = 0.0;  ///< of the step, by the images that are traced

  void begin_step(options::Work kind, double cost, const std::string& what);
  void show();
};

}  // namespace shadowbench::run
