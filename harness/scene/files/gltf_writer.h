#pragma once

#include <string>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// The bytes of a .glb file of a scene: its meshes as they stand in the world, materials, textures, cameras of this
/// aspect (width / height), and its light as KHR_lights_punctual has it. What glTF has no word for goes into
/// `extras.shadowbench`, from where import_gltf() takes it: a light's size and all else of it in the words of a scene
/// file, `casts_shadow` and `may_cull_front` of a node, `title` and `background` of the scene. A spot's cookie is left
/// out.
/// Throws Error(kOutput) where a texture cannot be packed.
std::string write_glb(const Scene& scene, double aspect);

}  // namespace shadowbench::scene
