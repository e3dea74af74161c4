#include "harness/run/run_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "harness/gl/objects.h"
#include "harness/measure/cell_analysis.h"
#include "harness/measure/scene_assets.h"
#include "harness/run/provenance.h"
#include "harness/run/report_pictures.h"
#include "harness/run/run_plan.h"
#include "harness/run/task_run.h"
#include "harness/run/worker_process.h"
#include "harness/spirv/webgl.h"
#include "reference/truth/cached_tracer.h"
#include "report/analysis/findings.h"
#include "report/files/folder_lock.h"
#include "report/pages/write_page.h"
#include "report/records/format.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

/// A folder that cannot be written is better found before the work than after it.
void require_writable(const std::filesystem::path& folder) { AtomicFile(folder / "cells" / "probe").write(""); }

/// A run of more cells than this takes hours, and needs --yes.
constexpr int kManyCells = 2000;
constexpr double kManySeconds = 3600.0;

/// What opens a scene in the window, as it was given here.
std::vector<std::string> list_view_words(const PlannedScene& planned) {
  std::vector<std::string> words{planned.argument};
  if (planned.options.ground) words.emplace_back("--ground");
  if (!planned.scene.light.name.empty()) words.insert(words.end(), {"--light-name", planned.scene.light.name});
  return words;
}

/// Names an empty entry of the cache, which says for the next run that a task's truths were traced.
std::string name_traces(const PlannedScene& planned, const PlannedTask& task) {
  ContentHash hash;
  hash.add(name_view(planned, *task.task.camera));
  hash.add(fmt::format("{} {} {}", task.task.map_size, scene::describe_fit(planned.options.fit),
                       planned.options.attribution));
  return hash.name();
}

class Experiment {
 public:
  Experiment(const options::RunOptions& options, options::Progress& progress)
      : options_(options),
        progress_(progress),
        renderer_(measure::make_renderer(options.backend, options.resources)),
        cache_(options.cache, [this](const std::string& message) { warn(message); }) {
    run_.commit = build_commit();
    run_.command = options.command;
    run_.seed = options.seed;
    for (const auto& file : options.filter_files) run_.filter_files[std::filesystem::path(file).stem().string()] = file;
    run_.gl = describe_gl(renderer_);
    run_.machine = describe_machine();
    progress_.note(fmt::format("OpenGL by {}: {}", run_.gl.backend, run_.gl.renderer));
    for (const std::string& reason : renderer_.refused) progress_.note("not used: " + reason);
    if (options.pictures && spirv::can_translate_to_webgl()) renderer_.recorder = std::make_unique<gl::Recorder>();
  }

  void run() {
    RunPlan plan = make_plan(options_, renderer_.context->info().renderer);
    for (PlannedTask& task : plan.tasks) task.is_traced = cache_.has(name_traces(plan.scenes[task.scene], task));
    for (const PlannedTask& task : plan.tasks)
      gl::require_texture_size("--map-size", task.task.map_size, task.task.map_size);
    announce(plan);
    lock_.emplace(options_.out, options_.force || options_.part.is_worker());
    require_writable(options_.out);
    if (plan.finished == plan.own_cells && has_report(plan)) {
      progress_.note("nothing is left to do");
      return records::write_filter_mistakes(options_.out, {});
    }
    std::ranges::for_each(plan.scenes, [&](const PlannedScene& each) { note_scene(each); });
    try {
      if (options_.part.product == options::Product::kReport) {
        check_user_filters(plan, renderer_.context->info().backend);
        records::write_filter_mistakes(options_.out, {});
      }
      measure(plan);
    } catch (const std::exception&) {
      require_in_place();  // else this is why a file cannot be written, or a cell is missing
      throw;
    }
  }

 private:
  const options::RunOptions& options_;
  options::Progress& progress_;
  measure::Renderer renderer_;
  truth::TruthCache cache_;
  records::RunRecord run_;
  std::optional<files::FolderLock> lock_;
  std::set<std::string> told_;  ///< warnings that the user has seen
  int done_ = 0;                ///< cells
  std::function<void(const std::string&)> note_ = [this](const std::string& message) { progress_.note(message); };
  TaskListener listener_{[this](const std::string& what) { progress_.show(done_, what); }, note_,
                         [this](const measure::SceneMeasurement& measured) { count(measured); }};
  GpuCosts gpus_{options_, note_};

  void require_in_place() const {
    if (lock_) lock_->require_in_place();
  }

  void measure(const RunPlan& plan) {
    done_ = plan.finished;
    progress_.begin(plan.own_cells, done_);
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t scene = 0; scene < plan.scenes.size(); ++scene) {
      run_scene(plan, scene);
      if (options_.part.product == options::Product::kReport) show_early(plan, scene + 1);
    }
    run_.work.elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    run_.work.shader_variants_compiled = renderer_.shaders.compiled();
    run_.work.truths_traced = cache_.traced();
    run_.work.truths_cached = cache_.loaded();
    finish(plan);
    progress_.show(done_, "done");
  }

  /// The page of the scenes that are measured, whenever they are twice as many: so it is there after the first, and all
  /// such pages together cost less than the last.
  void show_early(const RunPlan& plan, std::size_t scenes) {
    if (scenes == plan.scenes.size() || !std::has_single_bit(scenes)) return;
    std::vector<std::string> keys;
    for (const PlannedTask& task : plan.tasks)
      if (task.scene < scenes) keys.insert(keys.end(), task.keys.begin(), task.keys.end());
    const auto is_left = [&](const std::string& name) {
      return std::any_of(
          plan.scenes.begin() + static_cast<std::ptrdiff_t>(scenes), plan.scenes.end(),
          [&](const PlannedScene& planned) { return planned.scene.name == name; });
    };
    const auto whole = std::ranges::count_if(run_.scenes, [&](const auto& scene) { return !is_left(scene.name); });
    pages::write_early_report(options_.out, run_, records::read_cells(options_.out, keys),
                              fmt::format("The run goes on: {} of {} scenes, {} of {} cells are measured. Open this "
                                          "page again when it has ended.",
                                          whole, run_.scenes.size(), keys.size(), plan.own_cells),
                              options_.grid_width);
  }

  void finish(const RunPlan& plan) {
    progress_.show(done_, "writing the report");
    if (options_.grids && options_.pictures && !options_.part.is_worker()) draw_all_lights(options_, plan, run_.gl);
    if (!options_.part.is_worker()) {
      std::vector<records::CellRecord> cells = records::read_cells(options_.out, keep_rows(plan));
      std::ranges::for_each(cells, [&](records::CellRecord& cell) { rename_grid(cell); });
      if (options_.pictures && options_.truth) draw_supersampled_pictures(renderer_, plan, cache_, cells);
      pages::write_report(options_.out, run_, cells, options_.grid_width);
    }
    cache_.prune(truth::kMaxCacheBytes);
  }

  /// A cell that was finished before may name a grid of the other kind of file.
  void rename_grid(records::CellRecord& cell) const {
    if (!cell.images.grid) return;
    std::filesystem::path path(*cell.images.grid);
    if (path.replace_extension(options_.grid_width.in_inches ? ".svg" : ".png") == *cell.images.grid) return;
    cell.images.grid = path.generic_string();
    records::write_cell(options_.out, cell);
  }

  void count(const measure::SceneMeasurement& measured) {
    require_in_place();
    done_ += static_cast<int>(measured.cells.size());
    run_.work.timed_s += 1e-3 * measured.timed_ms;
    if (options_.truth && options_.attribution)
      run_.work.attribution_s = run_.work.attribution_s.value_or(0.0) + measured.attribution_s;
    run_.work.passes_run += measured.passes_run;
    run_.work.passes_skipped += measured.passes_skipped;
    for (const measure::MeasuredCell& cell : measured.cells) {
      for (const std::string& warning : cell.record.warnings)
        if (told_.insert(warning).second) progress_.note("warning: " + warning);
    }
  }

  /// Says how much there is to do, and asks where it is a lot.
  void announce(const RunPlan& plan) {
    run_.experiment = {options_.title, plan.settings, plan.cells, options_.part.shard, options_.part.shards};
    if (options_.part.is_worker()) return;
    const int left = plan.own_cells - plan.finished;
    std::string text = fmt::format("{} cells", plan.own_cells);
    if (options_.part.shards > 1)
      text += fmt::format(" of {}, shard {}/{}", plan.cells, options_.part.shard, options_.part.shards);
    if (plan.finished > 0)
      text += fmt::format(", {} of them finished before (--fresh measures them again)", plan.finished);
    const TimeForecast forecast = left > 0 ? forecast_time(plan) : TimeForecast();
    text += forecast.text;
    progress_.note(text);
    if ((left <= kManyCells && forecast.seconds <= kManySeconds) || options_.large_is_fine) return;
    throw Error(ErrorKind::kUsage, fmt::format("{}: add --yes to run them all, or name fewer values, or {}", text,
                                               options_.rounds.is_fixed() ? "fewer --rounds" : "a smaller --budget"));
  }

  bool is_same(const records::ExperimentRecord& known) const {
    const records::ExperimentRecord& own = run_.experiment;
    return known.settings == own.settings && known.shard == own.shard && known.shards == own.shards;
  }

  /// The words that ask for the width of grids; empty: as wide as they are without.
  static std::string find_grid_width(const std::vector<std::string>& command) {
    const auto word =
        std::ranges::find_if(command, [](const std::string& each) { return each.starts_with("--grid-width"); });
    if (word == command.end()) return "";
    const std::size_t equals = word->find('=');
    if (equals != std::string::npos) return word->substr(equals + 1);
    return word + 1 == command.end() ? "" : *(word + 1);
  }

  /// Whether the folder has the whole report of this very run already, of the very cells that lie there. Their content
  /// decides, not the times of the files: the clock may have been set in between.
  bool has_report(const RunPlan& plan) const {
    const std::filesystem::path file = options_.out / "results.json";
    if (options_.part.is_worker() || !std::filesystem::exists(file) || !pages::has_page(options_.out, "run"))
      return false;
    try {
      const records::Results results = records::read_results(file);
      const auto is_whole = [&](const std::string& key, const records::CellRecord& cell) {
        return records::to_json(records::read_cell(options_.out, key)) == records::to_json(cell);
      };
      const std::vector<std::string> keys = list_report_keys(plan, results.cells);
      return is_same(results.run.experiment) &&
             find_grid_width(results.run.command) == find_grid_width(options_.command) &&
             keys.size() == results.cells.size() &&
             std::ranges::all_of(results.cells, [&](const records::CellRecord& cell) {
               return std::ranges::count(keys, cell.key) > 0 && is_whole(cell.key, cell);
             });
    } catch (const Error&) {
      return false;
    }
  }

  static std::vector<std::string> list_keys(const RunPlan& plan) {
    std::vector<std::string> keys;
    for (const PlannedTask& task : plan.tasks) keys.insert(keys.end(), task.keys.begin(), task.keys.end());
    return keys;
  }

  /// Whether a row of another renderer was scored against what is measured now.
  static bool is_current(const RunPlan& plan, const records::CellRecord& row) {
    return std::ranges::any_of(
        plan.tasks,
        [&](const PlannedTask& task) {
          const PlannedScene& planned = plan.scenes[task.scene];
          const records::CellRecord now = measure::make_record(planned.options, task.task, {});
          return now.scene == row.scene && now.view == row.view && now.map_size == row.map_size && now.fit == row.fit &&
                 name_view(planned, *task.task.camera) == row.external->truth;
        });
  }

  /// The plan's cells, and the rows of other renderers among those of a report that still belong there.
  std::vector<std::string> list_report_keys(const RunPlan& plan, const std::vector<records::CellRecord>& cells) const {
    std::vector<std::string> keys = list_keys(plan);
    for (const records::CellRecord& cell : cells)
      if (cell.external && std::filesystem::exists(records::cell_path(options_.out, cell.key)) &&
          is_current(plan, cell))
        keys.push_back(cell.key);
    return keys;
  }

  /// Gives these keys for the report that this one replaces, whose grids were drawn again without the rows.
  std::vector<std::string> keep_rows(const RunPlan& plan) {
    std::vector<records::CellRecord> rows;
    try {
      const std::filesystem::path file = options_.out / "results.json";
      if (std::filesystem::exists(file)) rows = records::read_results(file).cells;
    } catch (const Error&) {
      // A report that cannot be read has no rows to keep.
    }
    std::erase_if(rows, [](const records::CellRecord& cell) { return !cell.external; });
    const std::vector<std::string> keys = list_report_keys(plan, rows);
    for (records::CellRecord& row : rows) {
      if (std::ranges::count(keys, row.key) == 0) {
        progress_.note(
            fmt::format("{}, {}: this row of another renderer is dropped, for what it was scored against has "
                        "changed; score it again",
                        row.filter, row.scene));
      } else if (row.images.grid) {
        row.images.grid.reset();
        row.absent["images.grid"] = "the run drew the grid again; score the row again to have it there";
        records::write_cell(options_.out, row);
      }
    }
    return keys;
  }

  void warn(const std::string& message) {
    run_.warnings.push_back(message);
    progress_.note("warning: " + message);
  }

  void note_scene(const PlannedScene& planned) {
    const scene::Scene& scene = planned.scene;
    const auto is_it = [&](const records::SceneRecord& known) { return known.name == scene.name; };
    if (std::any_of(run_.scenes.begin(), run_.scenes.end(), is_it)) return;
    run_.scenes.push_back({scene.name, scene.title, list_view_words(planned)});
    const std::string whole = scene::name_without_light(scene) + ": ";
    for (const std::string& note : scene.notes)
      if (!options_.part.is_worker() && told_.insert(whole + note).second) progress_.note(whole + note);
    for (const std::string& warning : list_scene_warnings(planned.options, scene))
      if (told_.insert(warning).second) warn(warning);
  }

  void compile(const PlannedScene& planned, const measure::SceneTask& task, measure::SceneAssets& assets) {
    const measure::LightMap& light = assets.light_map(*task.camera, task.map_size);
    for (const filters::FilterRequest& request : task.filters)
      measure::make_filter_passes(renderer_, planned.options, planned.scene, light, request);
  }

  void run_scene(const RunPlan& plan, std::size_t index) {
    const PlannedScene& planned = plan.scenes[index];
    std::optional<measure::SceneAssets> assets;
    for (const PlannedTask& each : plan.tasks) {
      if (each.scene != index || each.task.filters.empty()) continue;
      if (!assets)
        assets.emplace(renderer_, planned.options, planned.scene, cache_, measure::padding_texels(planned.options));
      if (options_.part.product == options::Product::kPrograms)
        compile(planned, each.task, *assets);
      else
        measure_task({renderer_, planned, each, *assets, run_, listener_, gpus_});
      if (options_.truth && options_.part.product != options::Product::kPrograms && !each.is_traced)
        cache_.store(name_traces(planned, each), {});
    }
  }
};

}  // namespace

void run_experiment(const options::RunOptions& options, options::Progress& progress) {
  Experiment(options, progress).run();
}

}  // namespace shadowbench::run
