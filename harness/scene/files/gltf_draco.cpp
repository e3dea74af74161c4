#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include "base/error.h"
#include "harness/scene/files/gltf.h"

namespace shadowbench::scene {
namespace {

/// The bytes of the tables that a mesh is decoded with, from the largest of its counts of faces, vertices and the like.
std::uint64_t table_bytes(std::uint32_t largest_count, std::uint64_t tables) {
  return 12 * std::uint64_t{largest_count} * tables;
}

/// A decoder of the library's that refuses claims it would allocate memory for.
template <class Base>
class BoundedDecoder final : public Base {
 public:
  explicit BoundedDecoder(std::uint64_t most_bytes) : most_bytes_(most_bytes) {}

  /// The claim that was refused, in bytes; 0: none was.
  std::uint64_t refused_bytes() const { return refused_bytes_; }

 private:
  bool DecodeConnectivity() override { return fits(claimed_by_faces(*this->buffer())) && Base::DecodeConnectivity(); }

  bool DecodeAllAttributes() override {
    std::uint64_t bytes_per_point = 0;
    for (int i = 0; i < this->point_cloud()->num_attributes(); ++i) {
      const draco::PointAttribute& attribute = *this->point_cloud()->attribute(i);
      const int component_bytes = std::max(4, draco::DataTypeLength(attribute.data_type()));
      bytes_per_point += static_cast<std::uint64_t>(attribute.num_components() * component_bytes);
    }
    return fits(bytes_per_point * this->point_cloud()->num_points()) && Base::DecodeAllAttributes();
  }

  /// Reads the counts at the head of the connectivity; nothing is claimed where they are cut off, which the library
  /// notices as well.
  static std::uint64_t claimed_by_faces(draco::DecoderBuffer ahead) {
    std::uint32_t vertices = 0;
    std::uint32_t faces = 0;
    std::uint32_t symbols = 0;
    std::uint32_t splits = 0;
    std::uint8_t seams = 0;
    if (!draco::DecodeVarint(&vertices, &ahead) || !draco::DecodeVarint(&faces, &ahead)) return 0;
    if constexpr (std::is_same_v<Base, draco::MeshEdgebreakerDecoder>) {
      if (!ahead.Decode(&seams) || !draco::DecodeVarint(&symbols, &ahead) || !draco::DecodeVarint(&splits, &ahead))
        return 0;
    }
    // Not handed on as a list: built by GCC 14, table_bytes() was seen to read other values than these from one.
    return table_bytes(std::max({vertices, faces, symbols, splits}), std::uint64_t{seams} + 1);
  }

  bool fits(std::uint64_t bytes) {
    if (bytes > most_bytes_) refused_bytes_ = bytes;
    return bytes <= most_bytes_;
  }

  std::uint64_t most_bytes_;
  std::uint64_t refused_bytes_ = 0;
};

/// Returns why a mesh could not be decoded; empty: it is.
template <class Base>
std::string decode_with(draco::DecoderBuffer buffer, std::uint64_t most_bytes, draco::Mesh* mesh) {
  BoundedDecoder<Base> decoder(most_bytes);
  try {
    const draco::Status status = decoder.Decode({}, &buffer, mesh);
    if (decoder.refused_bytes() > 0)
      return fmt::format("they claim {} bytes of memory; {} are allowed", decoder.refused_bytes(), most_bytes);
    if (status.ok()) return {};
    return status.error_msg_string().empty() ? "they are damaged" : status.error_msg_string();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return e.what();
  }
}

std::unique_ptr<draco::Mesh> decode_mesh(const std::vector<unsigned char>& bytes, const std::string& owner,
                                         const std::string& where) {
  constexpr std::uint64_t kAlwaysAllowed = std::uint64_t{1} << 28;
  constexpr std::uint64_t kMostExpansion = 1024;
  const std::uint64_t most_bytes =
      std::clamp<std::uint64_t>(kMostExpansion * bytes.size(), kAlwaysAllowed, kMostUnpackedBytes);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DecoderBuffer ahead = buffer;
  draco::DracoHeader header{};
  const bool has_header = draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok();
  auto mesh = std::make_unique<draco::Mesh>();
  std::string failure = "they are none of Draco's";
  if (has_header && (header.version_major != 2 || header.version_minor != 2))
    failure = fmt::format("they are of version {}.{}; 2.2 is read", header.version_major, header.version_minor);
  else if (has_header && header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
    failure = decode_with<draco::MeshEdgebreakerDecoder>(buffer, most_bytes, mesh.get());
  else if (has_header && header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING)
    failure = decode_with<draco::MeshSequentialDecoder>(buffer, most_bytes, mesh.get());
  if (!failure.empty())
    fail_input(fmt::format("the Draco data of {} cannot be decoded ({}); export the model again", owner, failure),
               where);
  return mesh;
}

/// Adds the accessor and what it reads; returns its index.
int add_accessor(tinygltf::Model& model, tinygltf::Accessor accessor, std::vector<unsigned char> bytes) {
  tinygltf::BufferView view;
  view.buffer = static_cast<int>(model.buffers.size());
  view.byteLength = bytes.size();
  accessor.bufferView = static_cast<int>(model.bufferViews.size());
  model.buffers.emplace_back().data = std::move(bytes);
  model.bufferViews.push_back(std::move(view));
  model.accessors.push_back(std::move(accessor));
  return static_cast<int>(model.accessors.size()) - 1;
}

int add_indices(tinygltf::Model& model, const draco::Mesh& mesh) {
  tinygltf::Accessor accessor;
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  accessor.type = TINYGLTF_TYPE_SCALAR;
  accessor.count = std::size_t{3} * mesh.num_faces();
  std::vector<unsigned char> bytes(accessor.count * sizeof(std::uint32_t));
  for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face)
    std::memcpy(bytes.data() + std::size_t{face.value()} * sizeof(draco::Mesh::Face), mesh.face(face).data(),
                sizeof(draco::Mesh::Face));
  return add_accessor(model, std::move(accessor), std::move(bytes));
}

int component_type_of(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8: return TINYGLTF_COMPONENT_TYPE_BYTE;
    case draco::DT_UINT8: return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    case draco::DT_INT16: return TINYGLTF_COMPONENT_TYPE_SHORT;
    case draco::DT_UINT16: return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    case draco::DT_UINT32: return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    case draco::DT_FLOAT32: return TINYGLTF_COMPONENT_TYPE_FLOAT;
    default: return -1;
  }
}

/// Adds an accessor of an attribute's values, point by point; `source` says whether they are normalized.
int add_attribute(tinygltf::Model& model, const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                  const tinygltf::Accessor& source, const std::string& owner, const std::string& where) {
  const int components = attribute.num_components();
  tinygltf::Accessor accessor;
  accessor.normalized = source.normalized;
  accessor.componentType = component_type_of(attribute.data_type());
  accessor.type = components == 1 ? TINYGLTF_TYPE_SCALAR : components;
  accessor.count = mesh.num_points();
  if (accessor.componentType < 0 || components < 1 || components > 4) {
    fail_input(fmt::format("the Draco data of {} hold {} numbers of type {} each, which glTF does not know", owner,
                           components, static_cast<int>(attribute.data_type())),
               where);
  }
  const auto size = static_cast<std::size_t>(components * draco::DataTypeLength(attribute.data_type()));
  std::vector<unsigned char> bytes(accessor.count * size);
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
    const draco::AttributeValueIndex value = attribute.mapped_index(point);
    if (value.value() >= attribute.size())
      fail_input(fmt::format("the Draco data of {} are damaged: there is no value {}", owner, value.value()), where);
    std::memcpy(bytes.data() + point.value() * size, attribute.GetAddress(value), size);
  }
  return add_accessor(model, std::move(accessor), std::move(bytes));
}

bool is_read(const std::string& attribute) {
  return attribute == "POSITION" || attribute == "NORMAL" || attribute.starts_with("TEXCOORD_");
}

/// The primitive with accessors of its own.
tinygltf::Primitive unpack_primitive(tinygltf::Model& model, tinygltf::Primitive primitive,
                                     const tinygltf::Value& extension, const std::string& owner,
                                     const std::string& where) {
  const auto view = static_cast<int>(read_whole_number(extension, "bufferView", owner, where));
  const auto mesh = decode_mesh(read_buffer_view(model, view, owner, where), owner, where);
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.indices = add_indices(model, *mesh);
  const tinygltf::Value& ids = extension.Get("attributes");
  for (auto& [name, index] : primitive.attributes) {
    if (!is_read(name) || !ids.Has(name)) continue;
    const std::string part = fmt::format("{} of {}", name, owner);
    const auto id = static_cast<std::uint32_t>(read_whole_number(ids, name, owner, where));
    const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(id);
    if (!attribute)
      fail_input(fmt::format("the Draco data of {} have no attribute {}, its {}", owner, id, name), where);
    const tinygltf::Accessor source = find_element(model.accessors, index, "there is no accessor", where);
    index = add_attribute(model, *mesh, *attribute, source, part, where);
  }
  return primitive;
}

}  // namespace

tinygltf::Model unpack_draco(tinygltf::Model model, const std::string& where) {
  std::size_t unpacked = 0;
  for (std::size_t i = 0; i < model.meshes.size(); ++i) {
    for (tinygltf::Primitive& primitive : model.meshes[i].primitives) {
      const auto extension = primitive.extensions.find("KHR_draco_mesh_compression");
      if (extension == primitive.extensions.end()) continue;
      const std::string& name = model.meshes[i].name;
      const std::string owner = name.empty() ? fmt::format("mesh {}", i) : fmt::format("'{}'", name);
      const tinygltf::Value packed = extension->second;
      std::size_t buffer = model.buffers.size();
      primitive = unpack_primitive(model, primitive, packed, owner, where);
      for (; buffer < model.buffers.size(); ++buffer) unpacked += model.buffers[buffer].data.size();
      if (unpacked > kMostUnpackedBytes)
        fail_input(fmt::format("its Draco data become more than {} bytes in all", kMostUnpackedBytes), where);
    }
  }
  return model;
}

}  // namespace shadowbench::scene
