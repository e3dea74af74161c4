#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// The most corners that the shapes of one scene may have, three per triangle: about 4 million triangles.
inline constexpr std::size_t kMostShapeCorners = std::size_t{3} << 22;

/// The keys that every [[object]] of a scene file may have.
const std::vector<std::string>& common_object_keys();

/// The shapes that an [[object]] may have, "model" included.
const std::vector<std::string>& object_shapes();

/// Makes the mesh of an [[object]] that is not a model, in its own space. Throws kInput for an unknown key or value.
Mesh make_shape(const TomlTable& object);

/// The transform that scale, then rotation_deg (about x, then y, then z), then center describe.
glm::dmat4 world_from_object(const TomlTable& object);

}  // namespace shadowbench::scene
