#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/toml.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Reads and validates a scene file; README.md lists its tables and keys.
///
/// A model may be anywhere ("../models/tree.gltf"), but all that it refers to must lie in its own folder. Throws kInput
/// with "file:line" for anything missing, unknown, out of range or malformed. `aspect` is the width / height of the
/// picture that a chosen camera fills; `light` is where every light is put, if it is given.
Scene load_scene(const std::filesystem::path& file, double aspect = 16.0 / 9.0,
                 const std::optional<SkyAngles>& light = std::nullopt);

/// Reads the [camera] of a scene file; its directions are not yet checked. Throws kInput.
Camera read_camera(const TomlTable& table);

/// Reads a scene file's title alone. Throws as load_scene does.
std::string read_scene_title(const std::filesystem::path& file);

}  // namespace shadowbench::scene
