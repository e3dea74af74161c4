#include "harness/run/task_run.h"

#include <fmt/format.h>
#include <malloc.h>
#include <tbb/parallel_for_each.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <optional>

#include "harness/measure/accumulation.h"
#include "harness/measure/cell_analysis.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/scene_measurement.h"
#include "harness/measure/stability_meter.h"
#include "harness/measure/traffic_meter.h"
#include "harness/measure/view_receivers.h"
#include "harness/render/picture_passes.h"
#include "harness/run/float_images.h"
#include "harness/run/task_images.h"
#include "harness/run/worker_process.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

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

/// One task under way.
class TaskRun {
 public:
  explicit TaskRun(const TaskBench& bench)
      : bench_(bench),
        renderer_(bench.renderer),
        options_(bench.planned.options),
        task_(bench.task.task),
        assets_(bench.assets),
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
  measure::Renderer& renderer_;
  const options::RunOptions& options_;
  const measure::SceneTask& task_;
  measure::SceneAssets& assets_;
  const TaskListener& listener_;
  std::map<std::string, std::string> contents_;  ///< by key
  std::optional<measure::CellAnalyser> analyser_;
  std::optional<measure::MapCoverage> coverage_;
  std::optional<measure::TrafficMeter> traffic_;
  std::optional<measure::AccumulationMeter> accumulation_;

  measure::SceneTask task_of(const Requests& requests) const {
    return {task_.scene, task_.camera, task_.map_size, requests};
  }

  void run_group(const Requests& built_in, const Requests& of_users) {
    const Stopwatch watch;
    std::vector<measure::MeasuredCell> user_cells;
    for (const filters::FilterRequest& request : of_users) user_cells.push_back(measure_user_cell(request));
    measure::SceneMeasurement measured;
    if (!built_in.empty())
      measured = measure::measure_scene({renderer_, options_, task_of(built_in), assets_},
                                        [this](const std::string& what) { begin(what); });
    const measure::LightMap& light = assets_.light_map(*task_.camera, task_.map_size);
    measured.stored_map = light.map.read_picture();
    measured.depth_map = measure::read_linear_depth(light.map);
    if (!task_.scene->light.name.empty()) measured.ambient = draw_ambient();
    for (measure::MeasuredCell& cell : user_cells) measured.cells.push_back(std::move(cell));
    for (measure::MeasuredCell& cell : measured.cells) {
      cell.record.measured_s = 0.0;
      cell.record.machine = records::kind_of(bench_.run.machine, bench_.run.gl);
    }
    Requests all = built_in;
    all.insert(all.end(), of_users.begin(), of_users.end());
    if (!options_.part.is_worker()) score(measured);
    measure_coverage(measured);
    if (options_.frames > 1) accumulate(measured, built_in.size());
    FilesBeside files;  // after what its jobs read
    start_pictures(task_of(all), measured, files);
    if (!options_.gpus.empty()) begin("costs on GPUs");
    if (bench_.gpus.compile(measured.cells)) count_traffic(measured);
    bench_.gpus.add_to(measured.cells);
    if (options_.pictures) begin("pictures");
    write_images(task_of(all), measured);
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
    return render::shade(renderer_.shaders, assets_.gbuffer(*task_.camera), dark.texture(), *task_.scene, *task_.camera,
                         options_.range);
  }

  measure::MeasuredCell measure_user_cell(const filters::FilterRequest& request) {
    begin(request.label());
    return measure_user_filter(options_, task_, request, {bench_.planned.argument, renderer_.context->info().backend});
  }

  /// Scores each cell against the truth, and takes its error apart.
  void score(measure::SceneMeasurement& measured) {
    if (options_.truth) begin("truth");
    Stopwatch watch;
    const measure::SceneTruth& truth = assets_.truth(*task_.camera);
    measured.truth_s = watch.read_s();
    if (options_.truth) begin("artefacts");
    watch = {};
    if (!analyser_) analyser_.emplace(measure::TaskRig{renderer_, options_, task_, assets_}, truth);
    measured.truth_s += watch.read_s();
    if (options_.truth) begin("errors");
    tbb::parallel_for_each(measured.cells, [&](measure::MeasuredCell& cell) {
      cell.flip = measure::score(cell.record, {cell.visibility, cell.phases, cell.stepped, cell.picture}, truth);
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
    assets_.gbuffer(*task_.camera).forget_receivers();
    if (options_.grids) analyser_.reset();  // no other group needs it
    malloc_trim(0);                         // of rays, before the pictures
  }

  /// Accumulates the first cells over frames: those that are drawn in this process.
  void accumulate(measure::SceneMeasurement& measured, std::size_t count) {
    const gl::Recorder::Pause pause(renderer_.recorder.get());
    const std::string& absent = assets_.truth(*task_.camera).absent;
    if (absent.empty() && count > 0 && !accumulation_)
      accumulation_.emplace(measure::TaskRig{renderer_, options_, task_, assets_});
    const std::string picture = task_stem(options_, task_) + ".frames.png";
    images::Grid grid;
    grid.title = task_.scene->name + ": visibility accumulated over frames";
    grid.columns = 6;
    for (std::size_t i = 0; i < count; ++i) {
      measure::MeasuredCell& cell = measured.cells[i];
      begin("frames of " + cell.label);
      measure::AccumulatedImages drawn;
      if (absent.empty()) cell.record.accumulation = accumulation_->measure(cell.request, drawn);
      if (!cell.record.accumulation) {
        cell.record.absent["accumulation"] = absent.empty() ? "visibility is finite at no receiver" : absent;
      } else if (options_.grids && options_.pictures && !options_.part.is_worker()) {
        cell.record.accumulation->picture = picture;
        std::ranges::move(accumulation_->show(cell.label, drawn), std::back_inserter(grid.tiles));
      }
    }
    if (!grid.tiles.empty()) images::write_grid(options_.out / picture, grid);
  }

  /// Measures how the map's texels are spent on the view.
  void measure_coverage(measure::SceneMeasurement& measured) {
    if (!coverage_) {
      measure::LightMap& light = assets_.light_map(*task_.camera, task_.map_size);
      const measure::SceneTruth& truth = assets_.truth(*task_.camera);
      std::optional<measure::ViewReceivers> untraced;
      if (truth.receivers.image.points.empty())
        untraced = measure::read_view_receivers(assets_.gbuffer(*task_.camera), task_.scene->light);
      coverage_ = measure::measure_coverage(
          untraced ? *untraced : truth.receivers, *task_.camera,
          measure::list_traced_layers(renderer_.shaders, assets_.gbuffer(*task_.camera),
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
    if (!traffic_)
      traffic_.emplace(measure::TaskRig{renderer_, options_, task_, assets_}, coverage_->record.texels_per_pixel);
    for (measure::MeasuredCell& cell : measured.cells) traffic_->measure(cell);
    if (options_.grids) traffic_.reset();
  }

  /// Has pictures written from now on, beside what is still to be measured, but for the grid, which says all of it.
  void start_pictures(const measure::SceneTask& task, measure::SceneMeasurement& measured, FilesBeside& files) {
    if (options_.part.is_worker() || (options_.grids && !options_.pictures)) return;
    files.write(plan_pictures(options_, task, measured, assets_.truth(*task.camera)));
    if (options_.grids)
      files.write(
          plan_map_pictures(options_, task, measured, *coverage_, assets_.light_map(*task.camera, task.map_size)));
  }

  void write_images(const measure::SceneTask& task, measure::SceneMeasurement& measured) {
    const measure::SceneTruth& truth = assets_.truth(*task.camera);
    if (!options_.part.is_worker() && options_.grids && options_.pictures)
      for (measure::MeasuredCell& cell : measured.cells) cell.record.images.grid = name_grid(options_, task);
    write_frames(renderer_, options_, task, assets_, measured);
    if (!options_.part.is_worker()) {
      for (measure::MeasuredCell& cell : measured.cells) {
        measure::write_stability(options_, task_stem(options_, task), cell);
        if (!options_.grids) cell.record.absent["images"] = "the run was made with --no-grids";
      }
      if (!options_.grids) return;
    }
    note_float_images(options_, task, measured);
    if (options_.border_page) draw_border_page(task);
    write_float_images(options_, task, measured, truth, renderer_.context->info());
  }

  void draw_border_page(const measure::SceneTask& task) {
    const std::filesystem::path file = options_.out / (task_stem(options_, task) + ".borders.png");
    measure::SceneTask built_in = task;
    std::erase_if(built_in.filters,
                  [&](const auto& request) { return request.user_file && !options_.part.is_worker(); });
    write_border_page(file, renderer_, options_, built_in, assets_);
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

}  // namespace

void measure_task(const TaskBench& bench) { TaskRun(bench).run(); }

}  // namespace shadowbench::run
