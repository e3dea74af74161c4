#pragma once

#include <vector>

#include "harness/scene/scene.h"
#include "reference/truth/occluders.h"

namespace shadowbench::scene {

/// What rays can hit of a scene: every mesh that casts a shadow, with the holes of its material.
std::vector<truth::OccluderMesh> list_occluders(const Scene& scene);

/// The other meshes: those that cast no shadow.
std::vector<truth::OccluderMesh> list_non_casters(const Scene& scene);

}  // namespace shadowbench::scene
