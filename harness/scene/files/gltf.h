#pragma once

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/toml.h"
#include "harness/scene/files/mesh_file.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Whether an extension is read, or changes nothing of what casts shadows; a file may require it, and no more need be
/// said. Of any other the user is warned.
bool is_harmless_extension(std::string_view extension);

/// Parses a .gltf or .glb file and its buffers, and unpacks those that are compressed; images stay encoded, in
/// `image`, or in their buffer view.
/// Reads nothing outside the file's folder. Throws kInput where the file is malformed, refers outside its folder or
/// requires an extension that is not read.
tinygltf::Model parse_gltf(const std::filesystem::path& file);

/// The element of one of a file's lists that an index names. Throws kInput, at `where`, if there is none; the message
/// is `complaint`, such as "there is no mesh", and the index.
template <class T>
const T& find_element(const std::vector<T>& list, int index, const std::string& complaint, const std::string& where) {
  if (index >= 0 && static_cast<std::size_t>(index) < list.size()) return list[static_cast<std::size_t>(index)];
  fail_input(fmt::format("{} {} (of {})", complaint, index, list.size()), where);
}

/// A whole number, 0 or more, that an extension's object must have.
/// Throws kInput, about `owner`, at `where`, where it has none.
std::size_t read_whole_number(const tinygltf::Value& object, const std::string& key, const std::string& owner,
                              const std::string& where);

/// Replaces every buffer view that EXT_meshopt_compression compresses by one of the bytes that it stands for.
/// No buffer view may claim more than 64 times its compressed size, the most that the format can hold.
/// Throws kInput, at `where`, for data that are damaged or claim too much, before anything is allocated for the claim.
tinygltf::Model unpack_meshopt(tinygltf::Model model, const std::string& where);

/// Reads an accessor's elements as floats, `components` per element; normalized integers become [-1,1] or [0,1].
/// Checks the accessor, its buffer view and buffer before it reads a byte, sparse ones included.
/// Throws kInput, at `where`, naming the accessor and what is out of range.
std::vector<float> read_floats(const tinygltf::Model& model, int accessor, int components, const std::string& where);

/// Reads an accessor's elements as indices; same checks.
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor, const std::string& where);

/// Copies a span's bytes after checking that they lie in its buffer. Throws kInput, about `owner`, at `where`.
std::vector<unsigned char> read_span(const tinygltf::Model& model, const tinygltf::BufferView& span,
                                     const std::string& owner, const std::string& where);

/// The same of one of the file's buffer views.
std::vector<unsigned char> read_buffer_view(const tinygltf::Model& model, int view, const std::string& owner,
                                            const std::string& where);

/// A node and the product of the transforms on its way from the root.
struct PlacedNode {
  int node;
  glm::dmat4 world_from_node;
  bool is_visible = true;  ///< false where KHR_node_visibility hides the node or one above it
};

/// Requires a file that has scenes.
const tinygltf::Scene& default_scene(const tinygltf::Model& model);

/// Lists the nodes of the default scene, with their roots in `world_from_file`. Throws kInput where the nodes are no
/// tree (a cycle, two parents, no such node) or a transform is not finite or has the wrong length.
std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, const glm::dmat4& world_from_file,
                                    const std::string& where);

/// Where a node's mesh stands: once, or as often as its EXT_mesh_gpu_instancing says.
/// Throws kInput, at `where`, for attributes that are malformed or differ in number.
std::vector<glm::dmat4> place_instances(const tinygltf::Model& model, const PlacedNode& placed,
                                        const std::string& where);

/// The matrix of each joint of a skin: from a vertex as it was bound to the joint's place in the world. Empty where a
/// joint is not in the default scene. Throws kInput, at `where`, for inverse bind matrices that do not fit.
std::vector<glm::dmat4> pose_joints(const tinygltf::Model& model, int skin, const std::vector<PlacedNode>& nodes,
                                    const std::string& where);

/// Moves each vertex of a primitive as its joints move; the transform of the mesh's own node does not count.
/// Source: glTF 2.0, 3.7.3. Throws kInput, at `where`, for joints or weights that do not fit the vertices.
Mesh pose_mesh(Mesh mesh, const tinygltf::Model& model, const tinygltf::Primitive& primitive,
               const std::vector<glm::dmat4>& joints, const std::string& where);

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

// What write_glb() puts beside what glTF has words for: the object `shadowbench` among the extras, which other programs
// use too. Where it is missing everything is as usual.

/// Of a mesh's node; true unless it is said to be false.
bool read_extra_flag(const tinygltf::Value& extras, const std::string& key);

/// Of a light, as the table of a scene file; what is no number becomes NaN, which a scene file refuses.
toml::table read_light_extras(const tinygltf::Value& extras);

/// Of a scene. Throws kInput, at `where`, for a background that is no colour.
SceneExtras read_scene_extras(const tinygltf::Value& extras, const std::string& where);

}  // namespace shadowbench::scene
