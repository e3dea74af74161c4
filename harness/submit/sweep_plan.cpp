#include "harness/submit/sweep_plan.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "base/content_hash.h"
#include "harness/run/run_plan.h"

namespace shadowbench::submit {
namespace {

/// Schedulers take arrays of 1000 unless they are told otherwise.
constexpr double kMostTasks = 1000.0;

using Ranges = std::vector<options::CellRange>;

run::RunPlan list_all_cells(options::RunOptions options) {
  options.fresh = true;  // what is finished is asked of the tasks
  return run::make_plan(options, {});
}

/// Each view's stretches of cells, by what its truth depends on, in the plan's order.
std::vector<Ranges> list_views(const run::RunPlan& plan) {
  std::map<std::tuple<std::size_t, std::string, std::string>, std::size_t> known;
  std::vector<Ranges> views;
  int begin = 0;
  for (const run::PlannedTask& task : plan.tasks) {
    const int end = begin + static_cast<int>(task.keys.size());
    const run::PlannedScene& scene = plan.scenes[task.scene];
    const auto [view, is_new] =
        known.try_emplace({scene.place, scene.scene.light.name, task.task.camera->name}, views.size());
    if (is_new) views.emplace_back();
    views[view->second].push_back({begin, end});
    begin = end;
  }
  return views;
}

/// Key and content of every cell.
using CellNames = std::vector<std::pair<std::string, std::string>>;

CellNames name_cells(const run::RunPlan& plan) {
  CellNames names;
  for (const run::PlannedTask& task : plan.tasks)
    for (std::size_t i = 0; i < task.keys.size(); ++i) names.emplace_back(task.keys[i], task.contents[i]);
  return names;
}

SweepTask make_task(TaskKind kind, std::size_t number, Ranges ranges, const CellNames& cells) {
  SweepTask task{
      .kind = kind, .number = static_cast<int>(number), .ranges = std::move(ranges), .keys = {}, .content = {}};
  ContentHash content;
  for (const options::CellRange& range : task.ranges) {
    for (int i = range.begin; i < range.end; ++i) {
      const auto& [key, cell_content] = cells[static_cast<std::size_t>(i)];
      run::add_cell(content, key, cell_content);
      if (kind == TaskKind::kCells) task.keys.push_back(key);
    }
  }
  task.content = content.name();
  return task;
}

/// The cells of some views, ascending.
Ranges join_views(const std::vector<Ranges>& views, const options::CellRange& which) {
  Ranges ranges;
  for (int i = which.begin; i < which.end; ++i) {
    const Ranges& view = views[static_cast<std::size_t>(i)];
    ranges.insert(ranges.end(), view.begin(), view.end());
  }
  std::ranges::sort(ranges, {}, &options::CellRange::begin);
  return ranges;
}

}  // namespace

SweepPlan plan_sweep(const options::RunOptions& options, int tasks) {
  const run::RunPlan plan = list_all_cells(options);
  const CellNames cells = name_cells(plan);
  const int usual = static_cast<int>(std::min(std::ceil(2.0 * std::sqrt(plan.cells)), kMostTasks));
  SweepPlan made;
  for (const options::CellRange& range : split_evenly(plan.cells, tasks > 0 ? tasks : usual))
    made.tasks.push_back(make_task(TaskKind::kCells, made.tasks.size() + 1, {range}, cells));
  if (options.truth && !options.cache.empty()) {
    const std::vector<Ranges> views = list_views(plan);
    for (const options::CellRange& some :
         split_evenly(static_cast<int>(views.size()), static_cast<int>(made.tasks.size())))
      made.truths.push_back(make_task(TaskKind::kTruth, made.truths.size() + 1, join_views(views, some), cells));
  }
  made.sweep = {.title = options.title,
                .settings = plan.settings,
                .command = options.command,
                .scene_cells = plan.scene_cells,
                .cells = plan.cells,
                .truths = static_cast<int>(made.truths.size()),
                .tasks = static_cast<int>(made.tasks.size()),
                .jobs = {}};
  return made;
}

std::vector<options::CellRange> split_evenly(int things, int parts) {
  parts = std::min(parts, things);
  Ranges ranges;
  for (int begin = 0, part = 1; part <= parts; ++part) {
    const int end = static_cast<int>(std::int64_t{things} * part / parts);
    ranges.push_back({begin, end});
    begin = end;
  }
  return ranges;
}

}  // namespace shadowbench::submit
