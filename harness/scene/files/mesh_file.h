#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// What a .gltf, .glb or .obj file holds: geometry in world space and, in glTF files, perhaps cameras and lights. It
/// is not checked yet.
struct MeshFile {
  std::vector<Mesh> meshes;
  std::vector<Material> materials;  ///< at least one where there is a mesh
  std::vector<Texture> textures;
  std::vector<Camera> cameras;
  std::vector<Light> lights;  ///< named where there are several
  std::vector<std::string> warnings;
};

/// Whether the extension is .gltf, .glb or .obj, in upper or lower case.
bool is_mesh_file(const std::filesystem::path& file);

/// Reads a file by its extension. Throws kInput where it is missing, malformed or of another kind.
MeshFile import_mesh_file(const std::filesystem::path& file);

/// Adds geometry, materials, textures and warnings to a scene, but neither cameras nor lights.
Scene add_mesh_file(Scene scene, MeshFile file);

/// Decodes a PNG, JPEG, BMP, TGA or GIF picture to 8 bits and four channels.
/// Its header is read first. A side may have 16384 pixels, a picture 2^26, and all pictures of a file, of which
/// `others` are decoded already, 2^28 (1 GiB). Throws kInput, with `name` and `where`, for anything else.
Texture decode_texture(const std::vector<unsigned char>& bytes, const std::string& name, const std::string& where,
                       const std::vector<Texture>& others);

}  // namespace shadowbench::scene
