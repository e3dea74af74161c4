#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/measure/cell_analysis.h"
#include "harness/measure/map_coverage.h"
#include "harness/measure/scene_assets.h"
#include "harness/run/gpu_costs.h"
#include "harness/run/run_plan.h"
#include "harness/run/run_progress.h"
#include "report/records/records.h"

namespace shadowbench::run {

/// Hears how a task proceeds.
struct TaskListener {
  RunProgress* progress = nullptr;
  std::function<void(const measure::SceneMeasurement& measured)> finished;  ///< cells that were written
};

/// Measures the cells of one task that are still to be measured, and writes them.
class TaskRun {
 public:
  /// Machine and OpenGL are those of `run`. Everything must outlive this object.
  TaskRun(measure::Renderer& renderer, const PlannedScene& planned, const PlannedTask& task,
          measure::SceneAssets& assets, const records::RunRecord& run, const TaskListener& listener, GpuCosts& gpus);

  /// With grids all cells are measured, drawn and written together; without, a few at a time, each written as soon as
  /// it is finished. Users' filters come first, so that a mistake in one is heard of at once. Throws Error; cells
  /// written by then stay.
  void run();

 private:
  using Requests = std::vector<filters::FilterRequest>;

  measure::Renderer& renderer_;
  const options::RunOptions& options_;
  const PlannedScene& planned_;
  const measure::SceneTask& task_;
  measure::SceneAssets& assets_;
  const records::RunRecord& run_;
  const TaskListener& listener_;
  GpuCosts& gpus_;
  std::map<std::string, std::string> contents_;  ///< by key
  options::StepListener steps_;
  std::optional<measure::CellAnalyser> analyser_;
  std::optional<measure::MapCoverage> coverage_;

  void run_group(const Requests& built_in, const Requests& of_users);
  measure::SceneTask task_of(const Requests& requests) const;
  images::Image draw_ambient();
  measure::MeasuredCell measure_user_cell(const filters::FilterRequest& request);
  void score(measure::SceneMeasurement& measured);
  void measure_coverage(measure::SceneMeasurement& measured);
  void write_images(const measure::SceneTask& task, measure::SceneMeasurement& measured);
  void draw_border_page(const measure::SceneTask& task);
  void write_cells(measure::SceneMeasurement& measured);
  void begin(options::Work kind, std::size_t cells, const std::string& what) const;
};

}  // namespace shadowbench::run
