#include "harness/run/run_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "filters/base/content_hash.h"
#include "filters/base/error.h"
#include "harness/render/gbuffer.h"
#include "harness/run/cell_content.h"
#include "harness/run/scene_loading.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

constexpr const char* kChanged =
    "the experiment is no longer what was submitted: scenes, filters, settings or the program have changed; submit it "
    "into another folder";

/// Whether a light was asked for; all are where none was named.
bool is_wanted(const options::RunOptions& options, const scene::Light& light) {
  return options.light_names.empty() || std::ranges::count(options.light_names, light.name) > 0;
}

/// Whether a stretch of cells has one that is to be measured.
bool has_own_cell(const options::Part& part, const options::CellRange& cells) {
  return std::ranges::any_of(
      part.ranges, [&](const options::CellRange& own) { return own.begin < cells.end && cells.begin < own.end; });
}

/// The first cell of the scene that stands at a place of the plan.
int find_first_cell(const options::Part& part, std::size_t place) {
  return std::accumulate(part.scene_cells.begin(), part.scene_cells.begin() + static_cast<std::ptrdiff_t>(place), 0);
}

/// The scenes of a picture size that have a cell of this run, as indices. The first of them stands at `place`.
std::vector<std::size_t> list_needed_scenes(const options::RunOptions& options, std::size_t place) {
  std::vector<std::size_t> needed;
  for (std::size_t i = 0; i < options.scenes.size(); ++i) {
    if (options.part) {
      const int begin = find_first_cell(*options.part, place + i);
      if (!has_own_cell(*options.part, {begin, begin + options.part->scene_cells[place + i]})) continue;
    }
    needed.push_back(i);
  }
  return needed;
}

void require_known_scenes(const options::RunOptions& options) {
  if (!options.part || options.part->scene_cells.size() == options.sizes.size() * options.scenes.size()) return;
  throw Error(ErrorKind::kInput, kChanged);
}

/// Every scene in every picture size, under each of its lights, with every fit of the light's map.
std::vector<PlannedScene> plan_scenes(const options::RunOptions& options) {
  require_known_scenes(options);
  std::vector<PlannedScene> planned;
  std::size_t first_place = 0;
  for (const options::PictureSize& size : options.sizes) {
    options::RunOptions framed = options;
    framed.width = size.width;
    framed.height = size.height;
    const std::vector<std::size_t> needed = list_needed_scenes(options, first_place);
    options::RunOptions loaded = framed;
    loaded.scenes.clear();
    for (const std::size_t i : needed) loaded.scenes.push_back(options.scenes[i]);
    std::vector<scene::Scene> scenes = load_scenes(loaded);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      for (const scene::Scene& lit : scene::separate_lights(scenes[i])) {
        if (!is_wanted(options, lit.light)) continue;
        for (const scene::FitRule& fit : options.fits) {
          framed.fit = fit;
          planned.push_back({framed, options.scenes[needed[i]], lit, first_place + needed[i]});
        }
      }
    }
    first_place += options.scenes.size();
  }
  return planned;
}

/// The views that were asked for; all where none was.
std::vector<const scene::Camera*> choose_views(const options::RunOptions& options, const scene::Scene& scene) {
  std::vector<const scene::Camera*> views;
  for (const scene::Camera& camera : scene.cameras) {
    const bool wanted = options.views.empty() ||
                        std::find(options.views.begin(), options.views.end(), camera.name) != options.views.end();
    if (wanted) views.push_back(&camera);
  }
  return views;
}

void require_views(const options::RunOptions& options, const std::vector<PlannedScene>& scenes) {
  if (options.part) return;  // the scenes that have it may be others' work
  std::set<std::string> known;
  for (const PlannedScene& each : scenes)
    for (const scene::Camera& camera : each.scene.cameras) known.insert(camera.name);
  for (const std::string& view : options.views) {
    if (known.count(view) > 0) continue;
    throw Error(ErrorKind::kUsage,
                fmt::format("--view: no scene has a view '{}'; there are {}", view, fmt::join(known, ", ")));
  }
}

/// Beyond that, timed frames would prepare receivers as well.
void require_few_maps(const std::vector<PlannedScene>& scenes) {
  for (const PlannedScene& each : scenes) {
    const int layers = scene::count_layers(each.scene.light, each.options.fit);
    const int most = static_cast<int>(render::kKeptReceiverMaps) / layers;
    for (const int lights : each.options.lights) {
      if (lights <= most) continue;
      throw Error(ErrorKind::kUsage,
                  fmt::format("--lights: {} lights on {} have {} maps ({} each), more than the {} "
                              "that a frame may have; choose {} lights or fewer",
                              lights, each.scene.name, lights * layers, layers, render::kKeptReceiverMaps, most));
    }
  }
}

class Planner {
 public:
  Planner(const options::RunOptions& options, const std::string& renderer) : options_(options), renderer_(renderer) {}

  RunPlan plan() {
    plan_.scenes = plan_scenes(options_);
    if (plan_.scenes.empty()) {
      throw Error(ErrorKind::kUsage, fmt::format("--light-name: no scene has a light '{}'; the lights of several have "
                                                 "names in their scene's file",
                                                 fmt::join(options_.light_names, "', '")));
    }
    require_views(options_, plan_.scenes);
    require_few_maps(plan_.scenes);
    plan_.scene_cells.resize(options_.sizes.size() * options_.scenes.size());
    for (std::size_t i = 0; i < plan_.scenes.size(); ++i) add_scene(i);
    plan_.settings = hash_.name();
    require_cells();
    require_unchanged();
    return std::move(plan_);
  }

 private:
  const options::RunOptions& options_;
  const std::string& renderer_;
  RunPlan plan_;
  ContentHash hash_, own_hash_;

  void add_scene(std::size_t index) {
    const PlannedScene& scene = plan_.scenes[index];
    if (options_.part && (index == 0 || plan_.scenes[index - 1].place != scene.place))
      plan_.cells = find_first_cell(*options_.part, scene.place);
    const std::string content = name_scene_content(scene.options, scene.scene);
    for (const scene::Camera* camera : choose_views(options_, scene.scene))
      for (const int map_size : options_.map_sizes) add_task(index, {&scene.scene, camera, map_size, {}}, content);
  }

  void add_task(std::size_t scene, measure::SceneTask task, const std::string& scene_content) {
    PlannedTask planned{scene, task, {}, {}};
    std::vector<filters::FilterRequest> missing;
    for (const filters::FilterRequest& request : options_.filters) {
      const std::string key = measure::make_record(plan_.scenes[scene].options, task, request).key;
      const std::string content = name_cell_content(scene_content, request);
      add_cell(hash_, key, content);
      ++plan_.scene_cells[plan_.scenes[scene].place];
      if (!is_own(plan_.cells++)) continue;
      add_cell(own_hash_, key, content);
      planned.keys.push_back(key);
      planned.task.filters.push_back(request);
      planned.contents.push_back(content);
    }
    plan_.own_cells += static_cast<int>(planned.keys.size());
    leave_out_finished(planned);
    if (!planned.keys.empty()) plan_.tasks.push_back(std::move(planned));
  }

  bool is_own(int cell) const {
    if (options_.part) return has_own_cell(*options_.part, {cell, cell + 1});
    return cell % options_.shard.count == options_.shard.index;
  }

  void leave_out_finished(PlannedTask& planned) {
    std::vector<char> finished;
    for (std::size_t i = 0; i < planned.keys.size(); ++i)
      finished.push_back(is_finished(planned.keys[i], planned.contents[i]) ? 1 : 0);
    const auto count = std::count(finished.begin(), finished.end(), 1);
    if (options_.grids && count < static_cast<std::ptrdiff_t>(finished.size())) return;
    plan_.finished += static_cast<int>(count);
    std::size_t at = 0;
    std::erase_if(planned.task.filters, [&](const auto&) { return finished[at++] != 0; });
    at = 0;
    std::erase_if(planned.contents, [&](const auto&) { return finished[at++] != 0; });
  }

  /// A file that cannot be read, or was made from something else or by another OpenGL, is measured anew. The machines
  /// of a sweep may differ.
  bool is_finished(const std::string& key, const std::string& content) const {
    std::error_code ignored;
    if (options_.worker || options_.fresh || !std::filesystem::exists(records::cell_path(options_.out, key), ignored))
      return false;
    try {
      const records::CellRecord cell = records::read_cell(options_.out, key);
      const bool is_drawn_alike = options_.part || (cell.machine && cell.machine->renderer == renderer_);
      return cell.content == content && is_drawn_alike;
    } catch (const Error&) {
      return false;
    }
  }

  void require_unchanged() const {
    if (options_.part && !options_.part->content.empty() && options_.part->content != own_hash_.name())
      throw Error(ErrorKind::kInput, kChanged);
  }

  void require_cells() const {
    if (plan_.cells == 0) throw Error(ErrorKind::kUsage, "there is nothing to run: no scene has one of these views");
    if (plan_.own_cells > 0) return;
    throw Error(ErrorKind::kUsage, fmt::format("--shard {}/{} is empty: the experiment has {} cells",
                                               options_.shard.index + 1, options_.shard.count, plan_.cells));
  }
};

}  // namespace

RunPlan make_plan(const options::RunOptions& options, const std::string& renderer) {
  return Planner(options, renderer).plan();
}

}  // namespace shadowbench::run
