#pragma once

#include <glm/glm.hpp>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Chooses what the light's frustum encloses.
enum class FitMode {
  kSphere,  ///< a sphere around the scene: its size does not change when the light turns
  kTight,   ///< casters and receivers, as the light sees them
};

/// The orthographic frustum of a directional light: a square map over casters and receivers.
struct LightFrustum {
  glm::dmat4 light_from_world{1.0};     ///< rigid; looks along -z
  glm::mat4 clip_from_world{1.0f};      ///< orthographic; depth in [0,1], 0 near
  glm::mat4 uv_depth_from_world{1.0f};  ///< to (u, v, depth) in [0,1]; v = 0 is the map's first row, as in GL
  double width_ws = 0.0;                ///< side of the map, padding included
  double texel_size_ws = 0.0;
  double depth_range_ws = 0.0;   ///< from depth 0 to depth 1
  glm::vec3 direction_ws{0.0f};  ///< the way the light travels, unit length
};

/// Fits a directional light's frustum to a validated scene.
///
/// `map_size` is the side of the map in texels; `pad_texels` of them stay free on every side, so that a kernel of that
/// half-width around any point of the scene stays inside the map. Texels are square.
/// Depth runs from the vertex nearest to the light to the farthest one, whether it casts or not, so that every
/// receiver's depth lies inside (0,1), in 16 bits too; a scene without depth gets a thousandth of the map's width.
/// Throws kUsage where the padding leaves no texel for the scene. Cost: one or two passes over the vertices, in double.
LightFrustum fit_light(const Scene& scene, FitMode mode, int map_size, double pad_texels);

}  // namespace shadowbench::scene
