#pragma once

#include <vector>

#include "harness/scene/scene.h"

namespace shadowbench::scene {

/// Turns a light about the vertical (+y): light i of `count` is `first`, turned by i * 360 / count degrees, as high in
/// the sky, as large and as bright. Light 0 is `first` itself. A light straight overhead is turned into itself.
/// Requires `count` of 1 or more.
std::vector<Light> make_light_ring(const Light& first, int count);

}  // namespace shadowbench::scene
