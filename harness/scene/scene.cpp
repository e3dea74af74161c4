#include "harness/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "harness/scene/validate.h"

namespace shadowbench::scene {
namespace {

truth::CutOut make_cut_out(const Scene& scene, const Mesh& mesh, const Material& material) {
  truth::CutOut cut_out;
  for (const Vertex& vertex : mesh.vertices) cut_out.uvs.push_back(vertex.uv);
  cut_out.base_alpha = material.base_color.a;
  cut_out.cutoff = material.alpha_cutoff;
  cut_out.dims = material.alpha_mode == AlphaMode::kBlend;
  if (material.base_color_texture < 0) return cut_out;
  const Texture& texture = scene.textures[static_cast<std::size_t>(material.base_color_texture)];
  cut_out.width = texture.width;
  cut_out.height = texture.height;
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) cut_out.alpha.push_back(texture.rgba[i]);
  return cut_out;
}

}  // namespace

void Bounds::add(const glm::vec3& p) {
  const bool first = empty();
  min = first ? p : glm::min(min, p);
  max = first ? p : glm::max(max, p);
}

Bounds Scene::bounds() const {
  Bounds box;
  for (const Mesh& mesh : meshes)
    for (const Vertex& vertex : mesh.vertices) box.add(vertex.position_ws);
  return box;
}

glm::dvec3 find_way_off(const Bounds& bounds) {
  constexpr double kFar = 4.0, kLeastSize = 1e-6;  // of the scene's size, and of the distance
  const glm::dvec3 min(bounds.min), max(bounds.max), middle = 0.5 * (min + max);
  const double distance = glm::length(middle), size = std::max(glm::length(max - min), kLeastSize * distance);
  if (!(distance <= double{kFarthest_m} && distance > kFar * size)) return glm::dvec3(0.0);
  const double step = std::exp2(std::floor(std::log2(size)));
  return step * glm::round(middle / step);
}

std::size_t Scene::triangle_count() const {
  std::size_t count = 0;
  for (const Mesh& mesh : meshes) count += mesh.indices.size() / 3;
  return count;
}

std::vector<Scene> separate_lights(const Scene& scene) {
  if (scene.other_lights.empty()) return {scene};
  std::vector<Light> lights = scene.other_lights;
  lights.insert(lights.begin(), scene.light);
  std::vector<Scene> scenes;
  for (Light& light : lights) {
    Scene& lit = scenes.emplace_back(scene);
    lit.other_lights.clear();
    lit.name += "." + light.name;
    lit.title += ": " + light.name;
    lit.light = std::move(light);
    std::erase_if(lit.cameras, [&](const Camera& each) { return !each.light.empty() && each.light != lit.light.name; });
  }
  return scenes;
}

std::string name_without_light(const Scene& scene) {
  const std::string end = "." + scene.light.name;
  const bool is_separate = !scene.light.name.empty() && scene.name.ends_with(end);
  return is_separate ? scene.name.substr(0, scene.name.size() - end.size()) : scene.name;
}

std::vector<truth::OccluderMesh> list_occluders(const Scene& scene, bool casts_shadow) {
  std::vector<truth::OccluderMesh> meshes;
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.casts_shadow != casts_shadow) continue;
    truth::OccluderMesh& surface = meshes.emplace_back();
    for (const Vertex& vertex : mesh.vertices) surface.positions.push_back(vertex.position_ws);
    surface.indices = mesh.indices;
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (material.alpha_mode != AlphaMode::kOpaque) surface.cut_out = make_cut_out(scene, mesh, material);
  }
  return meshes;
}

}  // namespace shadowbench::scene
