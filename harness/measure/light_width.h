#pragma once

#include <optional>

#include "harness/measure/scene_assets.h"
#include "harness/scene/shadow_edges.h"

namespace shadowbench::measure {

/// Finds the width that a scene's light asks of a kernel, in a view and a map: the standard deviation along an axis, in
/// texels, of the kernel that blurs an edge as the light's penumbra does, of the median of the penumbrae in view. Each
/// counts by its width, as the pixels that lie in it do. Rounded to a hundredth of a texel. Empty where no edge of a
/// shadow is in view. Cost: a picture of one ray for each pixel, 240 pixels wide; no map is drawn.
std::optional<double> find_light_sigma(const scene::EdgeMeter& meter, const options::RunOptions& options,
                                       const MapFit& fit);

}  // namespace shadowbench::measure
