#include <fmt/format.h>
#include <meshoptimizer.h>

#include <vector>

#include "base/error.h"
#include "harness/scene/files/gltf.h"

namespace shadowbench::scene {
namespace {

/// What a buffer view becomes: `count` elements of `stride` bytes.
struct Packing {
  std::size_t count;
  std::size_t stride;
  std::string mode;
  std::string filter;
};

/// Whether the extension's conditions hold; the library takes them for granted.
bool is_valid(const Packing& p) {
  if (p.mode == "TRIANGLES" || p.mode == "INDICES") {
    const bool whole = p.mode == "INDICES" || p.count % 3 == 0;
    return whole && (p.stride == 2 || p.stride == 4) && p.filter == "NONE";
  }
  if (p.mode != "ATTRIBUTES" || p.stride == 0 || p.stride % 4 != 0 || p.stride > 256) return false;
  if (p.filter == "OCTAHEDRAL") return p.stride == 4 || p.stride == 8;
  if (p.filter == "QUATERNION") return p.stride == 8;
  return p.filter == "NONE" || p.filter == "EXPONENTIAL";
}

Packing read_packing(const tinygltf::Value& extension, const std::string& owner, const std::string& where) {
  const auto text = [&](const char* key, const char* otherwise) {
    const bool is_text = extension.Has(key) && extension.Get(key).IsString();
    return is_text ? extension.Get(key).Get<std::string>() : std::string(otherwise);
  };
  Packing packing{read_whole_number(extension, "count", owner, where),
                  read_whole_number(extension, "byteStride", owner, where), text("mode", ""), text("filter", "NONE")};
  if (is_valid(packing)) return packing;
  fail_input(fmt::format("{} is compressed with mode '{}' and filter '{}', of which there are no {} elements of {} "
                         "bytes",
                         owner, packing.mode, packing.filter, packing.count, packing.stride),
             where);
}

/// Where the compressed bytes lie.
tinygltf::BufferView packed_view(const tinygltf::Value& extension, const std::string& owner, const std::string& where) {
  tinygltf::BufferView view;
  view.buffer = static_cast<int>(read_whole_number(extension, "buffer", owner, where));
  view.byteOffset = extension.Has("byteOffset") ? read_whole_number(extension, "byteOffset", owner, where) : 0;
  view.byteLength = read_whole_number(extension, "byteLength", owner, where);
  return view;
}

int decode(std::vector<unsigned char>& bytes, const Packing& p, const std::vector<unsigned char>& packed) {
  if (p.mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(bytes.data(), p.count, p.stride, packed.data(), packed.size());
  if (p.mode == "INDICES")
    return meshopt_decodeIndexSequence(bytes.data(), p.count, p.stride, packed.data(), packed.size());
  return meshopt_decodeVertexBuffer(bytes.data(), p.count, p.stride, packed.data(), packed.size());
}

std::vector<unsigned char> unpack(const Packing& p, const std::vector<unsigned char>& packed, const std::string& owner,
                                  const std::string& where) {
  constexpr std::size_t kMostExpansion = 64;  // an attribute's 16 equal bytes take two bits
  if (p.count * p.stride > kMostExpansion * packed.size()) {
    fail_input(fmt::format("{} claims {} elements of {} bytes, which {} compressed bytes cannot hold", owner, p.count,
                           p.stride, packed.size()),
               where);
  }
  std::vector<unsigned char> bytes(p.count * p.stride);
  if (const int failure = decode(bytes, p, packed); failure != 0)
    fail_input(fmt::format("the meshopt data of {} are damaged (code {}); export the model again", owner, failure),
               where);
  if (p.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), p.count, p.stride);
  if (p.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), p.count, p.stride);
  if (p.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), p.count, p.stride);
  return bytes;
}

/// A buffer view that is compressed.
struct PackedView {
  std::size_t index;
  Packing packing;
  tinygltf::BufferView bytes;
};

/// All of a file's compressed buffer views, which together claim no more than is allowed.
std::vector<PackedView> list_packed_views(const tinygltf::Model& model, const std::string& where) {
  constexpr std::size_t kMostUnpackedBytes = std::size_t{1} << 31;
  std::vector<PackedView> views;
  std::size_t claimed = 0;
  for (std::size_t i = 0; i < model.bufferViews.size(); ++i) {
    const tinygltf::BufferView& view = model.bufferViews[i];
    const auto extension = view.extensions.find("EXT_meshopt_compression");
    if (extension == view.extensions.end()) continue;
    const std::string owner = fmt::format("buffer view {}", i);
    const Packing packing = read_packing(extension->second, owner, where);
    if (view.byteStride != 0 && view.byteStride != packing.stride) {
      fail_input(
          fmt::format("{} has a stride of {} bytes, but is compressed with {}", owner, view.byteStride, packing.stride),
          where);
    }
    claimed += packing.count * packing.stride;
    if (claimed > kMostUnpackedBytes)
      fail_input(fmt::format("its meshopt data claim more than {} bytes in all", kMostUnpackedBytes), where);
    views.push_back({i, packing, packed_view(extension->second, owner, where)});
  }
  return views;
}

}  // namespace

tinygltf::Model unpack_meshopt(tinygltf::Model model, const std::string& where) {
  for (const PackedView& packed : list_packed_views(model, where)) {
    const std::string owner = fmt::format("buffer view {}", packed.index);
    tinygltf::BufferView& view = model.bufferViews[packed.index];
    view.buffer = static_cast<int>(model.buffers.size());
    view.byteOffset = 0;
    view.byteLength = packed.packing.count * packed.packing.stride;
    tinygltf::Buffer buffer;
    buffer.data =
        unpack(packed.packing, read_span(model, packed.bytes, "the meshopt data of " + owner, where), owner, where);
    model.buffers.push_back(std::move(buffer));
  }
  return model;
}

}  // namespace shadowbench::scene
