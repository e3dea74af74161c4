#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "base/error.h"
#include "harness/scene/files/gltf_parse.h"

namespace shadowbench::scene {
namespace {

std::string describe(const tinygltf::Model& model, int node) {
  const std::string& name = model.nodes[static_cast<std::size_t>(node)].name;
  return name.empty() ? fmt::format("node {}", node) : fmt::format("node {} ('{}')", node, name);
}

/// Throws unless the values are absent or as many as they must be, and finite.
void check_values(const std::vector<double>& values, std::size_t count, const std::string& what,
                  const std::string& where) {
  if (values.empty()) return;
  if (values.size() != count)
    fail_input(fmt::format("{} must have {} numbers, but has {}", what, count, values.size()), where);
  for (const double value : values)
    if (!std::isfinite(value)) fail_input(what + " is not finite", where);
}

glm::dmat4 rotation_of(const tinygltf::Node& node, const std::string& owner, const std::string& where) {
  if (node.rotation.empty()) return glm::dmat4(1.0);
  const glm::dquat rotation(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
  const double length = glm::length(rotation);
  if (!(length > 0.0)) fail_input(fmt::format("the rotation of {} is zero", owner), where);
  return glm::mat4_cast(rotation / length);
}

glm::dmat4 local_transform(const tinygltf::Model& model, int index, const std::string& where) {
  const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(index)];
  const std::string owner = describe(model, index);
  check_values(node.matrix, 16, "the matrix of " + owner, where);
  check_values(node.translation, 3, "the translation of " + owner, where);
  check_values(node.rotation, 4, "the rotation of " + owner, where);
  check_values(node.scale, 3, "the scale of " + owner, where);
  if (!node.matrix.empty()) return glm::make_mat4(node.matrix.data());
  glm::dmat4 local(1.0);
  if (!node.translation.empty()) local = glm::translate(local, glm::make_vec3(node.translation.data()));
  local = local * rotation_of(node, owner, where);
  return node.scale.empty() ? local : glm::scale(local, glm::make_vec3(node.scale.data()));
}

/// The roots of the default scene, of the first one, or, where a file has no scenes, the nodes that are no child.
std::vector<int> root_nodes(const tinygltf::Model& model) {
  if (!model.scenes.empty()) {
    const auto wanted = static_cast<std::size_t>(std::max(0, model.defaultScene));
    return model.scenes[std::min(wanted, model.scenes.size() - 1)].nodes;
  }
  std::vector<bool> is_child(model.nodes.size(), false);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children)
      if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
        is_child[static_cast<std::size_t>(child)] = true;
  }
  std::vector<int> roots;
  for (std::size_t i = 0; i < is_child.size(); ++i)
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  return roots;
}

}  // namespace

std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, const std::string& where) {
  std::vector<PlacedNode> waiting;
  // The last node of the list is placed first, so roots and children are put there in reverse.
  const std::vector<int> roots = root_nodes(model);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) waiting.push_back({*root, glm::dmat4(1.0)});
  if (waiting.empty() && !model.nodes.empty())
    fail_input("no node is a root: the scene lists none, or the nodes form a cycle", where);
  std::vector<bool> seen(model.nodes.size(), false);
  std::vector<PlacedNode> placed;
  while (!waiting.empty()) {
    const PlacedNode parent = waiting.back();
    waiting.pop_back();
    const auto index = static_cast<std::size_t>(parent.node);
    find_element(model.nodes, parent.node, "there is no node", where);
    if (seen[index]) {
      fail_input(fmt::format("{} is reached twice: the nodes form a cycle, or it has two parents",
                             describe(model, parent.node)),
                 where);
    }
    seen[index] = true;
    placed.push_back({parent.node, parent.world_from_node * local_transform(model, parent.node, where)});
    const std::vector<int>& children = model.nodes[index].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      waiting.push_back({*child, placed.back().world_from_node});
  }
  return placed;
}

}  // namespace shadowbench::scene
