#include "harness/run/run_experiment.h"

#include <fmt/format.h>
#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <set>

#include "filters/error.h"
#include "harness/run/border_page.h"
#include "harness/run/cell_analysis.h"
#include "harness/run/map_coverage.h"
#include "harness/run/map_output.h"
#include "harness/run/run_facts.h"
#include "harness/run/scene_assets.h"
#include "harness/run/scene_measurement.h"
#include "harness/run/scene_output.h"
#include "harness/run/user_filter.h"
#include "harness/scene/closed_mesh.h"
#include "harness/scene/framing.h"
#include "harness/scene/load.h"
#include "reference/truth/occluders.h"
#include "report/atomic_file.h"
#include "report/json_io.h"
#include "report/report.h"

namespace shadowbench::run {
namespace {

/// A scene with what the command line called it.
struct NamedScene {
  std::string argument;
  scene::Scene scene;
};

void turn_light(scene::Scene& scene, const LightAngles& light) {
  scene.light.direction_ws = glm::vec3(scene::light_direction(light.azimuth_deg, light.elevation_deg));
}

std::vector<NamedScene> load_scenes(const RunOptions& options) {
  scene::LoadOptions load;
  load.scenes_folder = options.resources.scenes;
  load.ground = options.ground;
  load.aspect = static_cast<double>(options.width) / options.height;
  std::vector<NamedScene> scenes;
  std::set<std::string> names;
  for (const std::string& argument : options.scenes) {
    scenes.push_back({argument, scene::load(argument, load)});
    if (options.light) turn_light(scenes.back().scene, *options.light);
    const std::string& name = scenes.back().scene.name;
    if (names.insert(name).second) continue;
    throw Error(ErrorKind::kUsage, fmt::format("two scenes are called '{}': rename one file, or run them apart", name));
  }
  return scenes;
}

/// A default run's truths take some 15 MiB.
constexpr std::uintmax_t kMaxCacheBytes = std::uintmax_t{1} << 30;

/// A folder that cannot be written is better found before the work than after it.
void require_writable(const std::filesystem::path& folder) {
  report::AtomicFile(folder / "cells" / "probe").write("");
}

class Experiment {
 public:
  Experiment(const RunOptions& options, Progress& progress)
      : options_(options), progress_(progress), renderer_(make_renderer(options.backend, options.resources)),
        cache_(options.cache, [this](const std::string& message) { warn(message); }) {
    run_.commit = build_commit();
    run_.command = options.command;
    run_.seed = options.seed;
    run_.gl = describe_gl(renderer_);
    run_.machine = describe_machine();
    progress_.note(fmt::format("OpenGL by {}: {}", run_.gl.backend, run_.gl.renderer));
    for (const std::string& reason : renderer_.refused) progress_.note("not used: " + reason);
  }

  void run() {
    require_writable(options_.out);
    remove_stale_worker_folders(options_.out);
    const std::vector<NamedScene> scenes = load_scenes(options_);
    std::size_t views = 0;
    for (const NamedScene& each : scenes) views += each.scene.cameras.size();
    progress_.begin(static_cast<int>(views * options_.map_sizes.size() * options_.filters.size()));
    for (const NamedScene& each : scenes) run_scene(each);
    run_.work.shader_variants_compiled = renderer_.shaders.compiled();
    run_.work.truths_traced = cache_.traced();
    run_.work.truths_cached = cache_.loaded();
    cache_.prune(kMaxCacheBytes);
    progress_.show(done_, "writing the report");
    if (!options_.worker) report::write_report(options_.out, run_, keys_);
    progress_.show(done_, "done");
  }

 private:
  const RunOptions& options_;
  Progress& progress_;
  Renderer renderer_;
  TruthCache cache_;
  report::RunRecord run_;
  std::vector<std::string> keys_;
  int done_ = 0;

  void warn(const std::string& message) {
    run_.warnings.push_back(message);
    progress_.note("warning: " + message);
  }

  /// Single precision is spent on the distance from the origin: rays then start far off their surfaces, and miss contacts.
  void warn_of_distance(const scene::Scene& scene) {
    const scene::Bounds bounds = scene.bounds();
    const glm::vec3 largest = glm::max(glm::abs(bounds.min), glm::abs(bounds.max)), size = bounds.max - bounds.min;
    const float farthest = std::max({largest.x, largest.y, largest.z});
    const float offset = reference::origin_offset(farthest, farthest);
    if (offset < 1e-4f * std::max({size.x, size.y, size.z})) return;
    warn(fmt::format("{}: {} m from the origin, single precision leaves positions uncertain, and rays start {} m off their "
                     "surfaces: what is smaller is not seen; move the scene to the origin", scene.name, farthest, offset));
  }

  /// Culling front faces leaves nothing, or less than a shadow, of a mesh that encloses no volume.
  void warn_of_open_meshes(const scene::Scene& scene) {
    if (!options_.bias.map.cull_front) return;
    for (const scene::Mesh& mesh : scene.meshes) {
      if (!mesh.casts_shadow || !mesh.may_cull_front || scene::is_closed(mesh)) continue;
      warn(fmt::format("{}: '{}' is open or single-sided: with front-cull it vanishes from the shadow map where it faces the "
                       "light; set may_cull_front = false on it", scene.name, mesh.name));
    }
  }

  void warn_of_tests_without_effect(const scene::Scene& scene) {
    if (options_.range.behind_test || options_.worker) return;
    warn(scene.name + ": --behind-test off changes nothing: the light is directional, and only the map of a light that "
                      "stands in the scene has a behind");
  }

  void run_scene(const NamedScene& each) {
    run_.scenes.push_back({each.scene.name, each.scene.title});
    for (const std::string& warning : each.scene.warnings) warn(each.scene.name + ": " + warning);
    warn_of_open_meshes(each.scene);
    if (options_.truth && !options_.worker) warn_of_distance(each.scene);
    warn_of_tests_without_effect(each.scene);
    SceneAssets assets(renderer_, options_, each.scene, cache_,
                       options_.pad_texels.value_or(largest_padding_texels(options_.filters)));
    for (const scene::Camera& camera : each.scene.cameras) {
      for (const int map_size : options_.map_sizes) {
        run_task({&each.scene, &camera, map_size, options_.filters}, assets, each.argument);
      }
    }
  }

  /// Measures a user's filters first, each in its own process, so that a mistake in one is heard of at once.
  std::vector<MeasuredCell> run_user_filters(const SceneTask& task, const std::string& scene_argument) {
    std::vector<MeasuredCell> cells;
    for (const filters::FilterRequest& request : options_.filters) {
      if (!request.user_file || options_.worker) continue;
      show(task, request.label());
      cells.push_back(measure_user_filter(options_, task, request, scene_argument, renderer_.context->info().backend));
    }
    return cells;
  }

  void run_task(SceneTask task, SceneAssets& assets, const std::string& scene_argument) {
    std::vector<MeasuredCell> user_cells = run_user_filters(task, scene_argument);
    const SceneTask all = task;
    std::erase_if(task.filters, [&](const auto& request) { return request.user_file && !options_.worker; });
    SceneMeasurement measured =
        measure_scene(renderer_, options_, task, assets, [&](const std::string& label) { show(task, label); });
    for (const std::string& warning : measured.warnings) warn(warning);
    for (MeasuredCell& cell : user_cells) measured.cells.push_back(std::move(cell));
    show(task, "truth");
    const SceneTruth& truth = assets.truth(*task.camera);
    if (!options_.worker) explain(measured, task, assets, truth);
    show(task, "pictures");
    if (!options_.worker) {
      cover(measured, task, assets, truth);
      write_pictures(options_, all, measured, truth, run_.gl);
    }
    if (options_.border_page) draw_border_page(task, assets);
    write_float_images(options_, all, measured, truth, renderer_.context->info());
    for (const MeasuredCell& cell : measured.cells) {
      report::write_cell(options_.out, cell.record);
      keys_.push_back(cell.record.key);
    }
    done_ += static_cast<int>(measured.cells.size());
    run_.work.passes_run += measured.passes_run;
    run_.work.passes_skipped += measured.passes_skipped;
  }

  /// Says how the map's texels are spent on the view: numbers in every cell, and pictures.
  void cover(SceneMeasurement& measured, const SceneTask& task, SceneAssets& assets, const SceneTruth& truth) {
    const scene::LightFrustum& frustum = assets.light_map(*task.camera, task.map_size).frustum;
    std::optional<ViewReceivers> untraced;
    if (truth.receivers.image.points.empty()) untraced = read_view_receivers(assets.gbuffer(*task.camera), -task.scene->light.direction_ws);
    const MapCoverage coverage =
        measure_coverage(untraced ? *untraced : truth.receivers, *task.camera, frustum, measured.depth_map);
    for (MeasuredCell& cell : measured.cells) {
      cell.record.coverage = coverage.record;
      if (!coverage.record.texels_per_pixel) cell.record.absent["coverage"] = "no surface in view faces the light";
    }
    write_map_pictures(options_, task, measured, coverage, frustum);
  }

  void draw_border_page(const SceneTask& task, SceneAssets& assets) {
    const std::filesystem::path file = options_.out / (task_stem(options_, task) + ".borders.png");
    write_border_page(file, renderer_, options_, task, assets);
    progress_.note("border page: " + file.string());
  }

  /// Says how wrong each cell is, and why.
  void explain(SceneMeasurement& measured, const SceneTask& task, SceneAssets& assets, const SceneTruth& truth) {
    tbb::parallel_for_each(measured.cells, [&](MeasuredCell& cell) {
      score(cell.record, cell.visibility, cell.picture, truth);
    });
    show(task, "attribution");
    CellAnalyser analyser(renderer_, options_, task, assets, truth);
    for (MeasuredCell& cell : measured.cells) analyser.analyse(cell);
    measured.masks = analyser.masks();
  }

  void show(const SceneTask& task, const std::string& what) {
    progress_.show(done_, fmt::format("{} · {} · {}", task.scene->name, task.map_size, what));
  }
};

}  // namespace

void run_experiment(const RunOptions& options, Progress& progress) { Experiment(options, progress).run(); }

}  // namespace shadowbench::run
