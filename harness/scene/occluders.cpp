#include "harness/scene/occluders.h"

namespace shadowbench::scene {
namespace {

truth::CutOut make_cut_out(const Scene& scene, const Mesh& mesh, const Material& material) {
  truth::CutOut cut_out;
  for (const Vertex& vertex : mesh.vertices) cut_out.uvs.push_back(vertex.uv);
  cut_out.base_alpha = material.base_color.a;
  cut_out.cutoff = material.alpha_cutoff;
  if (material.base_color_texture < 0) return cut_out;
  const Texture& texture = scene.textures[static_cast<std::size_t>(material.base_color_texture)];
  cut_out.width = texture.width;
  cut_out.height = texture.height;
  for (std::size_t i = 3; i < texture.rgba.size(); i += 4) cut_out.alpha.push_back(texture.rgba[i]);
  return cut_out;
}

std::vector<truth::OccluderMesh> list_surfaces(const Scene& scene, bool casts_shadow) {
  std::vector<truth::OccluderMesh> meshes;
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.casts_shadow != casts_shadow) continue;
    truth::OccluderMesh& surface = meshes.emplace_back();
    for (const Vertex& vertex : mesh.vertices) surface.positions.push_back(vertex.position_ws);
    surface.indices = mesh.indices;
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (material.alpha_mode == AlphaMode::kMask) surface.cut_out = make_cut_out(scene, mesh, material);
  }
  return meshes;
}

}  // namespace

std::vector<truth::OccluderMesh> list_occluders(const Scene& scene) { return list_surfaces(scene, true); }

std::vector<truth::OccluderMesh> list_non_casters(const Scene& scene) { return list_surfaces(scene, false); }

}  // namespace shadowbench::scene
