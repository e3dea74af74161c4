#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <string>
#include <vector>

namespace shadowbench::scene {

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
