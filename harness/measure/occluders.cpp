#include "harness/measure/occluders.h"

namespace shadowbench::measure {
namespace {

truth::CutOut make_cut_out(const scene::Scene& scene, const scene::Mesh& mesh, const scene::Material& material) {
  truth::CutOut cut_out;
  for (const scene::Vertex& vertex : mesh.vertices) cut_out.uvs.push_back(vertex.uv);
  cut_out.base_alpha = material.base_color.a;
  cut_out.cutoff = material.alpha_cutoff;
  if (material.base_color_texture < 0) return cut_out;
  const scene::Texture& texture = scene.textures[static_cast<std::size_t>(material.base_color_texture)];
  cut_out.width = texture.width;
  cut_out.height = texture.height;
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) cut_out.alpha.push_back(texture.rgba[i]);
  return cut_out;
}

}  // namespace

std::vector<truth::OccluderMesh> list_occluders(const scene::Scene& scene) {
  std::vector<truth::OccluderMesh> meshes;
  for (const scene::Mesh& mesh : scene.meshes) {
    if (!mesh.casts_shadow) continue;
    truth::OccluderMesh& occluder = meshes.emplace_back();
    for (const scene::Vertex& vertex : mesh.vertices) occluder.positions.push_back(vertex.position_ws);
    occluder.indices = mesh.indices;
    const scene::Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (material.alpha_mode == scene::AlphaMode::kMask) occluder.cut_out = make_cut_out(scene, mesh, material);
  }
  return meshes;
}

}  // namespace shadowbench::measure
