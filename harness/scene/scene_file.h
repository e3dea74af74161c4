#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "filters/base/toml.h"
#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Reads and validates a scene file.
///
/// Lengths are metres, colours linear, angles degrees, +y is up. An azimuth of 0 is +z, of 90 is +x. Keys:
/// - `title` (required), `background` = [r, g, b], `model` = "file.gltf": a model as it is
/// - `[light]` (required): `type` = "directional", `direction` = [x, y, z] (the way the light travels), or
///   `azimuth_deg` and `elevation_deg` (where it stands); `color`, `intensity`, `angular_diameter_deg`
///   - `map_width` and `map_center` = [x, y, z]: the square that the light's map shows, instead of the whole scene;
///     `map_near` and `map_far`: where depth is 0 and 1, metres from that centre along the light (negative: before it).
///     For scenes that show what happens outside a map
/// - `[camera]`, or several `[[camera]]`: `name`, `position`, `target`, `up`, `vertical_fov_deg`, or
///   `orthographic_height` for a view without perspective; without one, a camera is chosen: see complete()
/// - `[[material]]`: `name`, `color`
/// - `[[object]]`: `shape`, `name`, `material`, `casts_shadow`, `center`, `rotation_deg` (about x, then y, then z),
///   `scale` (a number or three), and by shape
///   - `plane` (faces +y): `size` = [x, z], `cells`
///   - `box`: `size` = [x, y, z], `cells` along the longest edge
///   - `sphere`: `radius`, `segments`
///   - `cylinder` (along y): `radius`, `height`, `segments`, `cells`
///   - `bars` (in the plane z = 0): `count`, `bar_width`, `spacing`, `length`, `direction` = "vertical", "horizontal"
///     or "both", `cells`
///   - `model`: `file`, relative to the scene file; keeps its own materials unless `material` is given
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
