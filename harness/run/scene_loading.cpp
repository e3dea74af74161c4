#include "harness/run/scene_loading.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "harness/run/run_plan.h"
#include "harness/scene/load.h"
#include "harness/scene/mesh_tools.h"
#include "harness/scene/unseen_light.h"
#include "report/records/format.h"

namespace shadowbench::run {
namespace {

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
  const std::string advice = scene::advise_on_unseen_light(scene, views, aspect);
  if (views.empty() || advice.empty()) return "";
  return fmt::format("{}: the light reaches no surface in view, so that nothing is tested under it; {}", scene.name,
                     advice);
}

/// The map of a sun has no behind, and a light without a cone shines there too.
std::string describe_test_without_effect(const options::RunOptions& options, const scene::Scene& scene) {
  const std::optional<scene::Beam> beam = scene::find_beam(scene.light);
  if (options.range.behind_test || (beam && beam->has_edge())) return "";
  return scene.name + ": --behind-test off changes nothing: only a light with a cone has a behind";
}

}  // namespace

std::vector<std::string> list_scene_warnings(const options::RunOptions& options, const scene::Scene& scene) {
  std::vector<std::string> warnings;
  // What is said of the scene holds for all its lights.
  for (const std::string& warning : scene.warnings)
    warnings.push_back(scene::name_without_light(scene) + ": " + warning);
  if (options.part.is_worker()) return warnings;
  for (const std::string& warning : {describe_light_below(scene), describe_unseen_light(options, scene),
                                     describe_test_without_effect(options, scene)})
    if (!warning.empty()) warnings.push_back(warning);
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
