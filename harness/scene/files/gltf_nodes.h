#pragma once

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

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

}  // namespace shadowbench::scene
