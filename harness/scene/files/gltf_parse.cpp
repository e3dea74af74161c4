#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "harness/scene/files/gltf.h"
#include "harness/scene/files/mesh_file.h"
#include "harness/scene/mesh_tools.h"

namespace shadowbench::scene {
namespace {

namespace fs = std::filesystem;

/// Lets the parser see one folder and remembers what it was refused.
struct FolderGuard {
  std::string folder;
  std::vector<std::string> refused;
};

bool exists_inside(const std::string& path, void* user_data) {
  auto& guard = *static_cast<FolderGuard*>(user_data);
  const std::string prefix = guard.folder + "/";
  // The parser also looks in the working directory, where nothing of the model belongs.
  if (!path.starts_with(prefix)) return false;
  const std::string reference = path.substr(prefix.size());
  if (reference.empty()) return false;
  const std::optional<fs::path> inside = resolve_inside(guard.folder, reference);
  if (!inside) {
    guard.refused.push_back(reference);
    return false;
  }
  std::error_code ignored;
  return fs::is_regular_file(*inside, ignored);
}

std::string keep_path(const std::string& path, void*) { return path; }

bool read_inside(std::vector<unsigned char>* bytes, std::string* failure, const std::string& path, void* user_data) {
  if (!exists_inside(path, user_data)) return false;
  try {
    *bytes = read_file_bytes(path);
    return true;
  } catch (const Error& e) {
    *failure += e.what();
    return false;
  }
}

bool measure_inside(std::size_t* bytes, std::string* failure, const std::string& path, void* user_data) {
  std::vector<unsigned char> read;
  if (!read_inside(&read, failure, path, user_data)) return false;
  *bytes = read.size();
  return true;
}

bool write_nothing(std::string* failure, const std::string&, const std::vector<unsigned char>&, void*) {
  *failure += "nothing is written";
  return false;
}

/// tinygltf 2.9 has one callback more than 2.5, and goes on with its own, which see every folder, where one is missing:
/// it is asked whether it took ours.
template <class Parser, class Callbacks>
void set_callbacks(Parser& parser, Callbacks callbacks, FolderGuard& guard) {
  callbacks.FileExists = &exists_inside;
  callbacks.ExpandFilePath = &keep_path;
  callbacks.ReadWholeFile = &read_inside;
  callbacks.WriteWholeFile = &write_nothing;
  callbacks.user_data = &guard;
  if constexpr (requires { callbacks.GetFileSizeInBytes; }) callbacks.GetFileSizeInBytes = &measure_inside;
  if constexpr (std::is_void_v<decltype(parser.SetFsCallbacks(callbacks))>)
    parser.SetFsCallbacks(callbacks);
  else if (!parser.SetFsCallbacks(callbacks))
    throw std::logic_error("tinygltf does not take the callbacks that keep it in the model's folder");
}

/// Keeps an image encoded. Bytes from a buffer view are not touched: the parser has not checked their range.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  image->as_is = true;
  return true;
}

bool is_glb(const std::vector<unsigned char>& bytes) {
  return bytes.size() >= 20 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

std::string_view json_of(const std::vector<unsigned char>& bytes) {
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!is_glb(bytes)) return all;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  return all.substr(20, length);
}

/// EXT_meshopt_compression leaves buffers without bytes, for readers that do not know it, and the parser refuses those:
/// each gets one byte. The first buffer of a .glb has its bytes in the file.
void fill_fallbacks(nlohmann::json& buffers, bool glb) {
  const nlohmann::json::json_pointer fallback("/extensions/EXT_meshopt_compression/fallback");
  bool is_first = true;
  for (nlohmann::json& buffer : buffers) {
    const bool has_bytes = buffer.contains("uri") || (glb && is_first);
    const bool is_fallback = buffer.contains(fallback) && buffer[fallback] == true;
    is_first = false;
    if (!buffer.is_object() || (has_bytes && !is_fallback)) continue;
    buffer["uri"] = "data:application/octet-stream;base64,AA==";
    buffer["byteLength"] = 1;
  }
}

/// The parser asks for matrices that glTF lets a skin leave out.
void fill_inverse_binds(nlohmann::json& skin) {
  if (skin.is_object() && !skin.contains("inverseBindMatrices")) skin["inverseBindMatrices"] = -1;
}

/// Whether the parser would refuse something that is valid, or is never used.
bool needs_mending(std::string_view json) {
  constexpr std::array kWords{"EXT_meshopt_compression", "\"animations\"", "\"skins\""};
  return std::ranges::any_of(kWords, [&](const char* word) { return json.find(word) != json.npos; });
}

/// The JSON without animations, which nothing uses, and with what the parser misses; as it is where it is none.
std::string mend_json(std::string_view json, bool glb) {
  nlohmann::json document = nlohmann::json::parse(json, nullptr, false);
  if (!document.is_object()) return std::string(json);
  document.erase("animations");
  if (document.contains("buffers")) fill_fallbacks(document["buffers"], glb);
  if (document.contains("skins")) std::ranges::for_each(document["skins"], fill_inverse_binds);
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// A file's bytes with the JSON replaced.
std::vector<unsigned char> with_json(const std::vector<unsigned char>& bytes, std::string json) {
  if (!is_glb(bytes)) return {json.begin(), json.end()};
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t json_end = 20 + json_of(bytes).size();
  std::vector<unsigned char> file(bytes.begin(), bytes.begin() + 20);
  file.insert(file.end(), json.begin(), json.end());
  file.insert(file.end(), bytes.begin() + static_cast<std::ptrdiff_t>(json_end), bytes.end());
  const std::array lengths{std::pair(8, file.size()), std::pair(12, json.size())};
  for (const auto& [at, length] : lengths) {
    const auto length_32 = static_cast<std::uint32_t>(length);
    std::memcpy(file.data() + at, &length_32, sizeof length_32);
  }
  return file;
}

/// The parser recurses; JSON nested without limit would end the program.
int nesting_depth(std::string_view json) {
  int depth = 0;
  int deepest = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted && c == '\\') ++i;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '{' || c == '[') deepest = std::max(deepest, ++depth);
    if (c == '}' || c == ']') --depth;
  }
  return deepest;
}

std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  std::ranges::replace(text, '\n', ';');
  return text.empty() ? "the parser gives no reason" : text;
}

/// Surfaces that let light through in ways that are not read: the rest of the file is as it should be.
bool is_partly_known(std::string_view extension) {
  return extension == "KHR_materials_volume" || extension == "KHR_materials_diffuse_transmission";
}

void require_readable_extensions(const tinygltf::Model& model, const std::string& where) {
  for (const std::string& extension : model.extensionsRequired) {
    if (is_harmless_extension(extension) || is_partly_known(extension)) continue;
    fail_input(fmt::format("the file requires the extension {}, which {}; save it without", extension,
                           extension == "EXT_meshopt_compression" ? "this build leaves out" : "is not supported"),
               where);
  }
}

void require_version_2(const tinygltf::Model& model, const std::string& where) {
  const std::string& version = model.asset.version;
  if (version.starts_with("2.") || version == "2") return;
  fail_input(fmt::format("this is glTF version '{}'; only 2.0 is read", version), where);
}

/// tinygltf 2.9 cuts a name at a zero character, where 2.5 does not find the file.
void require_whole_names(const tinygltf::Model& model, const std::string& where) {
  const auto require = [&](const std::string& uri) {
    if (uri.find('\0') != std::string::npos)
      fail_input(fmt::format("it refers to '{}...', a name with a zero character; rename the file", uri.c_str()),
                 where);
  };
  for (const tinygltf::Buffer& buffer : model.buffers) require(buffer.uri);
  for (const tinygltf::Image& image : model.images) require(image.uri);
}

/// Parses from memory, so that every byte comes through the guard.
bool parse_bytes(tinygltf::TinyGLTF& parser, tinygltf::Model* model, std::string* failure,
                 const std::vector<unsigned char>& bytes, const std::string& folder) {
  const auto size = static_cast<unsigned int>(bytes.size());
  std::string warning;
  try {
    if (is_glb(bytes)) return parser.LoadBinaryFromMemory(model, failure, &warning, bytes.data(), size, folder);
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    return parser.LoadASCIIFromString(model, failure, &warning, text, size, folder);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    *failure += e.what();
    return false;
  }
}

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

bool is_harmless_extension(std::string_view extension) {
  static const std::set<std::string_view> harmless = {
#ifdef SHADOWBENCH_HAS_MESHOPT
      "EXT_meshopt_compression",
#endif
      // Read.
      "EXT_mesh_gpu_instancing", "KHR_lights_punctual", "KHR_materials_pbrSpecularGlossiness",
      "KHR_materials_transmission", "KHR_mesh_quantization", "KHR_node_visibility", "KHR_texture_transform",
      // How an opaque surface looks beside its colour, what moves, and what describes the file.
      "KHR_animation_pointer", "KHR_materials_anisotropy", "KHR_materials_clearcoat", "KHR_materials_dispersion",
      "KHR_materials_emissive_strength", "KHR_materials_ior", "KHR_materials_iridescence", "KHR_materials_sheen",
      "KHR_materials_specular", "KHR_materials_unlit", "KHR_materials_variants", "KHR_xmp_json_ld"};
  return harmless.contains(extension);
}

std::size_t read_whole_number(const tinygltf::Value& object, const std::string& key, const std::string& owner,
                              const std::string& where) {
  if (object.Has(key) && object.Get(key).IsInt() && object.Get(key).GetNumberAsInt() >= 0)
    return static_cast<std::size_t>(object.Get(key).GetNumberAsInt());
  fail_input(fmt::format("{} is compressed, but its extension has no whole number '{}' of 0 or more", owner, key),
             where);
}

tinygltf::Model parse_gltf(const fs::path& file) {
  constexpr int kDeepestJson = 200;
  const std::string where = file.string();
  std::vector<unsigned char> bytes = read_file_bytes(file);
  if (bytes.size() > std::numeric_limits<std::uint32_t>::max()) fail_input("the file is larger than 4 GiB", where);
  if (nesting_depth(json_of(bytes)) > kDeepestJson)
    fail_input(fmt::format("its JSON is nested more than {} deep", kDeepestJson), where);
  if (needs_mending(json_of(bytes))) bytes = with_json(bytes, mend_json(json_of(bytes), is_glb(bytes)));
  FolderGuard guard{fs::absolute(file).lexically_normal().parent_path().string(), {}};
  tinygltf::TinyGLTF parser;
  parser.SetImageLoader(&keep_encoded, nullptr);
  set_callbacks(parser, tinygltf::FsCallbacks{}, guard);
  tinygltf::Model model;
  std::string failure;
  const bool parsed = parse_bytes(parser, &model, &failure, bytes, guard.folder);
  if (!guard.refused.empty()) {
    fail_input(fmt::format("it refers to '{}', outside its folder; such files are not read", guard.refused.front()),
               where);
  }
  require_readable_extensions(model, where);
  if (!parsed || !failure.empty()) fail_input("not valid glTF: " + one_line(failure), where);
  require_version_2(model, where);
  require_whole_names(model, where);
#ifdef SHADOWBENCH_HAS_MESHOPT
  model = unpack_meshopt(std::move(model), where);
#endif
  return model;
}

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
