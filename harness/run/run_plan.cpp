#include "harness/run/run_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/bytes.h"
#include "base/error.h"
#include "base/files.h"
#include "filters/kernel.h"
#include "harness/measure/scene_assets.h"
#include "harness/measure/view_receivers.h"
#include "harness/options/run_options.h"
#include "harness/run/provenance.h"
#include "harness/scene/complete.h"
#include "harness/scene/load.h"
#include "harness/scene/mesh_tools.h"
#include "report/records/format.h"
#include "report/records/json_io.h"

namespace shadowbench::run {
namespace {

void add_options(ContentHash& hash, options::RunOptions options) {
  // How precise times are to be decides nothing where the number of rounds is told.
  if (options.rounds.is_fixed()) options.rounds = options::RoundLimits::exactly(options.rounds.most);
  for (const options::RunOption& option : options::list_run_options()) {
    if (option.decides != options::Decides::kContent) continue;
    hash.add(option.name);
    for (const std::string& text : options::list_texts(option.write(options))) hash.add(text);
  }
  // The masks of artefacts reach as far as the widest kernel of the run.
  hash.add(fmt::format("pad {} radius {} reference {} grids {}", measure::padding_texels(options),
                       measure::widest_kernel_texels(options), options.reference.label(), options.grids));
  for (const gpu::Gpu& gpu : options.gpus) {
    hash.add(fmt::format("{} {}", gpu.name, fmt::join(gpu.families, " ")));
    gpu::visit_constants(gpu, [&](const char*, const gpu::Constant& constant) {
      hash.add_values(std::span<const double>(&constant.value, 1));
    });
  }
}

void add_material(ContentHash& hash, const scene::Material& m) {
  hash.add(fmt::format("{} {} {} {} {} {} {}", m.base_color.r, m.base_color.g, m.base_color.b, m.base_color.a,
                       m.base_color_texture, static_cast<int>(m.alpha_mode), m.alpha_cutoff));
}

void add_camera(ContentHash& hash, const scene::Camera& c) {
  hash.add(c.name);
  for (const glm::vec3& v : {c.position_ws, c.forward_ws, c.up_ws}) hash.add(fmt::format("{} {} {}", v.x, v.y, v.z));
  hash.add(fmt::format("{} {}", c.vertical_fov_rad, c.orthographic_height_m));
}

void add_scene(ContentHash& hash, const scene::Scene& scene) {
  for (const scene::Mesh& mesh : scene.meshes) {
    hash.add(fmt::format("mesh {} {} {}", mesh.material, mesh.casts_shadow, mesh.may_cull_front));
    hash.add_values(std::span<const scene::Vertex>(mesh.vertices));
    hash.add_values(std::span<const std::uint32_t>(mesh.indices));
  }
  for (const scene::Material& material : scene.materials) add_material(hash, material);
  for (const scene::Texture& texture : scene.textures) {
    hash.add(fmt::format("texture {} {}", texture.width, texture.height));
    hash.add_values(std::span<const std::uint8_t>(texture.rgba));
  }
  for (const scene::Camera& camera : scene.cameras) add_camera(hash, camera);
  for (const std::string& piece : scene::list_light_content(scene.light)) hash.add(piece);
  hash.add(fmt::format("{} {} {}", scene.background.r, scene.background.g, scene.background.b));
}

/// Names the shaders that filters include and are drawn with: they are read when the program starts, so that its commit
/// does not name them.
std::string name_shaders(const std::filesystem::path& folder) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) files.insert(entry.path());
  ContentHash hash;
  for (const std::filesystem::path& file : files) {
    hash.add(file.lexically_relative(folder).generic_string());
    hash.add_values(std::span<const unsigned char>(read_file_bytes(file, kMebibyte)));
  }
  return hash.name();
}

/// Names everything that a scene's cells are made from and their keys do not say: the program's commit, its shaders,
/// the options of the run, and the scene itself with its geometry, textures, cameras and light. Not the OpenGL: see
/// CellRecord::machine.
std::string name_scene_content(const options::RunOptions& options, const scene::Scene& scene,
                               const std::string& shaders) {
  ContentHash hash;
  hash.add(build_commit());
  hash.add(shaders);
  add_options(hash, options);
  add_scene(hash, scene);
  return hash.name();
}

/// Names everything that one cell is made from: the above, and the filter's file, with the time that a user's may take.
/// Two cells of one key and one content differ in their times, and by what another OpenGL rounds, alone.
std::string name_cell_content(const std::string& scene_content, const filters::FilterRequest& request,
                              const options::RunOptions& options) {
  ContentHash hash;
  hash.add(scene_content);
  hash.add(request.spec.front_matter);
  hash.add(request.spec.body);
  if (request.light_sigma_texels) hash.add(fmt::format("width by light {}", *request.light_sigma_texels));
  hash.add(request.spec.copy_of);
  if (request.user_file) hash.add(fmt::format("ends after {} s", options.cell_timeout_s));
  return hash.name();
}

/// Every scene in every picture size, under each of its lights, with every fit of the light's map.
std::vector<PlannedScene> plan_scenes(const options::RunOptions& options) {
  std::vector<PlannedScene> planned;
  std::size_t place = 0;
  for (const options::PictureSize& size : options.sizes) {
    options::RunOptions framed = options;
    framed.width = size.width;
    framed.height = size.height;
    const std::vector<scene::Scene> scenes = load_scenes(framed);
    for (std::size_t i = 0; i < scenes.size(); ++i, ++place) {
      for (const scene::Scene& lit : list_lit_scenes(options, scenes[i])) {
        for (const scene::FitRule& fit : options.fits) {
          framed.fit = fit;
          planned.push_back({framed, options.scenes[i], lit, place});
        }
      }
    }
  }
  return planned;
}

void require_views(const options::RunOptions& options, const std::vector<PlannedScene>& scenes) {
  std::set<std::string> known;
  for (const PlannedScene& each : scenes)
    for (const scene::Camera& camera : each.scene.cameras) known.insert(camera.name);
  for (const std::string& view : options.views) {
    if (known.count(view) > 0) continue;
    throw Error(ErrorKind::kUsage,
                fmt::format("--view: no scene has a view '{}'; there are {}", view, fmt::join(known, ", ")));
  }
}

/// Texels along a side of each layer, where one map is to have `map_size`. Throws Error(kUsage) where none is left.
int choose_layer_size(const PlannedScene& planned, int map_size) {
  if (!planned.options.equal_bytes) return map_size;
  const int layers = scene::count_layers(planned.scene.light, planned.options.fit);
  const int size = static_cast<int>(map_size / std::sqrt(layers));
  if (size < 1)
    throw Error(ErrorKind::kUsage, fmt::format("--equal-bytes: a map of {0} x {0} texels is too small for {1} layers: "
                                               "choose --map-size {1} or more",
                                               map_size, layers));
  return size;
}

/// The views of a scene that were asked for; all where none was.
std::vector<const scene::Camera*> choose_views(const options::RunOptions& options, const scene::Scene& scene) {
  std::vector<const scene::Camera*> views;
  for (const scene::Camera& camera : scene.cameras)
    if (options.views.empty() || std::ranges::count(options.views, camera.name) > 0) views.push_back(&camera);
  return views;
}

class Planner {
 public:
  Planner(const options::RunOptions& options, const std::string& renderer) : options_(options), renderer_(renderer) {}

  RunPlan plan() {
    plan_.scenes = plan_scenes(options_);
    if (plan_.scenes.empty()) fail_unknown_light(options_);
    require_views(options_, plan_.scenes);
    for (std::size_t i = 0; i < plan_.scenes.size(); ++i) add_scene(i);
    plan_.settings = hash_.name();
    require_cells();
    return std::move(plan_);
  }

 private:
  const options::RunOptions& options_;
  const std::string& renderer_;
  const std::string shaders_ = name_shaders(options_.resources.shaders);
  RunPlan plan_;
  ContentHash hash_;
  std::optional<scene::EdgeMeter> meter_;  ///< of the scenes at `meter_place_`, which differ in their lights and fits
  std::size_t meter_place_ = 0;

  void add_scene(std::size_t index) {
    PlannedScene& scene = plan_.scenes[index];
    std::vector<measure::SceneTask> tasks;
    for (const scene::Camera* camera : choose_views(options_, scene.scene))
      for (const int map_size : options_.map_sizes)
        tasks.push_back({&scene.scene, camera, choose_layer_size(scene, map_size), options_.filters});
    take_light_widths(scene, tasks);
    const std::string content = name_scene_content(scene.options, scene.scene, shaders_);
    for (const measure::SceneTask& task : tasks) add_task(index, task, content);
  }

  /// Gives filters the width that the light asks for in each view and map, and all of the scene's maps the padding that
  /// the widest of them needs. It is asked for in maps with the padding of the filters' own widths.
  void take_light_widths(PlannedScene& scene, std::vector<measure::SceneTask>& tasks) {
    const auto is_asked = [](const filters::FilterRequest& each) { return each.width == filters::kLightWidth; };
    if (std::ranges::none_of(options_.filters, is_asked)) return;
    if (!meter_ || meter_place_ != scene.place) meter_.emplace(scene.scene);
    meter_place_ = scene.place;
    const double pad_texels = measure::padding_texels(options_);
    std::vector<filters::FilterRequest> all;
    for (measure::SceneTask& task : tasks) {
      const auto sigma = measure::find_light_sigma(
          *meter_, scene.options, {scene.scene, scene.scene.light, *task.camera, task.map_size, pad_texels});
      for (filters::FilterRequest& request : task.filters)
        if (is_asked(request)) request.take_light_width(sigma.value_or(0.0));
      all.insert(all.end(), task.filters.begin(), task.filters.end());
    }
    scene.options.pad_texels = options_.pad_texels.value_or(measure::largest_padding_texels(all));
  }

  void add_task(std::size_t scene, const measure::SceneTask& task, const std::string& scene_content) {
    PlannedTask planned{scene, task, {}, {}};
    planned.task.filters.clear();
    for (const filters::FilterRequest& request : task.filters) {
      const std::string key = measure::make_record(plan_.scenes[scene].options, task, request).key;
      const std::string content = name_cell_content(scene_content, request, options_);
      hash_.add(key);
      hash_.add(content);
      if (plan_.cells++ % options_.part.shards != options_.part.shard - 1) continue;
      planned.keys.push_back(key);
      planned.task.filters.push_back(request);
      planned.contents.push_back(content);
    }
    plan_.own_cells += static_cast<int>(planned.keys.size());
    leave_out_finished(planned);
    if (!planned.keys.empty()) plan_.tasks.push_back(std::move(planned));
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

  /// A file that cannot be read, or was made from something else or by another OpenGL, is measured anew.
  bool is_finished(const std::string& key, const std::string& content) const {
    std::error_code ignored;
    if (options_.part.is_worker() || options_.fresh ||
        !std::filesystem::exists(records::cell_path(options_.out, key), ignored))
      return false;
    try {
      const records::CellRecord cell = records::read_cell(options_.out, key);
      return cell.content == content && cell.machine && cell.machine->renderer == renderer_;
    } catch (const Error&) {
      return false;
    }
  }

  void require_cells() const {
    if (plan_.cells == 0) throw Error(ErrorKind::kUsage, "there is nothing to run: no scene has one of these views");
    if (plan_.own_cells > 0) return;
    throw Error(ErrorKind::kUsage, fmt::format("--shard {}/{} is empty: the experiment has {} cells",
                                               options_.part.shard, options_.part.shards, plan_.cells));
  }
};

/// Rays are dimmed by what blends, also where the map holds it opaque.
void warn_of_blending(scene::Scene& scene) {
  for (const scene::Mesh& mesh : scene.meshes) {
    const scene::Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (!mesh.casts_shadow || material.alpha_mode != scene::AlphaMode::kBlend) continue;
    scene.warnings.push_back(
        fmt::format("shadow maps hold '{}', which blends, as if it were opaque, while rays of the truth are dimmed by "
                    "its alpha; choose --blend-casters hashed or dither",
                    material.name));
    return;
  }
}

/// A mesh that encloses no volume casts no shadow, or only a part of one, where front faces are culled.
void warn_of_open_meshes(scene::Scene& scene) {
  for (const scene::Mesh& mesh : scene.meshes) {
    if (!mesh.casts_shadow || !mesh.may_cull_front || scene::is_closed(mesh)) continue;
    scene.warnings.push_back(
        fmt::format("'{}' is open or single-sided: with front-cull it vanishes from the shadow map where it faces the "
                    "light; set may_cull_front = false on it",
                    mesh.name));
  }
}

/// Empty unless the light shines from below.
std::string describe_light_below(const scene::Scene& scene) {
  const scene::Bounds bounds = scene.bounds();
  const glm::vec3 middle = 0.5f * (bounds.min + bounds.max);
  const float up = scene::to_light(scene.light, {middle.x, bounds.min.y, middle.z}).y;
  if (up >= 0.0f) return "";
  const std::string name = scene.light.name.empty() ? "the light" : fmt::format("the light '{}'", scene.light.name);
  return fmt::format(
      "{}: {} shines from below, {} degrees under the horizon, where no floor faces it; give it an elevation above 0, "
      "in the scene or with --light",
      scene.name, name, records::format_number(glm::degrees(std::asin(-static_cast<double>(up)))));
}

/// Empty unless no surface in view is lit.
std::string describe_unseen_light(const options::RunOptions& options, const scene::Scene& scene) {
  std::vector<scene::Camera> views;
  for (const scene::Camera* each : choose_views(options, scene)) views.push_back(*each);
  const double aspect = static_cast<double>(options.width) / options.height;
  if (views.empty() || scene::is_light_in_view(scene, views, aspect)) return "";
  return fmt::format(
      "{}: the light reaches no surface in view, so that nothing is tested under it; give its file another place of "
      "the "
      "light, or a [[camera]] that sees what it lights",
      scene.name);
}

/// The map of a sun has no behind, and a light without a cone shines there too.
std::string describe_test_without_effect(const options::RunOptions& options, const scene::Scene& scene) {
  const std::optional<scene::Beam> beam = scene::find_beam(scene.light);
  if (options.range.behind_test || (beam && beam->has_edge())) return "";
  return scene.name + ": --behind-test off changes nothing: only a light with a cone has a behind";
}

}  // namespace

RunPlan make_plan(const options::RunOptions& options, const std::string& renderer) {
  return Planner(options, renderer).plan();
}

std::string name_view(const PlannedScene& planned, const scene::Camera& camera) {
  scene::Scene seen = planned.scene;
  seen.cameras = {camera};
  ContentHash hash;
  add_scene(hash, seen);
  hash.add(fmt::format("{} x {}", planned.options.width, planned.options.height));
  return hash.name();
}

std::vector<std::string> list_scene_warnings(const options::RunOptions& options, const scene::Scene& scene) {
  std::vector<std::string> warnings;
  if (!options.part.is_worker())
    warnings = {describe_unseen_light(options, scene), describe_light_below(scene),
                describe_test_without_effect(options, scene)};
  std::erase(warnings, "");
  // What is said of the scene holds for all its lights.
  for (const std::string& warning : scene.warnings)
    warnings.push_back(scene::name_without_light(scene) + ": " + warning);
  return warnings;
}

scene::Scene load_scene(const options::RunOptions& options, const std::string& argument) {
  scene::LoadOptions load;
  load.scenes_folder = options.resources.scenes;
  load.ground = options.ground;
  load.aspect = static_cast<double>(options.width) / options.height;
  load.light = options.light;
  scene::Scene scene = scene::load(argument, load);
  if (options.truth && options.map.blend_casters == render::BlendCasters::kOpaque) warn_of_blending(scene);
  if (options.bias.map.cull_front) warn_of_open_meshes(scene);
  return scene;
}

std::vector<scene::Scene> list_lit_scenes(const options::RunOptions& options, const scene::Scene& scene) {
  std::vector<scene::Scene> lit = scene::separate_lights(scene);
  const std::vector<std::string>& names = options.light_names;
  std::erase_if(
      lit, [&](const scene::Scene& each) { return !names.empty() && std::ranges::count(names, each.light.name) == 0; });
  return lit;
}

void fail_unknown_light(const options::RunOptions& options) {
  throw Error(ErrorKind::kUsage, fmt::format("--light-name: no scene has a light '{}'; the lights of several have "
                                             "names in their scene's file",
                                             fmt::join(options.light_names, "', '")));
}

std::vector<scene::Scene> load_scenes(const options::RunOptions& options) {
  std::vector<scene::Scene> scenes;
  for (const std::string& argument : options.scenes) {
    scene::Scene scene = load_scene(options, argument);
    const auto same_name = [&](const scene::Scene& known) { return known.name == scene.name; };
    if (std::any_of(scenes.begin(), scenes.end(), same_name)) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("two scenes are called '{}': rename one file, or run them apart", scene.name));
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

}  // namespace shadowbench::run
