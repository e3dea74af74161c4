#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "harness/scene/files/gltf.h"
#include "harness/scene/files/mesh_file.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

constexpr std::size_t kMostElements = std::size_t{1} << 27;
/// The most elements of an accessor without a buffer view; they are all zero, and take no room in the file.
constexpr std::size_t kMostZeros = std::size_t{1} << 16;

/// Bytes that were found to lie inside their buffer.
struct ByteSpan {
  const unsigned char* data = nullptr;
  std::size_t size = 0;
};

ByteSpan checked_span(const tinygltf::Model& model, const tinygltf::BufferView& view, const std::string& owner,
                      const std::string& where) {
  const std::vector<unsigned char>& bytes =
      find_element(model.buffers, view.buffer, owner + " names buffer", where).data;
  if (view.byteOffset <= bytes.size() && view.byteLength <= bytes.size() - view.byteOffset)
    return {bytes.data() + view.byteOffset, view.byteLength};
  fail_input(fmt::format("{} runs past its buffer: offset {} + {} bytes of {}", owner, view.byteOffset, view.byteLength,
                         bytes.size()),
             where);
}

ByteSpan checked_view(const tinygltf::Model& model, int index, const std::string& owner, const std::string& where) {
  const tinygltf::BufferView& view = find_element(model.bufferViews, index, owner + ": there is no buffer view", where);
  return checked_span(model, view, fmt::format("{}: buffer view {}", owner, index), where);
}

/// A type that glTF 2.0 knows for the components of an element.
struct ComponentType {
  int code = 0;
  std::size_t bytes = 0;
  double largest = 1.0;  ///< what stands for 1 where integers are normalized
  bool is_unsigned = false;
  double (*load)(const unsigned char* bytes) = nullptr;
};

template <class T>
double load(const unsigned char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

template <class T>
constexpr ComponentType describe(int code, double largest) {
  return {code, sizeof(T), largest, std::is_unsigned_v<T>, &load<T>};
}

constexpr std::array kComponentTypes{describe<std::int8_t>(TINYGLTF_COMPONENT_TYPE_BYTE, 127.0),
                                     describe<std::uint8_t>(TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, 255.0),
                                     describe<std::int16_t>(TINYGLTF_COMPONENT_TYPE_SHORT, 32767.0),
                                     describe<std::uint16_t>(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, 65535.0),
                                     describe<std::uint32_t>(TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, 1.0),
                                     describe<float>(TINYGLTF_COMPONENT_TYPE_FLOAT, 1.0)};

const ComponentType& find_type(int code, const std::string& owner, const std::string& where) {
  const auto found = std::ranges::find(kComponentTypes, code, &ComponentType::code);
  if (found != kComponentTypes.end()) return *found;
  fail_input(fmt::format("{} has component type {}, which glTF 2.0 does not know", owner, code), where);
}

/// How elements lie in a checked span; all of them lie inside it.
struct Elements {
  const unsigned char* data = nullptr;  ///< null: all zero
  std::size_t count = 0;
  std::size_t stride = 0;
  const ComponentType* type = nullptr;
  std::size_t components = 0;
};

/// Checks that `layout.count` elements from `offset` lie inside the span, and points the layout at the first.
Elements place(Elements layout, ByteSpan span, std::size_t offset, const std::string& owner, const std::string& where) {
  const std::size_t element_size = layout.type->bytes * layout.components;
  if (layout.stride == 0) layout.stride = element_size;
  if (layout.stride < element_size) {
    fail_input(fmt::format("{} has a stride of {} bytes for elements of {}", owner, layout.stride, element_size),
               where);
  }
  const bool fits = layout.count > 0 && offset <= span.size && element_size <= span.size - offset &&
                    layout.count - 1 <= (span.size - offset - element_size) / layout.stride;
  if (layout.count > 0 && !fits) {
    fail_input(fmt::format("{} is out of range: {} elements of {} bytes, stride {}, from byte {} of "
                           "a buffer view of {} bytes",
                           owner, layout.count, element_size, layout.stride, offset, span.size),
               where);
  }
  layout.data = span.data + offset;
  return layout;
}

Elements checked_elements(const tinygltf::Model& model, int index, int components, const std::string& where) {
  const std::string owner = fmt::format("accessor {}", index);
  const tinygltf::Accessor& accessor = find_element(model.accessors, index, "there is no accessor", where);
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != components)
    fail_input(fmt::format("{} must have {} component(s) per element", owner, components), where);
  if (accessor.count > kMostElements)
    fail_input(fmt::format("{} has {} elements; at most {} are read", owner, accessor.count, kMostElements), where);
  Elements elements{nullptr, accessor.count, 0, &find_type(accessor.componentType, owner, where),
                    static_cast<std::size_t>(components)};
  if (accessor.bufferView < 0 && accessor.count > kMostZeros) {
    fail_input(fmt::format("{} has {} elements and no buffer view; at most {} such zeros are read", owner,
                           accessor.count, kMostZeros),
               where);
  }
  if (accessor.bufferView < 0) return elements;
  const ByteSpan span = checked_view(model, accessor.bufferView, owner, where);
  elements.stride = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
  return place(elements, span, accessor.byteOffset, owner, where);
}

std::vector<double> load_all(const Elements& elements) {
  std::vector<double> values(elements.count * elements.components, 0.0);
  if (!elements.data) return values;
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = elements.type->load(elements.data + i / elements.components * elements.stride +
                                    i % elements.components * elements.type->bytes);
  return values;
}

/// Replaces the elements that a sparse accessor lists.
std::vector<double> with_sparse_values(std::vector<double> values, const tinygltf::Model& model,
                                       const tinygltf::Accessor& accessor, const Elements& base,
                                       const std::string& where) {
  const auto& sparse = accessor.sparse;
  const std::string owner = fmt::format("sparse accessor '{}'", accessor.name);
  // Offsets are signed in tinygltf 2.5 and unsigned in 2.9.
  if (sparse.count < 0 || static_cast<std::size_t>(sparse.count) > base.count ||
      std::cmp_less(sparse.indices.byteOffset, 0) || std::cmp_less(sparse.values.byteOffset, 0))
    fail_input(fmt::format("{} has a count or offset out of range", owner), where);
  const auto count = static_cast<std::size_t>(sparse.count);
  const Elements slots = place({nullptr, count, 0, &find_type(sparse.indices.componentType, owner, where), 1},
                               checked_view(model, sparse.indices.bufferView, owner, where),
                               static_cast<std::size_t>(sparse.indices.byteOffset), owner, where);
  const Elements news = place({nullptr, count, 0, base.type, base.components},
                              checked_view(model, sparse.values.bufferView, owner, where),
                              static_cast<std::size_t>(sparse.values.byteOffset), owner, where);
  const std::vector<double> slot_values = load_all(slots);
  const std::vector<double> new_values = load_all(news);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(slot_values[i] >= 0.0 && slot_values[i] < static_cast<double>(base.count)))
      fail_input(fmt::format("{} replaces element {} of {}", owner, slot_values[i], base.count), where);
    std::copy_n(
        new_values.begin() + static_cast<std::ptrdiff_t>(i * base.components), base.components,
        values.begin() + static_cast<std::ptrdiff_t>(slot_values[i]) * static_cast<std::ptrdiff_t>(base.components));
  }
  return values;
}

/// What an accessor holds, as numbers.
struct Values {
  std::vector<double> all;
  ComponentType type;
  bool is_normalized = false;
};

Values read_values(const tinygltf::Model& model, int index, int components, const std::string& where) {
  const Elements elements = checked_elements(model, index, components, where);
  const tinygltf::Accessor& accessor = model.accessors[static_cast<std::size_t>(index)];
  std::vector<double> values = load_all(elements);
  if (accessor.sparse.isSparse) values = with_sparse_values(std::move(values), model, accessor, elements, where);
  return {std::move(values), *elements.type, accessor.normalized};
}

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

/// What a texture's object in an extension says.
tinygltf::TextureInfo to_texture_info(const tinygltf::Value& object) {
  tinygltf::TextureInfo info;
  if (object.Has("index") && object.Get("index").IsInt()) info.index = object.Get("index").GetNumberAsInt();
  if (object.Has("texCoord") && object.Get("texCoord").IsInt()) info.texCoord = object.Get("texCoord").GetNumberAsInt();
  if (object.Has("extensions") && object.Get("extensions").IsObject())
    for (const std::string& key : object.Get("extensions").Keys())
      info.extensions[key] = object.Get("extensions").Get(key);
  return info;
}

/// The colour of a material, whichever model of surfaces has it.
struct Colour {
  std::vector<double> factor;
  tinygltf::TextureInfo texture;
};

Colour find_colour(const tinygltf::Material& material) {
  const auto extension = material.extensions.find("KHR_materials_pbrSpecularGlossiness");
  if (extension == material.extensions.end())
    return {material.pbrMetallicRoughness.baseColorFactor, material.pbrMetallicRoughness.baseColorTexture};
  Colour colour{{1.0, 1.0, 1.0, 1.0}, {}};
  const tinygltf::Value& diffuse = extension->second;
  if (diffuse.Has("diffuseFactor")) {
    colour.factor.clear();
    const tinygltf::Value& factor = diffuse.Get("diffuseFactor");
    for (std::size_t i = 0; i < factor.ArrayLen(); ++i)
      colour.factor.push_back(factor.Get(static_cast<int>(i)).GetNumberAsDouble());
  }
  if (diffuse.Has("diffuseTexture")) colour.texture = to_texture_info(diffuse.Get("diffuseTexture"));
  return colour;
}

class MaterialReader {
 public:
  MaterialReader(const tinygltf::Model& source, const std::string& where) : source_(source), where_(where) {}

  GltfMaterials read() {
    for (const tinygltf::Material& material : source_.materials) add_material(material);
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail_input(message, where_); }
  void warn(std::string message) { result_.warnings.push_back(std::move(message)); }

  void add_material(const tinygltf::Material& source) {
    Material material;
    material.name = source.name.empty() ? fmt::format("material {}", result_.materials.size()) : source.name;
    const Colour colour = find_colour(source);
    if (colour.factor.size() != 4) fail(fmt::format("the base colour of '{}' must have 4 numbers", material.name));
    for (int i = 0; i < 4; ++i) material.base_color[i] = static_cast<float>(colour.factor[static_cast<std::size_t>(i)]);
    material.alpha_mode = read_alpha_mode(source, material.name);
    material.alpha_cutoff = static_cast<float>(source.alphaCutoff);
    const bool counts = material.alpha_mode != AlphaMode::kOpaque;
    material.base_color_texture = colour.texture.index < 0 ? -1 : add_texture(colour.texture.index, material, counts);
    transmit(source, material);
    if (material.alpha_mode == AlphaMode::kBlend)
      warn(fmt::format("material '{}' blends; cameras see it opaque", material.name));
    result_.materials.push_back(material);
    result_.texcoords.push_back(read_texcoords(colour.texture, where_));
  }

  AlphaMode read_alpha_mode(const tinygltf::Material& source, const std::string& name) const {
    static const std::map<std::string, AlphaMode> modes = {
        {"OPAQUE", AlphaMode::kOpaque}, {"MASK", AlphaMode::kMask}, {"BLEND", AlphaMode::kBlend}};
    if (const auto mode = modes.find(source.alphaMode); mode != modes.end()) return mode->second;
    fail(fmt::format("material '{}' has alphaMode '{}'; glTF knows OPAQUE, MASK and BLEND", name, source.alphaMode));
  }

  /// A surface that transmits dims rays by the rest, as one that blends.
  void transmit(const tinygltf::Material& source, Material& material) {
    const auto extension = source.extensions.find("KHR_materials_transmission");
    if (extension == source.extensions.end() || !extension->second.Has("transmissionFactor")) return;
    const double factor = extension->second.Get("transmissionFactor").GetNumberAsDouble();
    if (!(factor >= 0.0 && factor <= 1.0))
      fail(fmt::format("material '{}' transmits {}; that must lie between 0 and 1", material.name, factor));
    if (factor == 0.0) return;
    if (extension->second.Has("transmissionTexture"))
      warn(fmt::format("the transmission texture of material '{}' is ignored: it transmits {} everywhere",
                       material.name, factor));
    if (material.alpha_mode == AlphaMode::kMask) {
      warn(fmt::format("material '{}' has holes and transmits; only the holes let light through", material.name));
      return;
    }
    if (material.alpha_mode == AlphaMode::kOpaque) {
      material.base_color.a = 1.0f;
      // The alpha of its picture does not count, and the picture may be shared with a material whose alpha does.
      material.base_color_texture = -1;
    }
    material.base_color.a *= static_cast<float>(1.0 - factor);
    material.alpha_mode = AlphaMode::kBlend;
  }

  /// The index of a texture among those that are read, or -1 where its picture is missing and only gives a colour.
  int add_texture(int index, const Material& material, bool alpha_counts) {
    const int image = find_element(source_.textures, index, "there is no texture", where_).source;
    const bool is_listed = image >= 0 && static_cast<std::size_t>(image) < source_.images.size();
    if (!is_listed || is_missing(source_.images[static_cast<std::size_t>(image)])) {
      const std::string problem = is_listed ? fmt::format("the image '{}' is missing or empty", name_image(image))
                                            : fmt::format("texture {} has no image that can be read", index);
      if (alpha_counts) fail(problem);
      warn(fmt::format("{}; material '{}' has its plain colour", problem, material.name));
      return -1;
    }
    if (const auto known = texture_of_image_.find(image); known != texture_of_image_.end()) return known->second;
    result_.textures.push_back(read_image(image));
    return texture_of_image_[image] = static_cast<int>(result_.textures.size()) - 1;
  }

  static bool is_missing(const tinygltf::Image& image) { return image.bufferView < 0 && image.image.empty(); }

  std::string name_image(int index) const {
    const std::string& uri = source_.images[static_cast<std::size_t>(index)].uri;
    return uri.empty() ? fmt::format("image {}", index) : uri;
  }

  Texture read_image(int index) const {
    const tinygltf::Image& image = source_.images[static_cast<std::size_t>(index)];
    const std::string name = image.name.empty() ? name_image(index) : image.name;
    return decode_texture(
        image.bufferView >= 0 ? read_buffer_view(source_, image.bufferView, "image", where_) : image.image, name,
        where_, result_.textures);
  }

  const tinygltf::Model& source_;
  const std::string& where_;
  GltfMaterials result_;
  std::map<int, int> texture_of_image_;
};

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

/// Builds a model from a parsed file, part by part.
class GltfImporter {
 public:
  GltfImporter(const tinygltf::Model& source, std::string where, const glm::dvec3& origin)
      : source_(source), where_(std::move(where)), origin_(origin) {}

  MeshFile import() {
    warn_of_extensions();
    if (!source_.scenes.empty()) result_.extras = read_scene_extras(default_scene(source_).extras, where_);
    GltfMaterials materials = read_gltf_materials(source_, where_);
    result_.materials = std::move(materials.materials);
    result_.textures = std::move(materials.textures);
    texcoords_ = std::move(materials.texcoords);
    std::ranges::for_each(materials.warnings, [&](const std::string& message) { warn(message); });
    nodes_ = place_nodes(source_, glm::translate(glm::dmat4(1.0), -origin_), where_);
    for (const PlacedNode& placed : nodes_) {
      const tinygltf::Node& node = find_element(source_.nodes, placed.node, "there is no node", where_);
      if (node.camera >= 0) add_camera(node, placed.world_from_node);
      if (!placed.is_visible) continue;
      if (node.mesh >= 0) add_mesh(node, placed);
      add_light(node, placed.world_from_node);
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
      if (!is_harmless_extension(extension)) warn(fmt::format("the extension {} is ignored", extension));
  }

  void add_mesh(const tinygltf::Node& node, const PlacedNode& placed) {
    for (Mesh& mesh : node.skin >= 0 ? pose_meshes(node, placed) : place_meshes(node, placed)) {
      if (!node.name.empty()) mesh.name = node.name;
      mesh.casts_shadow = read_extra_flag(node.extras, "casts_shadow");
      mesh.may_cull_front = read_extra_flag(node.extras, "may_cull_front");
      result_.meshes.push_back(std::move(mesh));
    }
  }

  /// The primitives of a node's mesh, the instances of each as one.
  std::vector<Mesh> place_meshes(const tinygltf::Node& node, const PlacedNode& placed) {
    std::vector<Mesh> meshes;
    const std::vector<glm::dmat4> places = place_instances(source_, placed, where_);
    for (const Mesh& local : local_meshes(node.mesh)) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        count_corners(local.indices.size());
        note_rounding(local, places[i]);
        Mesh mesh = transform_mesh(local, places[i]);
        if (i == 0)
          meshes.push_back(std::move(mesh));
        else
          meshes.back() = join_meshes(std::move(meshes.back()), mesh);
      }
    }
    return meshes;
  }

  /// The file's own positions are in single precision, however far from their node's origin they are.
  void note_rounding(const Mesh& local, const glm::dmat4& world_from_node) {
    double farthest = 0.0, scale = 0.0;
    for (const Vertex& vertex : local.vertices)
      for (int axis = 0; axis < 3; ++axis)
        farthest = std::max(farthest, std::abs(static_cast<double>(vertex.position_ws[axis])));
    for (int axis = 0; axis < 3; ++axis) scale = std::max(scale, glm::length(glm::dvec3(world_from_node[axis])));
    result_.rounding_m = std::max(result_.rounding_m, 0x1p-24 * farthest * scale);
  }

  /// The primitives of a node's mesh at rest: as the joints stand that the nodes describe.
  std::vector<Mesh> pose_meshes(const tinygltf::Node& node, const PlacedNode& placed) {
    const std::vector<glm::dmat4> joints = pose_joints(source_, node.skin, nodes_, where_);
    if (joints.empty()) {
      warn(fmt::format("a joint of skin {} is not in the scene; its meshes are drawn unposed", node.skin));
      return place_meshes(node, placed);
    }
    const tinygltf::Mesh& source = find_element(source_.meshes, node.mesh, "there is no mesh", where_);
    const std::string name = name_mesh(source, node.mesh);
    std::vector<Mesh> meshes;
    for (const tinygltf::Primitive& primitive : source.primitives) {
      if (!is_drawn(primitive, name)) continue;
      Mesh mesh = read_primitive(primitive, name);
      if (primitive.attributes.contains("JOINTS_0")) {
        mesh = pose_mesh(std::move(mesh), source_, primitive, joints, where_);
      } else {
        warn(fmt::format("a part of '{}' has a skin, but no joints; it is drawn unposed", name));
        mesh = transform_mesh(std::move(mesh), placed.world_from_node);
      }
      meshes.push_back(with_normals(std::move(mesh), primitive));
    }
    return meshes;
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
    const std::string name = name_mesh(source, index);
    std::vector<Mesh> meshes;
    for (const tinygltf::Primitive& primitive : source.primitives)
      if (is_drawn(primitive, name)) meshes.push_back(with_normals(read_primitive(primitive, name), primitive));
    return local_meshes_[index] = std::move(meshes);
  }

  static std::string name_mesh(const tinygltf::Mesh& mesh, int index) {
    return mesh.name.empty() ? fmt::format("mesh {}", index) : mesh.name;
  }

  static Mesh with_normals(Mesh mesh, const tinygltf::Primitive& primitive) {
    return primitive.attributes.contains("NORMAL") ? mesh : with_flat_normals(mesh);
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
    return mesh;
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
    const std::string name =
        source.name.empty() ? fmt::format("light {}", index) : fmt::format("light '{}'", source.name);
    const std::optional<LightKind> kind =
        make_gltf_light(source.type, world_from_node, source.spot.innerConeAngle, source.spot.outerConeAngle);
    if (!kind) {
      warn(fmt::format("{} lights are not modelled yet; they are left out", source.type));
      return;
    }
    const double cone_deg = 2.0 * glm::degrees(source.spot.outerConeAngle);
    if (std::holds_alternative<Spot>(*kind) && cone_deg > double{kWidestCone_deg})
      warn(fmt::format("{} has a cone of {:.4g} degrees; it is measured with {}", name, cone_deg, kWidestCone_deg));
    Light light;
    light.name = source.name;
    light.kind = *kind;
    if (source.intensity == 0.0) light.intensity = 0.0f;
    if (source.color.size() == 3)
      for (int i = 0; i < 3; ++i) light.color[i] = static_cast<float>(source.color[static_cast<std::size_t>(i)]);
    const toml::table extras = read_light_extras(source.extras);
    result_.aimed.push_back(!extras.empty());
    result_.lights.push_back(extras.empty() ? std::move(light) : with_gltf_extras(light, extras, where_, origin_));
  }

  const tinygltf::Model& source_;
  std::string where_;
  glm::dvec3 origin_;
  MeshFile result_;
  std::set<std::string> warned_;
  std::vector<PlacedNode> nodes_;
  std::map<int, std::vector<Mesh>> local_meshes_;
  std::vector<Texcoords> texcoords_;  ///< per material
  std::size_t corner_count_ = 0;
};

}  // namespace

std::vector<float> read_floats(const tinygltf::Model& model, int accessor, int components, const std::string& where) {
  const Values values = read_values(model, accessor, components, where);
  const double scale = 1.0 / values.type.largest;
  std::vector<float> floats;
  floats.reserve(values.all.size());
  for (const double value : values.all)
    floats.push_back(static_cast<float>(values.is_normalized ? std::max(value * scale, -1.0) : value));
  return floats;
}

std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor, const std::string& where) {
  const Values values = read_values(model, accessor, 1, where);
  if (!values.type.is_unsigned) {
    fail_input(fmt::format("accessor {} holds indices, but its component type {} is not an "
                           "unsigned integer",
                           accessor, values.type.code),
               where);
  }
  std::vector<std::uint32_t> indices;
  indices.reserve(values.all.size());
  for (const double value : values.all) indices.push_back(static_cast<std::uint32_t>(value));
  return indices;
}

std::vector<unsigned char> read_span(const tinygltf::Model& model, const tinygltf::BufferView& view,
                                     const std::string& owner, const std::string& where) {
  const ByteSpan span = checked_span(model, view, owner, where);
  return {span.data, span.data + span.size};
}

std::vector<unsigned char> read_buffer_view(const tinygltf::Model& model, int view, const std::string& owner,
                                            const std::string& where) {
  const ByteSpan span = checked_view(model, view, owner, where);
  return {span.data, span.data + span.size};
}

GltfMaterials read_gltf_materials(const tinygltf::Model& model, const std::string& where) {
  return MaterialReader(model, where).read();
}

MeshFile import_gltf(const std::filesystem::path& file, const glm::dvec3& origin) {
  const tinygltf::Model source = parse_gltf(file);
  return GltfImporter(source, file.string(), origin).import();
}

}  // namespace shadowbench::scene
