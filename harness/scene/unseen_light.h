#pragma once

#include <span>
#include <string>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Where none of these views shows a surface that the scene's light reaches: what to write into the scene's file, a
/// camera that sees its shadows or a place of the light that has some. Empty where a view shows one.
///
/// Requires a scene of one light, and views of the given width / height. Cost: about that of building the scene's
/// acceleration structure, where a light is not seen ten times that of choose_view().
std::string advise_on_unseen_light(const Scene& lit, std::span<const Camera> views, double aspect);

}  // namespace shadowbench::scene
