#include <fmt/format.h>
#include <stb/stb_image_write.h>
#include <tiny_gltf.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "base/error.h"
#include "harness/scene/files/gltf.h"

namespace shadowbench::scene {
namespace {

const tinygltf::Value& find_own(const tinygltf::Value& extras) {
  static const tinygltf::Value kNone{tinygltf::Value::Object()};
  return extras.Has("shadowbench") && extras.Get("shadowbench").IsObject() ? extras.Get("shadowbench") : kNone;
}

double read_number(const tinygltf::Value& value) {
  return value.IsNumber() ? value.GetNumberAsDouble() : std::numeric_limits<double>::quiet_NaN();
}

using Extras = std::map<std::string, tinygltf::Value>;

tinygltf::Value to_value(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return tinygltf::Value(*text);
  if (const auto number = node.value<double>()) return tinygltf::Value(*number);
  tinygltf::Value::Array list;
  for (const toml::node& each : *node.as_array()) list.push_back(to_value(each));
  return tinygltf::Value(std::move(list));
}

/// The text as JSON can hold it: names of other files may be in any encoding.
std::string to_utf8(const std::string& text) {
  using Json = nlohmann::json;
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

void take_bytes(void* to, void* bytes, int size) {
  const auto* first = static_cast<const unsigned char*>(bytes);
  auto& buffer = *static_cast<std::vector<unsigned char>*>(to);
  buffer.insert(buffer.end(), first, first + size);
}

/// The matrix of a node that looks along `forward`, its -z axis, from `position`.
std::vector<double> place_node(const glm::dvec3& position, const glm::dvec3& forward, const glm::dvec3& up) {
  const glm::dvec3 right = glm::normalize(glm::cross(forward, up));
  const glm::dmat4 matrix(glm::dvec4(right, 0.0), glm::dvec4(glm::normalize(glm::cross(right, forward)), 0.0),
                          glm::dvec4(-forward, 0.0), glm::dvec4(position, 1.0));
  return {glm::value_ptr(matrix), glm::value_ptr(matrix) + 16};
}

/// tinygltf 2.9 writes a member of its own in place of the extension, which 2.5 does not have.
template <class Node>
void set_light(Node& node, int light) {
  node.extensions["KHR_lights_punctual"] = tinygltf::Value(Extras{{"light", tinygltf::Value(light)}});
  if constexpr (requires { node.light; }) node.light = light;
}

/// Puts a file together.
class GlbBuilder {
 public:
  GlbBuilder(const Scene& scene, double aspect) : scene_(scene), aspect_(aspect) {
    model_.asset.version = "2.0";
    model_.asset.generator = "Shadowbench";
    model_.buffers.emplace_back();
    model_.scenes.emplace_back();
    model_.defaultScene = 0;
    model_.scenes[0].name = to_utf8(scene.name);
    model_.scenes[0].extras =
        own({{"title", tinygltf::Value(to_utf8(scene.title))}, {"background", list(scene.background)}});
  }

  std::string build() {
    for (const Texture& texture : scene_.textures) add_texture(texture);
    for (const Material& material : scene_.materials) add_material(material);
    for (const Mesh& mesh : scene_.meshes) add_mesh(mesh);
    for (const Camera& camera : scene_.cameras) add_camera(camera);
    add_light();
    std::ostringstream file;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, file, false, true);
    return std::move(file).str();
  }

 private:
  const Scene& scene_;
  double aspect_;
  tinygltf::Model model_;

  static tinygltf::Value own(Extras extras) {
    return tinygltf::Value(Extras{{"shadowbench", tinygltf::Value(std::move(extras))}});
  }

  static tinygltf::Value list(const glm::vec3& v) {
    tinygltf::Value::Array values;
    for (int i = 0; i < 3; ++i) values.emplace_back(static_cast<double>(v[i]));
    return tinygltf::Value(std::move(values));
  }

  template <class T>
  int add_view(std::span<const T> values, int target) {
    std::vector<unsigned char>& bytes = model_.buffers[0].data;
    bytes.resize((bytes.size() + 3) / 4 * 4);
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = bytes.size();
    view.byteLength = values.size_bytes();
    view.target = target;
    bytes.resize(bytes.size() + values.size_bytes());
    std::memcpy(bytes.data() + view.byteOffset, values.data(), values.size_bytes());
    model_.bufferViews.push_back(std::move(view));
    return static_cast<int>(model_.bufferViews.size()) - 1;
  }

  int add_accessor(int view, int component, int type, std::size_t count) {
    tinygltf::Accessor accessor;
    accessor.bufferView = view;
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = count;
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  /// `member` gives a vector of a vertex.
  template <class Member>
  int add_attribute(const Mesh& mesh, int components, const Member& member) {
    std::vector<float> values;
    for (const Vertex& vertex : mesh.vertices) {
      const auto& v = member(vertex);
      values.insert(values.end(), &v.x, &v.x + components);
    }
    const int view = add_view(std::span<const float>(values), TINYGLTF_TARGET_ARRAY_BUFFER);
    return add_accessor(view, TINYGLTF_COMPONENT_TYPE_FLOAT, components, mesh.vertices.size());
  }

  void add_texture(const Texture& texture) {
    std::vector<unsigned char> png;
    if (!stbi_write_png_to_func(&take_bytes, &png, texture.width, texture.height, 4, texture.rgba.data(),
                                4 * texture.width))
      throw Error(ErrorKind::kOutput, fmt::format("the texture '{}' cannot be packed", texture.name));
    tinygltf::Image image;
    image.name = to_utf8(texture.name);
    image.mimeType = "image/png";
    image.bufferView = add_view(std::span<const unsigned char>(png), 0);
    model_.images.push_back(std::move(image));
    tinygltf::Texture made;
    made.source = static_cast<int>(model_.images.size()) - 1;
    model_.textures.push_back(std::move(made));
  }

  void add_material(const Material& material) {
    tinygltf::Material made;
    made.name = to_utf8(material.name);
    made.doubleSided = true;
    made.pbrMetallicRoughness.metallicFactor = 0.0;
    made.pbrMetallicRoughness.baseColorFactor = {material.base_color.r, material.base_color.g, material.base_color.b,
                                                 material.base_color.a};
    made.pbrMetallicRoughness.baseColorTexture.index = material.base_color_texture;
    if (material.alpha_mode == AlphaMode::kBlend) made.alphaMode = "BLEND";
    if (material.alpha_mode == AlphaMode::kMask) {
      made.alphaMode = "MASK";
      made.alphaCutoff = static_cast<double>(material.alpha_cutoff);
    }
    model_.materials.push_back(std::move(made));
  }

  void add_mesh(const Mesh& mesh) {
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = mesh.material;
    primitive.attributes["POSITION"] = add_attribute(mesh, 3, [](const Vertex& v) { return v.position_ws; });
    add_extent(mesh, model_.accessors.back());
    primitive.attributes["NORMAL"] = add_attribute(
        mesh, 3, [](const Vertex& v) { return v.normal_ws; });
    primitive.attributes["TEXCOORD_0"] = add_attribute(mesh, 2, [](const Vertex& v) { return v.uv; });
    const int view = add_view(std::span<const std::uint32_t>(mesh.indices), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    primitive.indices =
        add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, mesh.indices.size());
    tinygltf::Mesh made;
    made.name = to_utf8(mesh.name);
    made.primitives.push_back(std::move(primitive));
    model_.meshes.push_back(std::move(made));
    tinygltf::Node node;
    node.name = to_utf8(mesh.name);
    node.mesh = static_cast<int>(model_.meshes.size()) - 1;
    if (!mesh.casts_shadow || !mesh.may_cull_front)
      node.extras = own({{"casts_shadow", tinygltf::Value(mesh.casts_shadow)},
                         {"may_cull_front", tinygltf::Value(mesh.may_cull_front)}});
    add_node(std::move(node));
  }

  static void add_extent(const Mesh& mesh, tinygltf::Accessor& positions) {
    Bounds bounds;
    for (const Vertex& vertex : mesh.vertices) bounds.add(vertex.position_ws);
    positions.minValues = {bounds.min.x, bounds.min.y, bounds.min.z};
    positions.maxValues = {bounds.max.x, bounds.max.y, bounds.max.z};
  }

  /// The planes of a projection lie around all that is before the camera.
  void add_camera(const Camera& camera) {
    double farthest = 1.0;
    for (const Mesh& mesh : scene_.meshes)
      for (const Vertex& vertex : mesh.vertices)
        farthest = std::max(farthest,
                            static_cast<double>(glm::dot(vertex.position_ws - camera.position_ws, camera.forward_ws)));
    constexpr double kFarOverNear = 1e4;
    const double far_m = 1.01 * farthest, near_m = far_m / kFarOverNear;
    tinygltf::Camera made;
    made.name = to_utf8(camera.name);
    if (camera.orthographic_height_m > 0.0f) {
      const double half = 0.5 * static_cast<double>(camera.orthographic_height_m);
      made.type = "orthographic";
      made.orthographic.xmag = half * aspect_;
      made.orthographic.ymag = half;
      made.orthographic.znear = near_m;
      made.orthographic.zfar = far_m;
    } else {
      made.type = "perspective";
      made.perspective.aspectRatio = aspect_;
      made.perspective.yfov = static_cast<double>(camera.vertical_fov_rad);
      made.perspective.znear = near_m;
      made.perspective.zfar = far_m;
    }
    model_.cameras.push_back(std::move(made));
    tinygltf::Node node;
    node.name = to_utf8(camera.name);
    node.camera = static_cast<int>(model_.cameras.size()) - 1;
    node.matrix = place_node(camera.position_ws, camera.forward_ws, camera.up_ws);
    add_node(std::move(node));
  }

  void add_light() {
    const GltfLight light = describe_gltf_light(scene_.light);
    tinygltf::Light made;
    const std::string name = to_utf8(scene_.light.name);
    made.name = name;
    made.type = light.type;
    made.intensity = static_cast<double>(scene_.light.intensity);
    made.color = {scene_.light.color.r, scene_.light.color.g, scene_.light.color.b};
    made.spot.innerConeAngle = light.inner_cone_rad;
    made.spot.outerConeAngle = light.outer_cone_rad;
    Extras extras;
    for (const auto& [key, value] : list_gltf_extras(scene_.light)) extras[std::string(key.str())] = to_value(value);
    made.extras = own(std::move(extras));
    model_.lights.push_back(std::move(made));
    model_.extensionsUsed.emplace_back("KHR_lights_punctual");
    tinygltf::Node node;
    node.name = name.empty() ? "light" : name;
    const glm::dvec3 up = std::abs(light.direction_ws.y) > 0.99 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
    node.matrix = place_node(light.position_ws, light.direction_ws, up);
    set_light(node, static_cast<int>(model_.lights.size()) - 1);
    add_node(std::move(node));
  }

  void add_node(tinygltf::Node node) {
    model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()));
    model_.nodes.push_back(std::move(node));
  }
};

}  // namespace

bool read_extra_flag(const tinygltf::Value& extras, const std::string& key) {
  const tinygltf::Value& value = find_own(extras).Get(key);
  return !value.IsBool() || value.Get<bool>();
}

toml::table read_light_extras(const tinygltf::Value& extras) {
  toml::table table;
  const tinygltf::Value& own = find_own(extras);
  for (const std::string& key : own.Keys()) {
    const tinygltf::Value& value = own.Get(key);
    if (!value.IsArray()) {
      table.insert(key, read_number(value));
      continue;
    }
    toml::array list;
    for (std::size_t i = 0; i < value.ArrayLen(); ++i) list.push_back(read_number(value.Get(static_cast<int>(i))));
    table.insert(key, std::move(list));
  }
  return table;
}

SceneExtras read_scene_extras(const tinygltf::Value& extras, const std::string& where) {
  const tinygltf::Value &title = find_own(extras).Get("title"), &background = find_own(extras).Get("background");
  SceneExtras read;
  if (title.IsString()) read.title = title.Get<std::string>();
  if (!background.IsArray()) return read;
  glm::vec3 color;
  for (int i = 0; i < 3; ++i) {
    const double part = read_number(background.Get(i));
    if (background.ArrayLen() != 3 || !(part >= 0.0 && part <= 1.0))
      fail_input("the background of the scene must be 3 numbers from 0 to 1", where);
    color[i] = static_cast<float>(part);
  }
  read.background = color;
  return read;
}

std::string write_glb(const Scene& scene, double aspect) { return GlbBuilder(scene, aspect).build(); }

}  // namespace shadowbench::scene
