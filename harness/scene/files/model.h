#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// What a model file holds: geometry in world space and, in glTF files, perhaps cameras and a light. Not yet checked.
struct ImportedModel {
  std::vector<Mesh> meshes;
  std::vector<Material> materials;  ///< at least one where there is a mesh
  std::vector<Texture> textures;
  std::vector<Camera> cameras;
  std::optional<Light> light;
  std::vector<std::string> warnings;
};

/// Says whether import_model reads files of this kind: .gltf, .glb or .obj, in either case.
bool is_model_file(const std::filesystem::path& file);

/// Reads a model by its file's extension. Throws kInput where it is missing, malformed or of another kind.
ImportedModel import_model(const std::filesystem::path& file);

/// Adds a model's geometry, materials, textures and warnings to a scene; its cameras and light are left out.
Scene add_model(Scene scene, ImportedModel model);

/// Decodes a PNG, JPEG, BMP, TGA or GIF picture to 8 bits and four channels.
/// Its header is read first: no side may be longer than 16384 pixels, no picture larger than 2^26, and all of a model,
/// of which `others` are decoded, no larger than 2^28 (1 GiB). Throws kInput, naming `name` and `where`, for anything
/// else.
Texture decode_texture(const std::vector<unsigned char>& bytes, const std::string& name, const std::string& where,
                       const std::vector<Texture>& others);

}  // namespace shadowbench::scene
