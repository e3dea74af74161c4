#include "harness/submit/sweep_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "filters/base/content_hash.h"
#include "filters/base/error.h"
#include "filters/base/temporary_files.h"
#include "harness/run/run_experiment.h"
#include "harness/run/run_plan.h"
#include "harness/submit/cell_costs.h"
#include "harness/submit/partition.h"
#include "report/records/format.h"
#include "report/records/json_io.h"

namespace shadowbench::submit {
namespace {

constexpr double kTaskSeconds = 600.0;
/// Where nobody knows what a cell takes.
constexpr double kCellsOfATask = 10.0;
/// Schedulers take arrays of 1000 unless they are told otherwise.
constexpr int kMostTasks = 1000;

/// A cell of a plan before it is measured.
struct PlannedCell {
  std::size_t task = 0;  ///< index into the plan's
  records::CellRecord record;
  std::string content;
};

/// Hears nothing but what the user should know.
class Notes : public options::Progress {
 public:
  explicit Notes(options::Progress& shown) : shown_(shown) {}
  void begin(int, int) override {}
  void show(int, const std::string&, const std::optional<options::WorkAhead>&) override {}
  void note(const std::string& message) override {
    if (message.starts_with("warning: ")) shown_.note(message);
  }

 private:
  options::Progress& shown_;
};

class SweepPlanner {
 public:
  SweepPlanner(const options::RunOptions& options, const SplitRule& rule, options::Progress& progress)
      : options_(options), rule_(rule), progress_(progress) {}

  SweepPlan make() {
    options::RunOptions all = options_;
    all.fresh = true;  // what is finished is asked of the tasks
    plan_ = run::make_plan(all, {});
    for (std::size_t i = 0; i < plan_.tasks.size(); ++i) add_cells(i);
    SweepPlan made;
    made.tasks = split_cells();
    if (options_.truth && !options_.cache.empty()) made.truths = split_views(static_cast<int>(made.tasks.size()));
    made.sweep = {.title = options_.title,
                  .settings = plan_.settings,
                  .command = options_.command,
                  .scene_cells = plan_.scene_cells,
                  .cells = plan_.cells,
                  .truths = static_cast<int>(made.truths.size()),
                  .tasks = static_cast<int>(made.tasks.size()),
                  .jobs = {}};
    return made;
  }

 private:
  const options::RunOptions& options_;
  const SplitRule& rule_;
  options::Progress& progress_;
  run::RunPlan plan_;
  std::vector<PlannedCell> cells_;

  void add_cells(std::size_t index) {
    const run::PlannedTask& task = plan_.tasks[index];
    for (std::size_t i = 0; i < task.keys.size(); ++i)
      cells_.push_back({index, measure::make_record(plan_.scenes[task.scene].options, task.task, task.task.filters[i]),
                        task.contents[i]});
  }

  std::vector<SweepTask> split_cells() {
    const CellCosts known = find_costs();
    std::vector<double> costs;
    double all_s = 0.0;
    for (const PlannedCell& cell : cells_) all_s += costs.emplace_back(known.expect_s(cell.record));
    const double usual = known.is_empty() ? plan_.cells / kCellsOfATask : all_s / kTaskSeconds;
    const int wanted =
        rule_.tasks > 0 ? rule_.tasks : static_cast<int>(std::ceil(std::clamp(usual, 1.0, 1.0 * kMostTasks)));
    std::vector<SweepTask> tasks;
    for (const options::CellRange& range : split_evenly(costs, std::min(wanted, plan_.cells)))
      tasks.push_back(make_task(TaskKind::kCells, static_cast<int>(tasks.size()) + 1, {range}));
    if (known.is_empty()) return tasks;
    for (SweepTask& task : tasks)
      for (int i = task.ranges.front().begin; i < task.ranges.front().end; ++i)
        task.seconds += costs[static_cast<std::size_t>(i)];
    return tasks;
  }

  /// Each view's stretches of cells, by what its truth depends on, in the plan's order.
  std::vector<std::vector<options::CellRange>> list_views() const {
    std::map<std::tuple<std::size_t, std::string, std::string>, std::size_t> known;
    std::vector<std::vector<options::CellRange>> views;
    int begin = 0;
    for (const run::PlannedTask& task : plan_.tasks) {
      const int end = begin + static_cast<int>(task.keys.size());
      const run::PlannedScene& scene = plan_.scenes[task.scene];
      const auto [view, is_new] =
          known.try_emplace({scene.place, scene.scene.light.name, task.task.camera->name}, views.size());
      if (is_new) views.emplace_back();
      views[view->second].push_back({begin, end});
      begin = end;
    }
    return views;
  }

  std::vector<SweepTask> split_views(int most) const {
    const auto views = list_views();
    std::vector<SweepTask> tasks;
    for (const options::CellRange& share : split_evenly(std::vector<double>(views.size(), 1.0), most)) {
      std::vector<options::CellRange> ranges;
      for (int i = share.begin; i < share.end; ++i) {
        const auto& view = views[static_cast<std::size_t>(i)];
        ranges.insert(ranges.end(), view.begin(), view.end());
      }
      std::ranges::sort(ranges, {}, &options::CellRange::begin);
      tasks.push_back(make_task(TaskKind::kTruth, static_cast<int>(tasks.size()) + 1, ranges));
    }
    return tasks;
  }

  SweepTask make_task(TaskKind kind, int number, const std::vector<options::CellRange>& ranges) const {
    SweepTask task{.kind = kind, .number = number, .ranges = ranges, .keys = {}, .content = {}};
    ContentHash content;
    for (const options::CellRange& range : ranges) {
      for (int i = range.begin; i < range.end; ++i) {
        const PlannedCell& cell = cells_[static_cast<std::size_t>(i)];
        run::add_cell(content, cell.record.key, cell.content);
        if (kind == TaskKind::kCells) task.keys.push_back(cell.record.key);
      }
    }
    task.content = content.name();
    return task;
  }

  CellCosts find_costs() {
    if (!rule_.earlier_run.empty()) {
      CellCosts known(records::read_results(rule_.earlier_run).cells);
      if (known.is_empty())
        throw Error(ErrorKind::kInput, "--times-of: none of its cells says how long it took",
                    rule_.earlier_run.string());
      return known;
    }
    return CellCosts(rule_.probe ? probe() : std::vector<records::CellRecord>());
  }

  /// Of the first view through the first map, each filter's cells of the narrowest and of the widest kernel, as
  /// indices.
  std::vector<int> choose_probes() const {
    std::map<std::string, std::pair<int, int>> ends;
    const auto width = [&](int cell) {
      return cells_[static_cast<std::size_t>(cell)].record.kernel_radius_texels.value_or(0.0);
    };
    for (int i = 0; i < plan_.cells && cells_[static_cast<std::size_t>(i)].task == 0; ++i) {
      auto& [narrow, wide] = ends.try_emplace(cells_[static_cast<std::size_t>(i)].record.filter, i, i).first->second;
      if (width(i) < width(narrow)) narrow = i;
      if (width(i) > width(wide)) wide = i;
    }
    std::vector<int> probes;
    for (const auto& [filter, pair] : ends) {
      probes.push_back(pair.first);
      if (pair.second != pair.first) probes.push_back(pair.second);
    }
    std::ranges::sort(probes);
    return probes;
  }

  /// Measures cells in a folder that goes with them. Where nothing can be drawn here, they tell nothing.
  std::vector<records::CellRecord> probe() {
    const std::vector<int> probes = choose_probes();
    const ScratchFolder folder(make_temporary_folder_path(options_.out, "worker"));
    options::RunOptions options = options_;
    options.out = folder.path();
    options.part = {options::Product::kCells, {}, plan_.scene_cells, {}};
    for (const int cell : probes) options.part.cells.push_back({cell, cell + 1});
    progress_.note(
        fmt::format("probe: measuring {} of {} cells here, to split them evenly (--times-of RUN takes an "
                    "earlier run's times, --no-probe none)",
                    probes.size(), plan_.cells));
    Notes notes(progress_);
    try {
      run::run_experiment(options, notes);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kContext) throw;
      progress_.note(fmt::format("nothing can be drawn here, so all cells count alike: {}", error.what()));
      return {};
    }
    std::vector<records::CellRecord> cells;
    for (const int cell : probes)
      cells.push_back(records::read_cell(options.out, cells_[static_cast<std::size_t>(cell)].record.key));
    return cells;
  }
};

}  // namespace

SweepPlan plan_sweep(const options::RunOptions& options, const SplitRule& rule, options::Progress& progress) {
  return SweepPlanner(options, rule, progress).make();
}

}  // namespace shadowbench::submit
