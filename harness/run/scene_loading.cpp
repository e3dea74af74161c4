#include "harness/run/scene_loading.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"
#include "harness/scene/load.h"
#include "harness/scene/mesh_tools.h"
#include "reference/truth/occluders.h"

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

/// Single precision is spent on the distance from the origin: rays then start far off their surfaces, and miss
/// contacts.
void warn_of_distance(scene::Scene& scene) {
  const scene::Bounds bounds = scene.bounds();
  const glm::vec3 largest = glm::max(glm::abs(bounds.min), glm::abs(bounds.max)), size = bounds.max - bounds.min;
  const float farthest = std::max({largest.x, largest.y, largest.z});
  const float offset = truth::origin_offset(farthest, farthest);
  if (offset < 1e-4f * std::max({size.x, size.y, size.z})) return;
  scene.warnings.push_back(
      fmt::format("{} m from the origin, single precision leaves positions uncertain, and rays start {} m off their "
                  "surfaces: what is smaller is not seen; move the scene to the origin",
                  farthest, offset));
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

}  // namespace

scene::Scene load_scene(const options::RunOptions& options, const std::string& argument) {
  scene::LoadOptions load;
  load.scenes_folder = options.resources.scenes;
  load.ground = options.ground;
  load.aspect = static_cast<double>(options.width) / options.height;
  load.light = options.light;
  scene::Scene scene = scene::load(argument, load);
  if (options.truth && options.map.blend_casters == render::BlendCasters::kOpaque) warn_of_blending(scene);
  if (options.truth && !options.part.is_worker()) warn_of_distance(scene);
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
