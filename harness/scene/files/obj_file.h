#pragma once

#include <filesystem>

#include "harness/scene/files/mesh_file.h"

namespace shadowbench::scene {

/// Reads a Wavefront .obj file and the diffuse colours and textures of its material library.
///
/// Polygons become triangles. Corners without a normal get the mean of the faces around them that turn by less than
/// 45 degrees. A missing material library is a warning; a reference outside the file's folder an error.
/// Throws kInput, with the line, for a coordinate that is not a finite number or an index out of range.
MeshFile import_obj(const std::filesystem::path& file);

}  // namespace shadowbench::scene
