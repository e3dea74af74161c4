#pragma once

#include <tiny_gltf.h>

#include <string>

#include "base/toml.h"
#include "harness/scene/files/mesh_file.h"

namespace shadowbench::scene {

// What write_glb() puts beside what glTF has words for: the object `shadowbench` among the extras, which other programs
// use too. Where it is missing everything is as usual.

/// Of a mesh's node; true unless it is said to be false.
bool read_extra_flag(const tinygltf::Value& extras, const std::string& key);

/// Of a light, as the table of a scene file; what is no number becomes NaN, which a scene file refuses.
toml::table read_light_extras(const tinygltf::Value& extras);

/// Of a scene. Throws kInput, at `where`, for a background that is no colour.
SceneExtras read_scene_extras(const tinygltf::Value& extras, const std::string& where);

}  // namespace shadowbench::scene
