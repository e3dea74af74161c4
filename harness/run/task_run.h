#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/run/cell_analysis.h"
#include "harness/run/map_coverage.h"
#include "harness/run/run_plan.h"
#include "harness/run/scene_assets.h"
#include "report/records.h"

namespace shadowbench::run {

/// Is told how a task gets on.
struct TaskListener {
  std::function<void(const std::string& what)> show;               ///< what is under way
  std::function<void(const std::string& message)> note;            ///< something the user should know, once
  std::function<void(const SceneMeasurement& measured)> finished;  ///< cells that were written
};

/// Measures the cells of one task that are still to be measured, and writes them.
class TaskRun {
 public:
  /// Everything must outlive this object.
  TaskRun(Renderer& renderer, const PlannedScene& planned, const PlannedTask& task, SceneAssets& assets,
          const report::GlRecord& gl, const TaskListener& listener);

  /// With grids all cells are measured, drawn and written together; without, a few at a time, each written as soon as
  /// it is finished. Users' filters come first, so that a mistake in one is heard of at once. Throws Error; cells
  /// written by then stay.
  void run();

 private:
  using Requests = std::vector<filters::FilterRequest>;

  Renderer& renderer_;
  const RunOptions& options_;
  const PlannedScene& planned_;
  const SceneTask& task_;
  SceneAssets& assets_;
  const report::GlRecord& gl_;
  const TaskListener& listener_;
  std::map<std::string, std::string> contents_;  ///< by key
  std::optional<CellAnalyser> analyser_;
  std::optional<MapCoverage> coverage_;

  void run_group(const Requests& built_in, const Requests& of_users);
  SceneTask task_of(const Requests& requests) const;
  MeasuredCell measure_user_cell(const filters::FilterRequest& request);
  void explain(SceneMeasurement& measured);
  void cover(SceneMeasurement& measured);
  void write_images(const SceneTask& task, SceneMeasurement& measured);
  void draw_border_page(const SceneTask& task);
  void write_cells(SceneMeasurement& measured);
  void show(const std::string& what) const;
};

}  // namespace shadowbench::run
