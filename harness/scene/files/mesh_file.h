#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// What a model's file says of the scene as a whole, where it does.
struct SceneExtras {
  std::optional<std::string> title;
  std::optional<glm::vec3> background;  ///< linear
};

/// What a .gltf, .glb or .obj file holds: geometry in world space and, in glTF files, perhaps cameras and lights. It
/// is not checked yet.
struct MeshFile {
  std::vector<Mesh> meshes;
  std::vector<Material> materials;  ///< at least one where there is a mesh
  std::vector<Texture> textures;
  std::vector<Camera> cameras;
  std::vector<Light> lights;  ///< named where there are several
  std::vector<bool> aimed;    ///< of each light, whether the file says where it is as strong as a sun
  double rounding_m = 0.0;    ///< of positions, as the file has them
  SceneExtras extras;
  std::vector<std::string> warnings;
};

/// Whether the extension is .gltf, .glb or .obj, in upper or lower case.
bool is_mesh_file(const std::filesystem::path& file);

/// Reads a file by its extension; places become relative to `origin`, before they are rounded. Throws kInput where it
/// is missing, malformed or of another kind.
MeshFile import_mesh_file(const std::filesystem::path& file, const glm::dvec3& origin = glm::dvec3(0.0));

/// Reads a glTF 2.0 file (.gltf or .glb): its default scene, node transforms applied, skins at rest; README.md of
/// harness/scene names the extensions. Lights have intensity 1, or 0, because every picture has the same exposure.
/// Missing normals become flat ones. Warns about what it leaves out. Throws kInput for a file that is malformed, refers
/// outside its folder, or requires an extension that is not read.
MeshFile import_gltf(const std::filesystem::path& file, const glm::dvec3& origin = glm::dvec3(0.0));

/// Reads a Wavefront .obj file, and the diffuse colours, opacity (d, Tr, map_d) and textures of its material library.
///
/// Polygons become triangles. Corners without a normal get the mean of the faces around them that turn by less than
/// 45 degrees. A picture of opacity that has few half-tones is a mask of holes, any other one blends. A missing
/// material library or colour picture is a warning; a reference outside the file's folder an error. Throws kInput for
/// text that is UTF-16, and, with the line, for a coordinate that is not a finite number or an index out of range.
MeshFile import_obj(const std::filesystem::path& file, const glm::dvec3& origin = glm::dvec3(0.0));

/// The bytes of a .glb file of a scene: its meshes as they stand in the world, materials, textures, cameras of this
/// aspect (width / height), and its light as KHR_lights_punctual has it. What glTF has no word for goes into
/// `extras.shadowbench`, from where import_gltf() takes it: a light's size and all else of it in the words of a scene
/// file, `casts_shadow` and `may_cull_front` of a node, `title` and `background` of the scene.
/// Throws Error(kOutput) where a texture cannot be packed.
std::string write_glb(const Scene& scene, double aspect);

/// Adds geometry, materials, textures and warnings to a scene, but neither cameras nor lights.
Scene add_mesh_file(Scene scene, MeshFile file);

/// Decodes a picture of a format that stb_image knows to 8 bits and four channels.
/// Its header is read first. A side may have 16384 pixels, a picture 2^26, and all pictures of a file, of which
/// `others` are decoded already, 2^28 (1 GiB). Throws kInput, with `name` and `where`, for anything else.
Texture decode_texture(const std::vector<unsigned char>& bytes, const std::string& name, const std::string& where,
                       const std::vector<Texture>& others);

/// Resolves a reference that a file in `folder` makes; percent signs must be decoded already. Returns nothing if it
/// would leave that folder: by "../x" or "/etc/passwd", by a symbolic link, or by a NUL that hides its end. Links that
/// stay inside are followed, and the folder itself may be reached by one.
std::optional<std::filesystem::path> resolve_inside(const std::filesystem::path& folder, std::string_view reference);

}  // namespace shadowbench::scene
