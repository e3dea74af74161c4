#pragma once

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Which of a vertex's texture coordinates a material uses, and what makes the texture's own of them.
struct Texcoords {
  int set = 0;
  glm::dmat3 texture_from_mesh{1.0};
};

/// A file's materials, and the textures that give their colour and alpha.
struct GltfMaterials {
  std::vector<Material> materials;
  std::vector<Texcoords> texcoords;  ///< of each material
  std::vector<Texture> textures;
  std::vector<std::string> warnings;
};

/// Reads what casts and what is seen of each material: colour and alpha, as pbrMetallicRoughness or
/// KHR_materials_pbrSpecularGlossiness has them, and KHR_materials_transmission, which lets that share of the light
/// through. A picture that is missing is a warning where its alpha does not count.
/// Throws kInput, at `where`, for anything else that is wrong with a material or its picture.
GltfMaterials read_gltf_materials(const tinygltf::Model& model, const std::string& where);

}  // namespace shadowbench::scene
