#pragma once

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace shadowbench::scene {

/// Whether a file may require the extension: it is read, or says only how surfaces look beside their base colour.
bool is_known_extension(std::string_view extension);

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

/// The most that a file's compressed data may become, by either extension; 2 GiB.
constexpr std::size_t kMostUnpackedBytes = std::size_t{1} << 31;

/// Replaces every buffer view that EXT_meshopt_compression compresses by one of the bytes that it stands for.
/// No buffer view may claim more than 64 times its compressed size, the most that the format can hold.
/// Throws kInput, at `where`, for data that are damaged or claim too much, before anything is allocated for the claim.
tinygltf::Model unpack_meshopt(tinygltf::Model model, const std::string& where);

/// Gives every primitive that KHR_draco_mesh_compression compresses accessors of its own, with the indices, positions,
/// normals and texture coordinates that the compressed data hold; it then is a list of triangles.
/// Data may claim 256 MiB, or 1024 times their compressed size where that is more.
/// Throws kInput, at `where`, for data that are damaged or claim too much, before anything is allocated for the claim.
tinygltf::Model unpack_draco(tinygltf::Model model, const std::string& where);

/// A node and the product of the transforms on its way from the root.
struct PlacedNode {
  int node;
  glm::dmat4 world_from_node;
};

/// Lists the nodes of the default scene. Throws kInput where the nodes are no tree (a cycle, two parents, no such
/// node) or a transform is not finite or has the wrong length.
std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, const std::string& where);

}  // namespace shadowbench::scene
