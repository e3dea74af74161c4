#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

namespace shadowbench::scene {

/// Parses a .gltf or .glb file and its buffers; images stay encoded, in `image`, or in their buffer view.
/// Reads nothing outside the file's folder. Throws kInput where the file is malformed, refers outside its folder or
/// requires an extension that is not read.
tinygltf::Model parse_gltf(const std::filesystem::path& file);

/// A node and the product of the transforms on its way from the root.
struct PlacedNode {
  int node;
  glm::dmat4 world_from_node;
};

/// Lists the nodes of the default scene. Throws kInput where the nodes are no tree (a cycle, two parents, no such
/// node) or a transform is not finite or has the wrong length.
std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, const std::string& where);

}  // namespace shadowbench::scene
