#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "harness/scene/lights/beam.h"
#include "reference/truth/area_light.h"

namespace shadowbench::scene {

class TomlTable;
struct FitRequest;
struct LightFrustum;
struct Scene;

/// A sphere in the scene that shines all around.
struct PointLight {
  glm::vec3 position_ws{0.0f, 1.0f, 0.0f};
  float radius_m = 0.05f;    ///< of the sphere; 0: a point
  float reference_m = 1.0f;  ///< where its light is as strong as a sun's
};

/// The keys of a point light in a scene file, and the light that they describe. Throws kInput.
const std::vector<std::string>& point_keys();
PointLight read_point(const TomlTable& table);

/// Throws kInput, with `where`, for a light that cannot be.
PointLight checked_point(const PointLight& point, const std::string& where);

/// A beam without an edge; its axis says nothing.
Beam make_beam(const PointLight& point);

/// Rays to the sphere.
truth::AreaLight make_area_light(const PointLight& point);

/// The faces of a cube around the light, each a perspective map of 90 degrees and its padding: a kernel at the edge of
/// a face reads on in the same map, so that no filter needs to know of the seam. All six have the same depths.
std::vector<LightFrustum> fit_point(const PointLight& point, const Scene& scene, const FitRequest& request);

}  // namespace shadowbench::scene
