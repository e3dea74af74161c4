#pragma once

#include <optional>

#include "harness/scene/scene.h"

namespace shadowbench::stress {

/// How the scene of make_slab_scene stands in the world.
struct SlabSetting {
  glm::dmat3 world_from_local{1.0};  ///< rotation
  glm::dvec3 light_local{0.0, -1.0,
                         0.0};  ///< the way light travels, any length; straight down onto the floor by default
  bool wall = false;            ///< beside the floor, at right angles to it; it casts no shadow
};

/// Makes a floor of 4 m x 4 m in the plane y = 0 of its own space, a thin slab 1 m above it, a light from above, and a
/// camera that sees both. Not validated.
scene::Scene make_slab_scene(const SlabSetting& setting);

/// What reaches a point of the floor or of the slab, by construction: 1 lit, 0 blocked. Empty for points whose ray
/// passes the slab's edge within `margin_m`, and for points of neither, such as the wall's.
std::optional<double> find_slab_visibility(const SlabSetting& setting, const glm::dvec3& position_ws, double margin_m);

}  // namespace shadowbench::stress
