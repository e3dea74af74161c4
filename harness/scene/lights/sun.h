#pragma once

#include "harness/scene/lights/light_parts.h"

namespace shadowbench::scene {

/// A directional light: a disk at infinity.
struct Sun {
  glm::vec3 direction_ws{0.0f, -1.0f, 0.0f};  ///< the way the light travels, unit length
  float angular_diameter_deg = 0.53f;         ///< seen from the scene; 0: a point at infinity
};

/// A place in the sky, or where something is seen from: azimuth 0 is +z, 90 is +x; degrees.
struct SkyAngles {
  double azimuth_deg = 0.0;
  double elevation_deg = 0.0;
};

/// The way light travels that comes from a place in the sky, see SkyAngles.
glm::dvec3 light_direction(double azimuth_deg, double elevation_deg);

/// The sun that a scene file describes, but for its map window. Throws kInput.
Sun read_sun(const TomlTable& table);

/// An orthographic frustum over these receivers, in world space, with the casters between them and the light; without
/// any, over the whole scene.
LightFrustum fit_sun_over(const Sun& sun, const Scene& scene, const FitRequest& request,
                          const std::vector<glm::dvec3>& receivers);

/// What light.h asks of every kind.
glm::vec3 to_light(const Sun& sun, const glm::vec3& point_ws);
std::optional<Beam> find_beam(const Sun& sun);
double light_size(const Sun& sun);
truth::AreaLight make_area_light(const Sun& sun);
void turn_light(Sun& sun, const LightTurn& turn);
void aim_light(Sun& sun, const glm::vec3& center_ws);
Sun checked_light(const Sun& sun, const std::string& where);
std::string describe_light(const Sun& sun);
std::vector<LightNumber> list_numbers(Sun& sun);
int count_layers(const Sun& sun, const MapWindow* window, const FitRule& rule);
std::vector<LightFrustum> fit_layers(const Sun& sun, const MapWindow* window, const Scene& scene,
                                     const FitRequest& request);

}  // namespace shadowbench::scene
