#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "harness/engines/alignment.h"

namespace shadowbench::engines {

/// Compares the light that another renderer's surfaces have without shadows with that of ours: values for a display in
/// place of linear light, a light from elsewhere, antialiasing, few bits.
void check_light(const ExternalImages& images, const OwnView& own, std::vector<Finding>& findings);

/// The neighbour of a pixel; nothing beyond the picture's edge.
std::optional<std::size_t> step(std::size_t pixel, int dx, int dy, int width, int height);

}  // namespace shadowbench::engines
