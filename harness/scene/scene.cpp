#include "harness/scene/scene.h"

namespace shadowbench::scene {

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
  }
  return scenes;
}

}  // namespace shadowbench::scene
