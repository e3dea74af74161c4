#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "base/error.h"
#include "harness/scene/files/gltf_extras.h"
#include "harness/scene/files/gltf_parse.h"
#include "harness/scene/files/mesh_file.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

/// A node and the product of the transforms on its way from the root.
struct PlacedNode {
  int node;
  glm::dmat4 world_from_node;
};

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

/// Requires a file that has scenes.
const tinygltf::Scene& default_scene(const tinygltf::Model& model) {
  const auto wanted = static_cast<std::size_t>(std::max(0, model.defaultScene));
  return model.scenes[std::min(wanted, model.scenes.size() - 1)];
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

/// Lists the nodes of the default scene. Throws kInput where the nodes are no tree (a cycle, two parents, no such
/// node) or a transform is not finite or has the wrong length.
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

constexpr std::size_t kMostCorners = std::size_t{3} << 25;

/// Turns the list of a strip's or fan's corners into separate triangles.
std::vector<std::uint32_t> to_triangles(const std::vector<std::uint32_t>& corners, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return corners;
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const bool odd = i % 2 == 1;
    const std::uint32_t first = fan ? corners[0] : corners[odd ? i - 1 : i - 2];
    const std::uint32_t second = fan ? corners[i - 1] : corners[odd ? i - 2 : i - 1];
    triangles.insert(triangles.end(), {first, second, corners[i]});
  }
  return triangles;
}

/// Which of a vertex's texture coordinates a material uses, and what makes the texture's own of them.
struct Texcoords {
  int set = 0;
  glm::dmat3 texture_from_mesh{1.0};
};

/// The two numbers of a member of KHR_texture_transform.
glm::dvec2 read_pair(const tinygltf::Value& transform, const std::string& key, const glm::dvec2& otherwise,
                     const std::string& where) {
  if (!transform.Has(key)) return otherwise;
  const tinygltf::Value& pair = transform.Get(key);
  if (pair.ArrayLen() == 2 && pair.Get(0).IsNumber() && pair.Get(1).IsNumber())
    return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
  fail_input(fmt::format("the {} of a KHR_texture_transform must be two numbers", key), where);
}

/// The transform moves, turns and scales, the scaling first; an angle turns counter-clockwise as a picture is seen,
/// whose rows go down.
Texcoords read_texcoords(const tinygltf::TextureInfo& texture, const std::string& where) {
  const auto extension = texture.extensions.find("KHR_texture_transform");
  if (extension == texture.extensions.end()) return {texture.texCoord};
  const tinygltf::Value& transform = extension->second;
  const glm::dvec2 offset = read_pair(transform, "offset", {0.0, 0.0}, where);
  const glm::dvec2 scale = read_pair(transform, "scale", {1.0, 1.0}, where);
  const bool turns = transform.Has("rotation");
  if (turns && !transform.Get("rotation").IsNumber())
    fail_input("the rotation of a KHR_texture_transform must be a number", where);
  const double angle = turns ? transform.Get("rotation").GetNumberAsDouble() : 0.0;
  const bool has_set = transform.Has("texCoord") && transform.Get("texCoord").IsInt();
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {has_set ? transform.Get("texCoord").GetNumberAsInt() : texture.texCoord,
          {scale.x * c, -scale.x * s, 0.0, scale.y * s, scale.y * c, 0.0, offset.x, offset.y, 1.0}};
}

/// Builds a model from a parsed file, part by part.
class GltfImporter {
 public:
  GltfImporter(const tinygltf::Model& source, std::string where) : source_(source), where_(std::move(where)) {}

  MeshFile import() {
    warn_of_extensions();
    if (!source_.scenes.empty()) result_.extras = read_scene_extras(default_scene(source_).extras, where_);
    for (const tinygltf::Material& material : source_.materials) add_material(material);
    for (const PlacedNode& placed : place_nodes(source_, where_)) {
      const tinygltf::Node& node = find_element(source_.nodes, placed.node, "there is no node", where_);
      if (node.mesh >= 0) add_mesh(node, placed.world_from_node);
      if (node.camera >= 0) add_camera(node, placed.world_from_node);
      add_light(node, placed.world_from_node);
      if (node.skin >= 0) warn("skins are not modelled: meshes are drawn as modelled, unposed");
    }
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail_input(message, where_); }

  void warn(const std::string& message) {
    if (warned_.insert(message).second) result_.warnings.push_back(message);
  }

  void warn_of_extensions() {
    for (const std::string& extension : source_.extensionsUsed)
      if (!is_known_extension(extension)) warn(fmt::format("the extension {} is ignored", extension));
  }

  void add_material(const tinygltf::Material& source) {
    Material material;
    material.name = source.name.empty() ? fmt::format("material {}", result_.materials.size()) : source.name;
    const std::vector<double>& factor = source.pbrMetallicRoughness.baseColorFactor;
    if (factor.size() != 4) fail(fmt::format("the base colour of '{}' must have 4 numbers", material.name));
    for (int i = 0; i < 4; ++i) material.base_color[i] = static_cast<float>(factor[static_cast<std::size_t>(i)]);
    const tinygltf::TextureInfo& texture = source.pbrMetallicRoughness.baseColorTexture;
    if (texture.index >= 0) material.base_color_texture = add_texture(texture.index);
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    if (source.alphaMode == "MASK") material.alpha_mode = AlphaMode::kMask;
    if (source.alphaMode == "BLEND") {
      material.alpha_mode = AlphaMode::kBlend;
      warn(fmt::format("material '{}' blends; cameras see it opaque", material.name));
    } else if (source.alphaMode != "OPAQUE" && source.alphaMode != "MASK") {
      fail(fmt::format("material '{}' has alphaMode '{}'; glTF knows OPAQUE, MASK and BLEND", material.name,
                       source.alphaMode));
    }
    result_.materials.push_back(material);
    texcoords_.push_back(read_texcoords(texture, where_));
  }

  int add_texture(int index) {
    const int image = find_element(source_.textures, index, "there is no texture", where_).source;
    if (image < 0 || static_cast<std::size_t>(image) >= source_.images.size())
      fail(fmt::format("texture {} has no image that can be read", index));
    if (const auto known = texture_of_image_.find(image); known != texture_of_image_.end()) return known->second;
    result_.textures.push_back(read_image(image));
    return texture_of_image_[image] = static_cast<int>(result_.textures.size()) - 1;
  }

  Texture read_image(int index) const {
    const tinygltf::Image& image = find_element(source_.images, index, "there is no image", where_);
    const std::string fallback_name = image.uri.empty() ? fmt::format("image {}", index) : image.uri;
    const std::string name = image.name.empty() ? fallback_name : image.name;
    if (image.bufferView >= 0)
      return decode_texture(read_buffer_view(source_, image.bufferView, "image", where_), name, where_,
                            result_.textures);
    if (image.image.empty()) fail(fmt::format("the image '{}' is missing or empty", fallback_name));
    return decode_texture(image.image, name, where_, result_.textures);
  }

  void add_mesh(const tinygltf::Node& node, const glm::dmat4& world_from_node) {
    for (const Mesh& local : local_meshes(node.mesh)) {
      count_corners(local.indices.size());
      Mesh mesh = transform_mesh(local, world_from_node);
      if (!node.name.empty()) mesh.name = node.name;
      mesh.casts_shadow = read_extra_flag(node.extras, "casts_shadow");
      mesh.may_cull_front = read_extra_flag(node.extras, "may_cull_front");
      result_.meshes.push_back(std::move(mesh));
    }
  }

  /// Counts what is read and what is placed, since a small file can name the same numbers many times.
  void count_corners(std::size_t corners) {
    corner_count_ += corners;
    if (corner_count_ > kMostCorners)
      fail(fmt::format("it has more than {} triangles, as read or as placed", kMostCorners / 3));
  }

  /// The primitives of a mesh, read once however often the mesh is placed.
  const std::vector<Mesh>& local_meshes(int index) {
    if (const auto known = local_meshes_.find(index); known != local_meshes_.end()) return known->second;
    const tinygltf::Mesh& source = find_element(source_.meshes, index, "there is no mesh", where_);
    const std::string name = source.name.empty() ? fmt::format("mesh {}", index) : source.name;
    std::vector<Mesh> meshes;
    for (const tinygltf::Primitive& primitive : source.primitives)
      if (is_drawn(primitive, name)) meshes.push_back(read_primitive(primitive, name));
    return local_meshes_[index] = std::move(meshes);
  }

  bool is_drawn(const tinygltf::Primitive& primitive, const std::string& name) {
    const bool has_faces = primitive.mode == TINYGLTF_MODE_TRIANGLES ||
                           primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
                           primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    if (!has_faces) warn(fmt::format("points and lines of '{}' are left out", name));
    if (!primitive.attributes.contains("POSITION")) warn(fmt::format("a part of '{}' has no positions", name));
    if (!primitive.targets.empty()) warn("morph targets are not modelled");
    if (primitive.attributes.contains("COLOR_0")) warn("vertex colours are ignored");
    return has_faces && primitive.attributes.contains("POSITION");
  }

  Mesh read_primitive(const tinygltf::Primitive& primitive, const std::string& name) {
    Mesh mesh;
    mesh.name = name;
    mesh.material = material_of(primitive);
    mesh.vertices = read_vertices(primitive, mesh);
    count_corners(mesh.vertices.size());
    mesh.indices = to_triangles(read_corners(primitive, mesh), primitive.mode);
    count_corners(mesh.indices.size());
    if (mesh.indices.size() % 3 != 0)
      fail(fmt::format("'{}' has {} corners, which is no multiple of 3", name, mesh.indices.size()));
    return primitive.attributes.contains("NORMAL") ? mesh : with_flat_normals(mesh);
  }

  int material_of(const tinygltf::Primitive& primitive) {
    if (primitive.material >= 0) {
      find_element(source_.materials, primitive.material, "there is no material", where_);
      return primitive.material;
    }
    const auto count = source_.materials.size();
    if (result_.materials.size() == count) {
      result_.materials.push_back({.name = "default"});
      texcoords_.emplace_back();
    }
    return static_cast<int>(count);
  }

  std::vector<std::uint32_t> read_corners(const tinygltf::Primitive& primitive, const Mesh& mesh) const {
    if (primitive.indices < 0) {
      std::vector<std::uint32_t> all(mesh.vertices.size());
      std::iota(all.begin(), all.end(), 0U);
      return all;
    }
    std::vector<std::uint32_t> corners = read_indices(source_, primitive.indices, where_);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] < mesh.vertices.size()) continue;
      fail(fmt::format("index {} of '{}' is {}, but there are {} vertices", i, mesh.name, corners[i],
                       mesh.vertices.size()));
    }
    return corners;
  }

  /// The floats of an attribute; empty where the primitive does not have it.
  std::vector<float> read_attribute(const tinygltf::Primitive& primitive, const std::string& attribute,
                                    int components) const {
    const auto found = primitive.attributes.find(attribute);
    if (found == primitive.attributes.end()) return {};
    return read_floats(source_, found->second, components, where_);
  }

  std::vector<Vertex> read_vertices(const tinygltf::Primitive& primitive, const Mesh& mesh) const {
    const Texcoords& texcoords = texcoords_[static_cast<std::size_t>(mesh.material)];
    const std::vector<float> positions = read_attribute(primitive, "POSITION", 3);
    const std::vector<float> normals = read_attribute(primitive, "NORMAL", 3);
    const std::vector<float> uvs = read_attribute(primitive, fmt::format("TEXCOORD_{}", texcoords.set), 2);
    const std::size_t count = positions.size() / 3;
    const bool same_count =
        (normals.empty() || normals.size() == 3 * count) && (uvs.empty() || uvs.size() == 2 * count);
    if (!same_count) fail(fmt::format("the attributes of '{}' differ in their number of elements", mesh.name));
    std::vector<Vertex> vertices(count);
    for (std::size_t i = 0; i < count; ++i) {
      vertices[i].position_ws = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
      if (!normals.empty()) vertices[i].normal_ws = {normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]};
      if (!uvs.empty()) vertices[i].uv = texcoords.texture_from_mesh * glm::dvec3(uvs[2 * i], uvs[2 * i + 1], 1.0);
    }
    return vertices;
  }

  void add_camera(const tinygltf::Node& node, const glm::dmat4& world_from_node) {
    const tinygltf::Camera& source = find_element(source_.cameras, node.camera, "there is no camera", where_);
    Camera camera;
    const std::string fallback_name = node.name.empty() ? fmt::format("camera {}", node.camera) : node.name;
    camera.name = source.name.empty() ? fallback_name : source.name;
    camera.position_ws = glm::vec3(world_from_node[3]);
    camera.forward_ws = glm::vec3(-world_from_node[2]);
    camera.up_ws = glm::vec3(world_from_node[1]);
    if (source.type == "orthographic")
      camera.orthographic_height_m = static_cast<float>(2.0 * source.orthographic.ymag);
    else
      camera.vertical_fov_rad = static_cast<float>(source.perspective.yfov);
    result_.cameras.push_back(camera);
  }

  void add_light(const tinygltf::Node& node, const glm::dmat4& world_from_node) {
    const auto extension = node.extensions.find("KHR_lights_punctual");
    if (extension == node.extensions.end() || !extension->second.Has("light")) return;
    const int index = extension->second.Get("light").GetNumberAsInt();
    const tinygltf::Light& source = find_element(source_.lights, index, "there is no light", where_);
    const std::optional<LightKind> kind =
        make_gltf_light(source.type, world_from_node, source.spot.innerConeAngle, source.spot.outerConeAngle);
    if (!kind) {
      warn(fmt::format("{} lights are not modelled yet; they are left out", source.type));
      return;
    }
    Light light;
    light.name = source.name;
    light.kind = *kind;
    if (source.color.size() == 3)
      for (int i = 0; i < 3; ++i) light.color[i] = static_cast<float>(source.color[static_cast<std::size_t>(i)]);
    const toml::table extras = read_light_extras(source.extras);
    result_.aimed.push_back(!extras.empty());
    result_.lights.push_back(extras.empty() ? std::move(light) : with_gltf_extras(light, extras, where_));
  }

  const tinygltf::Model& source_;
  std::string where_;
  MeshFile result_;
  std::set<std::string> warned_;
  std::map<int, int> texture_of_image_;
  std::map<int, std::vector<Mesh>> local_meshes_;
  std::vector<Texcoords> texcoords_;  ///< per material
  std::size_t corner_count_ = 0;
};

}  // namespace

MeshFile import_gltf(const std::filesystem::path& file) {
  const tinygltf::Model source = parse_gltf(file);
  return GltfImporter(source, file.string()).import();
}

}  // namespace shadowbench::scene
