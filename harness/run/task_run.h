#pragma once

#include <functional>

#include "harness/measure/scene_assets.h"
#include "harness/options/options.h"
#include "harness/run/gpu_costs.h"
#include "harness/run/run_plan.h"
#include "report/records/records.h"

namespace shadowbench::run {

/// Hears how a task proceeds.
struct TaskListener {
  options::StepListener begin;                                              ///< hears of every step
  std::function<void(const std::string& message)> note;                     ///< what the user should know
  std::function<void(const measure::SceneMeasurement& measured)> finished;  ///< cells that were written
};

/// A task, and what it is measured with.
struct TaskBench {
  measure::Renderer& renderer;
  const PlannedScene& planned;
  const PlannedTask& task;
  measure::SceneAssets& assets;
  const records::RunRecord& run;  ///< its machine and OpenGL
  const TaskListener& listener;
  GpuCosts& gpus;
};

/// Measures the cells of a task that are still to be measured, and writes them. With grids all cells are measured,
/// drawn and written together; without, a few at a time, each written as soon as it is finished. Users' filters come
/// first, so that a mistake in one is heard of at once. Throws Error; cells written by then stay.
void measure_task(const TaskBench& bench);

}  // namespace shadowbench::run
