#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <string>

namespace shadowbench::scene {

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

}  // namespace shadowbench::scene
