#include "harness/scene/files/gltf_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "base/error.h"
#include "harness/scene/files/gltf_parse.h"
#include "harness/scene/files/mesh_file.h"

namespace shadowbench::scene {
namespace {

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

}  // namespace

GltfMaterials read_gltf_materials(const tinygltf::Model& model, const std::string& where) {
  return MaterialReader(model, where).read();
}

}  // namespace shadowbench::scene
