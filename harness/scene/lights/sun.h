#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "reference/truth/area_light.h"

namespace shadowbench::scene {

class TomlTable;
struct FitRequest;
struct LightFrustum;
struct MapWindow;
struct Scene;

/// A directional light: a disk at infinity.
struct Sun {
  glm::vec3 direction_ws{0.0f, -1.0f, 0.0f};  ///< the way the light travels, unit length
  float angular_diameter_deg = 0.53f;         ///< seen from the scene; 0: a point at infinity
};

/// The way light travels that comes from a place in the sky: azimuth 0 is +z, 90 is +x; degrees.
glm::dvec3 light_direction(double azimuth_deg, double elevation_deg);

/// The keys of a sun in a scene file, and the sun that they describe. Throws kInput.
const std::vector<std::string>& sun_keys();
Sun read_sun(const TomlTable& table);

/// Makes the direction unit length. Throws kInput, with `where`, for a sun that cannot be.
Sun checked_sun(Sun sun, const std::string& where);

/// Rays to the sun's disk.
truth::AreaLight make_area_light(const Sun& sun);

/// An orthographic frustum, fitted to the scene or, where `window` is not null, to that; see fit_light().
LightFrustum fit_sun(const Sun& sun, const MapWindow* window, const Scene& scene, const FitRequest& request);

/// The same over these receivers, in world space, with the casters between them and the light; without any, over the
/// whole scene.
LightFrustum fit_sun_over(const Sun& sun, const Scene& scene, const FitRequest& request,
                          const std::vector<glm::dvec3>& receivers);

}  // namespace shadowbench::scene
