#pragma once

#include <glm/glm.hpp>
#include <string_view>

#include "harness/scene/scene.h"
#include "reference/truth/visibility.h"

namespace shadowbench::scene {

/// Chooses what the light's frustum encloses.
enum class FitMode {
  kSphere,  ///< a sphere around the scene: its size does not change when the light turns
  kTight,   ///< casters and receivers, as the light sees them
  kView,    ///< what the camera sees of the scene, with the casters between that and the light
};

/// The fit's name on the command line and in records.
std::string_view name_of(FitMode mode);
/// Throws kUsage for a name that is no fit, with those there are.
FitMode parse_fit_mode(std::string_view name);

/// What a light's frustum is fitted to, and how.
struct FitRequest {
  FitMode mode = FitMode::kTight;
  int map_size = 1024;      ///< texels along a side
  double pad_texels = 0.0;  ///< stay free on every side
  bool snap = false;        ///< keep the texel grid fixed in the world while the camera or the scene's extent moves
  const Camera* camera = nullptr;  ///< FitMode::kView only
  double aspect = 1.0;             ///< of its picture, width / height
  const Light* light = nullptr;    ///< in place of the scene's own
  glm::dvec2 shift_texels{0.0};    ///< moves the fitted map along its axes; at most half a texel, or padding is used up
};

/// The orthographic frustum of a directional light: a square map over casters and receivers.
struct LightFrustum {
  glm::dmat4 light_from_world{1.0};     ///< rigid; looks along -z
  glm::dmat4 clip_from_light{1.0};      ///< orthographic; depth in [0,1], 0 near
  glm::mat4 clip_from_world{1.0f};      ///< the product of both
  glm::mat4 uv_depth_from_world{1.0f};  ///< to (u, v, depth) in [0,1]; v = 0 is the map's first row, as in GL
  double width_ws = 0.0;                ///< side of the map, padding included
  double texel_size_ws = 0.0;
  double depth_range_ws = 0.0;  ///< from depth 0 to depth 1
  bool projective = false;      ///< uv_depth_from_world ends with a division by w, which is negative behind the light
  glm::vec3 direction_ws{0.0f, 0.0f, 1.0f};  ///< the way the light travels, unit length
};

/// Where a filter's kernel lies in the world.
truth::MapGrid make_map_grid(const LightFrustum& frustum);

/// Fits the frustum of a light's map to a validated scene.
///
/// `pad_texels` of the map stay free on every side, so that a kernel of that half-width around any point of the scene
/// stays inside the map. Texels are square. Depth runs from the vertex nearest to the light to the farthest one,
/// whether it casts or not, so that every receiver's depth lies inside (0,1), even in 16 bits; a scene without depth
/// gets a thousandth of the map's width. A light with a map window gets exactly that: no padding, and receivers may lie
/// outside and beyond the far plane.
///
/// FitMode::kView encloses every point that the camera sees, hidden ones too. Its depth runs from the nearest caster
/// over the map to the farthest point in view. A camera that sees nothing gets the tight fit.
///
/// With `snap`, the map's origin lies a whole number of texels from the world's origin, and a texel's size is rounded
/// up to a power of 2^(1/8), at most 9 % larger: while the camera moves by less than a texel the grid stays where it
/// is, and the edges of shadows do not crawl. That costs one texel of the map's side.
///
/// Requires a camera for FitMode::kView. Throws kUsage where the padding leaves no texel for the scene. Cost: one or
/// two passes over the vertices.
LightFrustum fit_light(const Scene& scene, const FitRequest& request);
LightFrustum fit_light(const Scene& scene, FitMode mode, int map_size, double pad_texels);

}  // namespace shadowbench::scene
