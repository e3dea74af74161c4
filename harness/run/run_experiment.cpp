#include "harness/run/run_experiment.h"

#include <fmt/format.h>
#include <malloc.h>
#include <tbb/parallel_for_each.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/error.h"
#include "base/files.h"
#include "base/folder_lock.h"
#include "harness/gl/objects.h"
#include "harness/measure/accumulation.h"
#include "harness/measure/cell_analysis.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/scene_measurement.h"
#include "harness/measure/stability_meter.h"
#include "harness/measure/traffic_meter.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/picture_passes.h"
#include "harness/run/float_images.h"
#include "harness/run/gpu_costs.h"
#include "harness/run/provenance.h"
#include "harness/run/report_pictures.h"
#include "harness/run/run_plan.h"
#include "harness/run/task_images.h"
#include "harness/run/worker_process.h"
#include "harness/spirv/spirv.h"
#include "reference/truth/cached_tracer.h"
#include "report/analysis/findings.h"
#include "report/images/text.h"
#include "report/pages/write_page.h"
#include "report/records/format.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

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

/// Passes of so many filters are kept at once: a run's memory does not grow with its cells.
constexpr std::size_t kFiltersAtOnce = 12;

/// Seconds since this was made.
class Stopwatch {
 public:
  double read_s() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Files that are written while other work goes on. Ends with the last job under way; where something else has failed
/// by then, that is told alone.
class FilesBeside {
 public:
  FilesBeside() = default;
  FilesBeside(const FilesBeside&) = delete;
  FilesBeside& operator=(const FilesBeside&) = delete;
  ~FilesBeside() {
    group_.cancel();
    try {
      group_.wait();
    } catch (const std::exception&) {
      // wait() was not reached.
    }
  }

  void write(std::vector<FileJob> jobs) {
    for (FileJob& job : jobs) group_.run(std::move(job));
  }

  /// Throws what a job threw.
  void wait() { group_.wait(); }

 private:
  tbb::task_group group_;
};

/// Measures the cells of a task that are still to be measured, and writes them. With grids all cells are measured,
/// drawn and written together; without, a few at a time, each written as soon as it is finished. Users' filters come
/// first, so that a mistake in one is heard of at once. Throws Error; cells written by then stay.
class TaskRun {
 public:
  explicit TaskRun(const TaskBench& bench)
      : bench_(bench),
        rig_{bench.renderer, bench.planned.options, bench.task.task, bench.assets},
        options_(rig_.options),
        task_(rig_.task),
        listener_(bench.listener) {
    for (std::size_t i = 0; i < task_.filters.size(); ++i)
      contents_[measure::make_record(options_, task_, task_.filters[i]).key] = bench.task.contents[i];
  }

  void run() {
    Requests built_in, of_users;
    for (const filters::FilterRequest& request : task_.filters)
      (request.user_file && !options_.part.is_worker() ? of_users : built_in).push_back(request);
    if (options_.grids) {
      run_group(built_in, of_users);
      return;
    }
    for (const filters::FilterRequest& request : of_users) run_group({}, {request});
    const std::size_t groups = (built_in.size() + kFiltersAtOnce - 1) / kFiltersAtOnce;
    for (std::size_t i = 0; i < groups; ++i) {
      const auto at = [&](std::size_t group) {
        return built_in.begin() + static_cast<std::ptrdiff_t>(group * built_in.size() / groups);
      };
      run_group({at(i), at(i + 1)}, {});
    }
  }

 private:
  using Requests = std::vector<filters::FilterRequest>;

  const TaskBench& bench_;
  const measure::TaskRig rig_;
  const options::RunOptions& options_;
  const measure::SceneTask& task_;
  const TaskListener& listener_;
  std::map<std::string, std::string> contents_;  ///< by key
  std::optional<measure::CellAnalyser> analyser_;
  std::optional<measure::MapCoverage> coverage_;
  std::optional<measure::TrafficMeter> traffic_;
  std::optional<measure::AccumulationMeter> accumulation_;

  measure::SceneTask task_of(const Requests& requests) const {
    return {task_.scene, task_.camera, task_.map_size, requests};
  }
  measure::TaskRig rig_of(const measure::SceneTask& task) const { return {rig_.renderer, options_, task, rig_.assets}; }

  void run_group(const Requests& built_in, const Requests& of_users) {
    const Stopwatch watch;
    std::vector<measure::MeasuredCell> user_cells;
    for (const filters::FilterRequest& request : of_users) user_cells.push_back(measure_user_cell(request));
    measure::SceneMeasurement measured;
    if (!built_in.empty())
      measured = measure::measure_scene(rig_of(task_of(built_in)), [this](const std::string& what) { begin(what); });
    const measure::LightMap& light = rig_.light();
    measured.stored_map = light.map.read_picture();
    measured.depth_map = measure::read_linear_depth(light.map);
    if (!task_.scene->light.name.empty()) measured.ambient = draw_ambient();
    for (measure::MeasuredCell& cell : user_cells) measured.cells.push_back(std::move(cell));
    for (measure::MeasuredCell& cell : measured.cells) {
      cell.record.measured_s = 0.0;
      cell.record.machine = records::kind_of(bench_.run.machine, bench_.run.gl);
    }
    measure::SceneTask all = task_of(built_in);
    all.filters.insert(all.filters.end(), of_users.begin(), of_users.end());
    if (!options_.part.is_worker()) score(measured);
    measure_coverage(measured);
    if (options_.frames > 1) accumulate(measured, built_in.size());
    FilesBeside files;  // after what its jobs read
    start_pictures(all, measured, files);
    if (!options_.gpus.empty()) begin("costs on GPUs");
    if (bench_.gpus.compile(measured.cells)) count_traffic(measured);
    bench_.gpus.add_to(measured.cells);
    if (options_.pictures) begin("pictures");
    write_images(rig_of(all), measured);
    files.wait();
    const double shared_s = watch.read_s() - measured.truth_s - measured.attribution_s;
    for (measure::MeasuredCell& cell : measured.cells)
      *cell.record.measured_s += shared_s / static_cast<double>(measured.cells.size());
    write_cells(measured);
    malloc_trim(0);  // else the next task's memory comes on top of what is free
  }

  images::Image draw_ambient() {
    render::ImageTarget dark("no light", GL_R32F, options_.width, options_.height);
    dark.clear(glm::vec4(0.0f));
    return render::shade(rig_.renderer.shaders, rig_.gbuffer(), dark.texture(), *task_.scene, *task_.camera,
                         options_.range);
  }

  measure::MeasuredCell measure_user_cell(const filters::FilterRequest& request) {
    begin(request.label());
    return measure_user_filter(options_, task_, request,
                               {bench_.planned.argument, rig_.renderer.context->info().backend});
  }

  /// Scores each cell against the truth, and takes its error apart.
  void score(measure::SceneMeasurement& measured) {
    if (options_.truth) begin("truth");
    Stopwatch watch;
    const measure::SceneTruth& truth = rig_.truth();
    measured.truth_s = watch.read_s();
    if (options_.truth) begin("artefacts");
    watch = {};
    if (!analyser_) analyser_.emplace(rig_, truth);
    measured.truth_s += watch.read_s();
    if (options_.truth) begin("errors");
    tbb::parallel_for_each(measured.cells, [&](measure::MeasuredCell& cell) {
      measure::score(cell, truth);
      analyser_->note_cascades(cell);
      cell.phases.clear();
      cell.stepped = {};
      measure::check_against_truth(cell, truth);
    });
    for (measure::MeasuredCell& cell : measured.cells) {
      if (options_.truth && options_.attribution) begin("attribution of " + cell.label);
      watch = {};
      analyser_->analyse(cell);
      cell.cascades.clear();
      cell.record.measured_s = watch.read_s();
      measured.attribution_s += *cell.record.measured_s;
    }
    measured.masks = analyser_->masks();
    rig_.gbuffer().forget_receivers();
    if (options_.grids) analyser_.reset();  // no other group needs it
    malloc_trim(0);                         // of rays, before the pictures
  }

  /// Accumulates the first cells over frames: those that are drawn in this process.
  void accumulate(measure::SceneMeasurement& measured, std::size_t count) {
    const gl::Recorder::Pause pause(rig_.renderer.recorder.get());
    const std::string& absent = rig_.truth().absent;
    if (absent.empty() && count > 0 && !accumulation_) accumulation_.emplace(rig_);
    const std::string picture = task_stem(options_, task_) + ".frames.png";
    std::vector<images::ErrorTile> tiles;
    for (std::size_t i = 0; i < count; ++i) {
      measure::MeasuredCell& cell = measured.cells[i];
      begin("frames of " + cell.label);
      measure::AccumulatedImages drawn;
      if (absent.empty()) cell.record.accumulation = accumulation_->measure(cell.request, drawn);
      if (!cell.record.accumulation) {
        cell.record.absent["accumulation"] = absent.empty() ? "visibility is finite at no receiver" : absent;
      } else if (options_.grids && options_.pictures && !options_.part.is_worker()) {
        cell.record.accumulation->picture = picture;
        std::ranges::move(accumulation_->show(cell.label, drawn), std::back_inserter(tiles));
      }
    }
    if (!tiles.empty())
      images::write_figure(options_.out / picture,
                           images::show_errors(task_.scene->name + ": visibility accumulated over frames", tiles));
  }

  /// Measures how the map's texels are spent on the view.
  void measure_coverage(measure::SceneMeasurement& measured) {
    if (!coverage_) {
      const measure::LightMap& light = rig_.light();
      const measure::SceneTruth& truth = rig_.truth();
      std::optional<measure::ViewReceivers> untraced;
      if (truth.receivers.image.points.empty())
        untraced = measure::read_view_receivers(rig_.gbuffer(), task_.scene->light);
      coverage_ = measure::measure_coverage(
          untraced ? *untraced : truth.receivers, *task_.camera,
          measure::list_traced_layers(rig_.renderer.shaders, rig_.gbuffer(),
                                      measure::make_unbiased_light(options_, task_.scene->light, light.layers)),
          measure::read_linear_depth(light.map));
    }
    for (measure::MeasuredCell& cell : measured.cells) {
      cell.record.coverage = coverage_->record;
      for (std::size_t i = 0; cell.record.cascades && i < cell.record.cascades->size(); ++i)
        (*cell.record.cascades)[i].texels_per_pixel = coverage_->texels_per_pixel[i];
      if (!coverage_->record.texels_per_pixel) cell.record.absent["coverage"] = "no surface in view faces the light";
    }
  }

  /// Counts what estimates of GPUs need of the map's reads.
  void count_traffic(measure::SceneMeasurement& measured) {
    if (!traffic_) traffic_.emplace(rig_, coverage_->record.texels_per_pixel);
    for (measure::MeasuredCell& cell : measured.cells) traffic_->measure(cell);
    if (options_.grids) traffic_.reset();
  }

  /// Has pictures written from now on, beside what is still to be measured, but for the grid, which says all of it.
  void start_pictures(const measure::SceneTask& task, measure::SceneMeasurement& measured, FilesBeside& files) {
    if (options_.part.is_worker() || (options_.grids && !options_.pictures)) return;
    files.write(plan_pictures(options_, task, measured, rig_.truth()));
    if (options_.grids) files.write(plan_map_pictures(options_, task, measured, *coverage_, rig_.light()));
  }

  void write_images(const measure::TaskRig& rig, measure::SceneMeasurement& measured) {
    const measure::SceneTask& task = rig.task;
    if (!options_.part.is_worker() && options_.grids && options_.pictures)
      for (measure::MeasuredCell& cell : measured.cells) cell.record.images.grid = name_grid(options_, task);
    write_frames(rig, measured);
    if (!options_.part.is_worker()) {
      for (measure::MeasuredCell& cell : measured.cells) {
        measure::write_stability(options_, task_stem(options_, task), cell);
        if (!options_.grids) cell.record.absent["images"] = "the run was made with --no-grids";
      }
      if (!options_.grids) return;
    }
    note_float_images(options_, task, measured);
    if (options_.border_page) draw_border_page(task);
    write_float_images(options_, task, measured, rig_.truth(), rig_.renderer.context->info());
  }

  void draw_border_page(const measure::SceneTask& task) {
    const std::filesystem::path file = options_.out / (task_stem(options_, task) + ".borders.png");
    measure::SceneTask built_in = task;
    std::erase_if(built_in.filters,
                  [&](const auto& request) { return request.user_file && !options_.part.is_worker(); });
    write_border_page(file, rig_of(built_in));
    listener_.note("border page: " + file.string());
  }

  void write_cells(measure::SceneMeasurement& measured) {
    for (measure::MeasuredCell& cell : measured.cells) {
      cell.record.content = contents_.at(cell.record.key);
      records::write_cell(options_.out, cell.record);
    }
    listener_.finished(measured);
  }

  void begin(const std::string& what) const {
    listener_.begin(fmt::format("{} · {} · {}", task_.scene->name, task_.map_size, what));
  }
};

/// A folder that cannot be written is better found before the work than after it.
void require_writable(const std::filesystem::path& folder) { AtomicFile(folder / "cells" / "probe").write(""); }

/// A run of more cells, or that may be timed for longer, takes hours, and needs --yes.
constexpr int kManyCells = 2000;
constexpr double kMostTiming_s = 3600.0;

/// What opens a scene in the window, as it was given here.
std::vector<std::string> list_view_words(const PlannedScene& planned) {
  std::vector<std::string> words{planned.argument};
  if (planned.options.ground) words.emplace_back("--ground");
  if (!planned.scene.light.name.empty()) words.insert(words.end(), {"--light-name", planned.scene.light.name});
  return words;
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
    const RunPlan plan = make_plan(options_, renderer_.context->info().renderer);
    for (const PlannedTask& task : plan.tasks)
      gl::require_texture_size("--map-size", task.task.map_size, task.task.map_size);
    announce(plan);
    lock_.emplace(options_.out, options_.force || options_.part.is_worker());
    require_writable(options_.out);
    if (plan.finished == plan.own_cells && has_report(plan)) {
      progress_.note("nothing is left to do");
      return records::write_filter_mistakes(options_.out, {});
    }
    if (options_.grids) images::font_file();  // labels are drawn after all was measured: too late to find none
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
  std::optional<FolderLock> lock_;
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
    progress_.note(text);
    const double timing_s = options_.rounds.is_fixed() ? 0.0 : 1e-3 * options_.rounds.budget_ms * left;
    if ((left <= kManyCells && timing_s <= kMostTiming_s) || options_.large_is_fine) return;
    throw Error(ErrorKind::kUsage, text + ": add --yes to run them all, or name fewer values" +
                                       (options_.rounds.is_fixed() ? "" : ", or a smaller --budget"));
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

  void run_scene(const RunPlan& plan, std::size_t index) {
    const PlannedScene& planned = plan.scenes[index];
    std::optional<measure::SceneAssets> assets;
    for (const PlannedTask& each : plan.tasks) {
      if (each.scene != index || each.task.filters.empty()) continue;
      if (!assets)
        assets.emplace(renderer_, planned.options, planned.scene, cache_, measure::padding_texels(planned.options));
      if (options_.part.product == options::Product::kPrograms)
        for (const filters::FilterRequest& request : each.task.filters)
          measure::TaskRig{renderer_, planned.options, each.task, *assets}.make_passes(request);
      else
        TaskRun({renderer_, planned, each, *assets, run_, listener_, gpus_}).run();
    }
  }
};

}  // namespace

void run_experiment(const options::RunOptions& options, options::Progress& progress) {
  Experiment(options, progress).run();
}

}  // namespace shadowbench::run
