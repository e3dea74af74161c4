#pragma once

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace shadowbench::scene {

/// Whether an extension is read, or changes nothing of what casts shadows; a file may require it, and no more need be
/// said. Of any other the user is warned.
bool is_harmless_extension(std::string_view extension);

/// Parses a .gltf or .glb file and its buffers, and unpacks those that are compressed; images stay encoded, in
/// `image`, or in their buffer view.
/// Reads nothing outside the file's folder. Throws kInput where the file is malformed, refers outside its folder or
/// requires an extension that is not read.
tinygltf::Model parse_gltf(const std::filesystem::path& file);

/// The element of one of a file's lists that an index names. Throws kInput, at `where`, if there is none; the message
/// is `complaint`, such as "there is no mesh", and the index.
template <class T>
const T& find_element(const std::vector<T>& list, int index, const std::string& complaint, const std::string& where) {
  if (index >= 0 && static_cast<std::size_t>(index) < list.size()) return list[static_cast<std::size_t>(index)];
  fail_input(fmt::format("{} {} (of {})", complaint, index, list.size()), where);
}

/// A whole number, 0 or more, that an extension's object must have.
/// Throws kInput, about `owner`, at `where`, where it has none.
std::size_t read_whole_number(const tinygltf::Value& object, const std::string& key, const std::string& owner,
                              const std::string& where);

/// The most that a file's compressed data may become, by either extension; 2 GiB.
constexpr std::size_t kMostUnpackedBytes = std::size_t{1} << 31;

/// Replaces every buffer view that EXT_meshopt_compression compresses by one of the bytes that it stands for.
/// No buffer view may claim more than 64 times its compressed size, the most that the format can hold.
/// Throws kInput, at `where`, for data that are damaged or claim too much, before anything is allocated for the claim.
tinygltf::Model unpack_meshopt(tinygltf::Model model, const std::string& where);

/// Gives every primitive that KHR_draco_mesh_compression compresses accessors of its own, with the indices, positions,
/// normals and texture coordinates that the compressed data hold; it then is a list of triangles.
/// Data may claim 256 MiB, or 1024 times their compressed size where that is more.
/// Throws kInput, at `where`, for data that are damaged or claim too much, before anything is allocated for the claim.
tinygltf::Model unpack_draco(tinygltf::Model model, const std::string& where);

/// Reads an accessor's elements as floats, `components` per element; normalized integers become [-1,1] or [0,1].
/// Checks the accessor, its buffer view and buffer before it reads a byte, sparse ones included.
/// Throws kInput, at `where`, naming the accessor and what is out of range.
std::vector<float> read_floats(const tinygltf::Model& model, int accessor, int components, const std::string& where);

/// Reads an accessor's elements as indices; same checks.
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor, const std::string& where);

/// Copies a span's bytes after checking that they lie in its buffer. Throws kInput, about `owner`, at `where`.
std::vector<unsigned char> read_span(const tinygltf::Model& model, const tinygltf::BufferView& span,
                                     const std::string& owner, const std::string& where);

/// The same of one of the file's buffer views.
std::vector<unsigned char> read_buffer_view(const tinygltf::Model& model, int view, const std::string& owner,
                                            const std::string& where);

}  // namespace shadowbench::scene
