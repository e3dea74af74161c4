#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "harness/scene/lights/beam.h"
#include "reference/truth/area_light.h"

namespace shadowbench::scene {

class TomlTable;
struct FitRequest;
struct LightFrustum;
struct Scene;
struct Texture;

/// A lamp that stands in the scene: a disk or a rectangle that faces its target, whose light fills a cone with a soft
/// edge.
struct Spot {
  glm::vec3 position_ws{0.0f, 1.0f, 0.0f};
  glm::vec3 target_ws{0.0f};     ///< the cone's axis leads there, and its light is as strong there as a sun's
  float cone_deg = 60.0f;        ///< from edge to edge; no light beyond
  float inner_cone_deg = 45.0f;  ///< the same, full strength within
  float radius_m = 0.05f;        ///< of the disk; 0: a point
  glm::vec2 size_m{0.0f};        ///< sides of a rectangle in place of the disk, along the map's u and v; 0: the disk
  /// Colours the light, but no shadow: over the square around the outer cone. Null: none.
  std::shared_ptr<const Texture> cookie = nullptr;
};

/// A cone must be narrower than a half-space: its map is drawn through one perspective.
inline constexpr float kWidestCone_deg = 170.0f;

/// The keys of a spot in a scene file, and the spot that they describe. Throws kInput.
const std::vector<std::string>& spot_keys();
Spot read_spot(const TomlTable& table);

/// Throws kInput, with `where`, for a spot that cannot be.
Spot checked_spot(const Spot& spot, const std::string& where);

/// Its cone.
Beam make_beam(const Spot& spot);

/// The diameter of the lamp's disk, metres; of a rectangle that of the disk of its area.
double diameter_of(const Spot& spot);

/// Rays to the lamp's disk or rectangle.
truth::AreaLight make_area_light(const Spot& spot);

/// The frustum around the cone, whose depth runs from the nearest to the farthest vertex in it; see fit_light().
LightFrustum fit_spot(const Spot& spot, const Scene& scene, const FitRequest& request);

}  // namespace shadowbench::scene
