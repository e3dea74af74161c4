#pragma once

#include <vector>

#include "harness/scene/scene.h"
#include "reference/truth/occluders.h"

namespace shadowbench::measure {

/// What rays can hit of a scene: every mesh that casts a shadow, with the holes of its material.
std::vector<truth::OccluderMesh> list_occluders(const scene::Scene& scene);

}  // namespace shadowbench::measure
