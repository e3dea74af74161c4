#pragma once

#include <memory>

#include "harness/scene/lights/light_parts.h"

namespace shadowbench::scene {

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

/// The spot that a scene file describes. Throws kInput.
Spot read_spot(const TomlTable& table);

/// What light.h asks of every kind.
glm::vec3 to_light(const Spot& spot, const glm::vec3& point_ws);
std::optional<Beam> find_beam(const Spot& spot);
double light_size(const Spot& spot);
truth::AreaLight make_area_light(const Spot& spot);
void turn_light(Spot& spot, const LightTurn& turn);
void aim_light(Spot& spot, const glm::vec3& center_ws);
Spot checked_light(const Spot& spot, const std::string& where);
std::string describe_light(const Spot& spot);
std::vector<LightNumber> list_numbers(Spot& spot);
int count_layers(const Spot& spot, const MapWindow* window, const FitRule& rule);
std::vector<LightFrustum> fit_layers(const Spot& spot, const MapWindow* window, const Scene& scene,
                                     const FitRequest& request);

}  // namespace shadowbench::scene
