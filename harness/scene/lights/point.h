#pragma once

#include "harness/scene/lights/light_parts.h"

namespace shadowbench::scene {

/// A sphere in the scene that shines all around.
struct PointLight {
  glm::vec3 position_ws{0.0f, 1.0f, 0.0f};
  float radius_m = 0.05f;    ///< of the sphere; 0: a point
  float reference_m = 1.0f;  ///< where its light is as strong as a sun's
};

/// The point light that a scene file describes. Throws kInput.
PointLight read_point(const TomlTable& table);

/// What light.h asks of every kind.
glm::vec3 to_light(const PointLight& point, const glm::vec3& point_ws);
std::optional<Beam> find_beam(const PointLight& point);  ///< without an edge; its axis says nothing
double light_size(const PointLight& point);
truth::AreaLight make_area_light(const PointLight& point);
void turn_light(PointLight& point, const LightTurn& turn);
void aim_light(PointLight& point, const glm::vec3& center_ws);
PointLight checked_light(const PointLight& point, const std::string& where);
std::string describe_light(const PointLight& point);
std::vector<LightNumber> list_numbers(PointLight& point);
int count_layers(const PointLight& point, const MapWindow* window, const FitRule& rule);
std::vector<LightFrustum> fit_layers(const PointLight& point, const MapWindow* window, const Scene& scene,
                                     const FitRequest& request);

}  // namespace shadowbench::scene
