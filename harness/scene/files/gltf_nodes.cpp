#include "harness/scene/files/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <span>
#include <utility>

#include "base/error.h"
#include "harness/scene/files/gltf_parse.h"
#include "harness/scene/mesh_tools.h"

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

/// Of a quaternion's four numbers, or of none.
glm::dmat4 rotation_of(std::span<const double> xyzw, const std::string& owner, const std::string& where) {
  if (xyzw.empty()) return glm::dmat4(1.0);
  const glm::dquat rotation(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
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
  local = local * rotation_of(node.rotation, owner, where);
  return node.scale.empty() ? local : glm::scale(local, glm::make_vec3(node.scale.data()));
}

/// The roots of the default scene, of the first one, or, where a file has no scenes, the nodes that are no child.
std::vector<int> root_nodes(const tinygltf::Model& model) {
  if (!model.scenes.empty()) return default_scene(model).nodes;
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

bool is_shown(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_node_visibility");
  if (extension == node.extensions.end() || !extension->second.Has("visible")) return true;
  const tinygltf::Value& visible = extension->second.Get("visible");
  return !visible.IsBool() || visible.Get<bool>();
}

/// The attribute of EXT_mesh_gpu_instancing that has this name, as numbers; empty where there is none.
std::vector<double> read_instances(const tinygltf::Model& model, const tinygltf::Value& attributes, const char* name,
                                   int components, const std::string& where) {
  if (!attributes.Has(name)) return {};
  const tinygltf::Value& accessor = attributes.Get(name);
  if (!accessor.IsInt()) fail_input(fmt::format("the {} of instances must be an accessor", name), where);
  const std::vector<float> numbers = read_floats(model, accessor.GetNumberAsInt(), components, where);
  if (!std::ranges::all_of(numbers, [](float number) { return std::isfinite(number); }))
    fail_input(fmt::format("the {} of instances is not finite", name), where);
  return {numbers.begin(), numbers.end()};
}

/// The matrices that move each vertex, from its joints and their weights.
class VertexPose {
 public:
  VertexPose(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const std::vector<glm::dmat4>& joints,
             const std::string& where)
      : joints_(joints) {
    const auto read = [&](const std::string& attribute) {
      const auto found = primitive.attributes.find(attribute);
      return found == primitive.attributes.end() ? std::vector<float>() : read_floats(model, found->second, 4, where);
    };
    for (int set = 0; set == 0 || primitive.attributes.contains(fmt::format("JOINTS_{}", set)); ++set) {
      sets_.push_back({read(fmt::format("JOINTS_{}", set)), read(fmt::format("WEIGHTS_{}", set))});
      for (const float joint : sets_.back().joints)
        if (!(joint >= 0.0f && joint < static_cast<float>(joints.size())))
          fail_input(fmt::format("a vertex follows joint {} of {}", joint, joints.size()), where);
    }
  }

  bool fits(std::size_t vertices) const {
    return std::ranges::all_of(
        sets_, [&](const Set& set) { return set.joints.size() == 4 * vertices && set.weights.size() == 4 * vertices; });
  }

  /// Weights need not add up to 1 to the last bit; a vertex without any follows its first joint.
  glm::dmat4 operator()(std::size_t vertex) const {
    glm::dmat4 sum(0.0);
    double weights = 0.0;
    for (const Set& set : sets_) {
      for (std::size_t i = 4 * vertex; i < 4 * vertex + 4; ++i) {
        const auto weight = static_cast<double>(set.weights[i]);
        sum += weight * joint(set, i);
        weights += weight;
      }
    }
    return weights > 0.0 ? sum / weights : joint(sets_.front(), 4 * vertex);
  }

 private:
  struct Set {
    std::vector<float> joints, weights;  ///< four per vertex
  };

  const glm::dmat4& joint(const Set& set, std::size_t i) const {
    return joints_[static_cast<std::size_t>(set.joints[i])];
  }

  const std::vector<glm::dmat4>& joints_;
  std::vector<Set> sets_;
};

}  // namespace

const tinygltf::Scene& default_scene(const tinygltf::Model& model) {
  const auto wanted = static_cast<std::size_t>(std::max(0, model.defaultScene));
  return model.scenes[std::min(wanted, model.scenes.size() - 1)];
}

std::vector<PlacedNode> place_nodes(const tinygltf::Model& model, const glm::dmat4& world_from_file,
                                    const std::string& where) {
  std::vector<PlacedNode> waiting;
  // The last node of the list is placed first, so roots and children are put there in reverse.
  const std::vector<int> roots = root_nodes(model);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) waiting.push_back({*root, world_from_file});
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
    placed.push_back({parent.node, parent.world_from_node * local_transform(model, parent.node, where),
                      parent.is_visible && is_shown(model.nodes[index])});
    const std::vector<int>& children = model.nodes[index].children;
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      waiting.push_back({*child, placed.back().world_from_node, placed.back().is_visible});
  }
  return placed;
}

std::vector<glm::dmat4> place_instances(const tinygltf::Model& model, const PlacedNode& placed,
                                        const std::string& where) {
  const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(placed.node)];
  const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
  if (extension == node.extensions.end()) return {placed.world_from_node};
  const std::string owner = "the instances of " + describe(model, placed.node);
  if (!extension->second.Has("attributes")) fail_input(owner + " have no attributes", where);
  const tinygltf::Value& attributes = extension->second.Get("attributes");
  const std::vector<double> translations = read_instances(model, attributes, "TRANSLATION", 3, where);
  const std::vector<double> rotations = read_instances(model, attributes, "ROTATION", 4, where);
  const std::vector<double> scales = read_instances(model, attributes, "SCALE", 3, where);
  const std::size_t count = std::max({translations.size() / 3, rotations.size() / 4, scales.size() / 3});
  for (const std::size_t each : {translations.size() / 3, rotations.size() / 4, scales.size() / 3})
    if (each > 0 && each != count) fail_input(owner + " differ in their number of elements", where);
  std::vector<glm::dmat4> places;
  for (std::size_t i = 0; i < count; ++i) {
    glm::dmat4 place = placed.world_from_node;
    if (!translations.empty()) place = glm::translate(place, glm::make_vec3(&translations[3 * i]));
    if (!rotations.empty()) place = place * rotation_of(std::span(rotations).subspan(4 * i, 4), owner, where);
    places.push_back(scales.empty() ? place : glm::scale(place, glm::make_vec3(&scales[3 * i])));
  }
  return places;
}

std::vector<glm::dmat4> pose_joints(const tinygltf::Model& model, int index, const std::vector<PlacedNode>& nodes,
                                    const std::string& where) {
  const tinygltf::Skin& skin = find_element(model.skins, index, "there is no skin", where);
  std::map<int, glm::dmat4> places;
  for (const PlacedNode& placed : nodes) places[placed.node] = placed.world_from_node;
  std::vector<float> inverse;
  if (skin.inverseBindMatrices >= 0) {
    inverse = read_floats(model, skin.inverseBindMatrices, 16, where);
    if (inverse.size() < 16 * skin.joints.size())
      fail_input(fmt::format("skin {} has {} joints, but {} inverse bind matrices", index, skin.joints.size(),
                             inverse.size() / 16),
                 where);
  }
  std::vector<glm::dmat4> joints;
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const auto place = places.find(skin.joints[i]);
    if (place == places.end()) return {};
    joints.push_back(inverse.empty() ? place->second : place->second * glm::dmat4(glm::make_mat4(&inverse[16 * i])));
  }
  return joints;
}

Mesh pose_mesh(Mesh mesh, const tinygltf::Model& model, const tinygltf::Primitive& primitive,
               const std::vector<glm::dmat4>& joints, const std::string& where) {
  const VertexPose pose(model, primitive, joints, where);
  if (!pose.fits(mesh.vertices.size()))
    fail_input(
        fmt::format("'{}' has {} vertices, and joints or weights for another number", mesh.name, mesh.vertices.size()),
        where);
  return transform_mesh(std::move(mesh), pose);
}

}  // namespace shadowbench::scene
