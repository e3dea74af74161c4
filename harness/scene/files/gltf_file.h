#pragma once

#include <filesystem>

#include "harness/scene/files/mesh_file.h"

namespace shadowbench::scene {

/// Reads a glTF 2.0 file (.gltf or .glb): its default scene, node transforms applied.
///
/// Reads triangles, strips and fans with indices of any type, quantised and compressed ones (EXT_meshopt_compression,
/// KHR_draco_mesh_compression) too, base colour factor and texture, transformed by KHR_texture_transform, alpha masks,
/// perspective and orthographic cameras, and the lights of KHR_lights_punctual (their colour; all have intensity 1,
/// because every picture has the same exposure). Missing normals become flat ones.
/// Warns about what it leaves out: blending, other lights, skins, morph targets, lines and points.
/// Throws kInput for a file that is malformed, refers outside its folder, or requires an extension that is not read.
MeshFile import_gltf(const std::filesystem::path& file);

}  // namespace shadowbench::scene
